"""docs/protocol-modbus.md does not lie: examples decode to the words beside them, tables are the code's."""

from __future__ import annotations

import re
from typing import TYPE_CHECKING

import pytest

from fatektool.protocol.commands import ReadRegisters
from fatektool.protocol.elements import Element
from fatektool.protocol.explain import FrameRole
from fatektool.protocol.modbus import pdu as modbus_pdu
from fatektool.protocol.modbus.ascii import ASCII
from fatektool.protocol.modbus.data import MEANINGS
from fatektool.protocol.modbus.map import STANDARD, Reference
from fatektool.protocol.modbus.rtu import RTU
from fatektool.protocol.modbus.tcp import TCP
from fatektool.protocol.registry import new_explainer
from tests.protocol.fatek.facon.test_docs import Shown, blocks, table
from tests.root import DOCS

if TYPE_CHECKING:
    from collections.abc import Sequence

DOC = (DOCS / "protocol-modbus.md").read_text("utf-8")
BLOCKS = blocks(DOC, "modbus-rtu")


@pytest.mark.parametrize("frames", [frames for _, frames in BLOCKS], ids=[str(n) for n in range(len(BLOCKS))])
def test_examples(frames: Sequence[Shown]) -> None:
    explainer = new_explainer("modbus-rtu")
    for shown in frames:
        role = FrameRole.REQUEST if shown.kind == "request" else FrameRole.ANSWER
        (explanation,) = explainer.explain(shown.raw, role)
        assert (explanation.role, explanation.fault) == (role, None)
        said = [f"{field.name}: {field.meaning}" for field in explanation.fields[2:-1]]
        assert " · ".join(said) == shown.words


def test_tables() -> None:
    assert [(int(row[0][:2], 16), row[0][3:]) for row in table("function", DOC)] == list(
        modbus_pdu.FUNCTION_WORDS.items()
    )
    assert {int(row[0], 16): row[1] for row in table("code | meaning", DOC)} == MEANINGS
    rows = table("references | elements", DOC)
    assert [row[1] for row in rows] == [str(stretch) for stretch in STANDARD.stretches]
    for row, stretch in zip(rows, STANDARD.stretches, strict=True):
        first, last = (Reference.parse(text) for text in row[0].split("-"))
        assert (first.area, first.offset) == (stretch.area, stretch.offset)
        assert last.offset - first.offset + 1 == stretch.count * stretch.width


def test_figures() -> None:
    eleven = ReadRegisters(Element("R", 0), 11)
    sizes = re.search(r"RTU (\d+) bytes, ASCII (\d+), TCP (\d+)", DOC)
    assert sizes
    assert [int(size) for size in sizes.groups()] == [
        codec.answer_bytes(eleven) for codec in (RTU, ASCII, TCP)
    ]
