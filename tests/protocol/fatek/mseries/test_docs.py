"""docs/protocol-mseries.md does not lie: examples decode to the words beside them, tables are the code's."""

from __future__ import annotations

import re
from typing import TYPE_CHECKING

import pytest

from fatektool.protocol.elements import KINDS, Element
from fatektool.protocol.explain import FrameRole
from fatektool.protocol.fatek.mseries.bytes import BINARY
from fatektool.protocol.fatek.mseries.codec import MAX_PAYLOAD, MSERIES
from fatektool.protocol.fatek.mseries.crc import crc16
from fatektool.protocol.plc_errors import MEANINGS
from fatektool.protocol.registry import new_explainer
from tests.protocol.decoding import one_frame, request_of
from tests.protocol.fatek.facon.test_docs import Shown, blocks, table, words
from tests.protocol.fatek.mseries.vectors import EXAMPLES, PAYLOADS
from tests.root import DOCS

if TYPE_CHECKING:
    from fatektool.protocol.commands import Command

DOC = (DOCS / "protocol-mseries.md").read_text("utf-8")
BLOCKS = blocks(DOC, "mseries")
BEFORE = 5  # header, ID, length, station, command


@pytest.mark.parametrize(("heading", "frames"), BLOCKS, ids=[f"{n} {b[0]}" for n, b in enumerate(BLOCKS)])
def test_examples(heading: str, frames: list[Shown]) -> None:
    explainer = new_explainer("mseries")
    command = re.match(r"[0-9A-F]{2}(?= )", heading)
    for shown in frames:
        (explanation,) = explainer.explain(shown.raw)
        role = FrameRole.REQUEST if shown.kind == "request" else FrameRole.ANSWER
        assert (explanation.role, explanation.fault) == (role, None)
        assert words(explanation, BEFORE) == shown.words
        if command:
            assert explanation.command == int(command[0], 16)
    if [shown.kind for shown in frames] == ["request", "answer"] and "REFUSED" not in frames[1].words:
        request = request_of(one_frame(frames[0].raw, MSERIES), MSERIES)
        answer = MSERIES.parse_answer(request, one_frame(frames[1].raw, MSERIES))
        assert MSERIES.encode(1, request) == frames[0].raw
        assert MSERIES.encode_answer(1, request, answer) == frames[1].raw


def test_every_example_of_the_paper_is_shown() -> None:
    shown = [frame.raw for _, frames in BLOCKS for frame in frames]
    for example in EXAMPLES + PAYLOADS:
        assert example.asks in shown
        assert example.answers in shown


@pytest.mark.parametrize("command", sorted(MSERIES.commands), ids=lambda command: f"{command:02X}")
def test_every_command_has_a_section_with_an_example(command: Command) -> None:
    heading = f"{command:02X} {command.words}"
    assert f"\n### {heading}\n" in DOC
    kinds = [[shown.kind for shown in frames] for found, frames in BLOCKS if found == heading]
    assert ["request", "answer"] in kinds


def test_tables() -> None:
    assert {int(row[0], 16): row[1] for row in table("code | command", DOC)} == {
        int(command): command.words for command in MSERIES.commands
    }
    assert [int(row[0], 16) for row in table("code | meaning", DOC)] == [0, *(set(MEANINGS) - {3})]
    rows = table("kind", DOC)
    assert {row[0] for row in rows} == set(KINDS)
    for symbol, raw, bits, last, stride, step in rows:
        kind = KINDS[symbol]
        assert [kind.bits, kind.last, kind.stride, kind.step] == list(map(int, (bits, last, stride, step)))
        assert BINARY.element(Element(symbol, 0)) == bytes.fromhex(raw) + b"\0\0"


def test_figures() -> None:
    assert "it is 4B37" in DOC
    assert f"more than {MAX_PAYLOAD}" in DOC
    assert crc16(b"123456789") == 0x4B37
    for hexes in re.findall(r"decode --protocol mseries ([0-9A-F ]+)`", DOC):
        assert one_frame(bytes.fromhex(hexes), MSERIES)
    singles = re.search(r"DWX to DWC \(([\d, ]+)\)", DOC)
    assert singles
    assert [int(text) for text in singles[1].split(", ")] == sorted(0x5700 | letter for letter in b"XYMSTC")
    for symbol, address in (("R", 17152), ("DR", 21759), ("D", 17408), ("D", 18175), ("D", 21247)):
        assert Element(symbol, address).address >> 8 in b"CTDFR"
