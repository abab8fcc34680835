"""Circuits in text: exact drawings, and what holds of every drawing."""

from __future__ import annotations

import re
from collections import Counter
from pathlib import Path
from typing import NamedTuple

import pytest
from hypothesis import given
from hypothesis import strategies as st

from fatektool.ladder.circuit.nodes import Circuit
from fatektool.ladder.circuit.reading import LARGEST, circuit_of
from fatektool.ladder.drawing.layout import plan_of
from fatektool.ladder.drawing.signs import frame_of, sign_of
from fatektool.ladder.drawing.text.draw import draw
from fatektool.ladder.drawing.text.letters import Letters, width_of, wrapped
from fatektool.ladder.drawing.text.pen import Pen
from tests.ladder.circuits import network
from tests.ladder.drawing.test_layout import CIRCUITS

COMMENTS = {"X0": "Start pompy", "M3": "Zawór główny", "M1": "水泵启动按钮", "R8": "Czas"}


def drawn(text: str, columns: int = 80, encoding: str = "utf-8") -> str:
    circuit = circuit_of(network(*text.split(", ")))
    assert isinstance(circuit, Circuit), circuit
    return "\n".join(draw(circuit, COMMENTS, columns, Pen(Letters(encoding))))


class Picture(NamedTuple):
    """A network, how it is drawn, and what that looks like."""

    text: str
    columns: int
    encoding: str
    shown: str


def pictures() -> list[Picture]:
    found = []
    for block in (Path(__file__).parent / "pictures.txt").read_text("utf-8").split("\n----\n")[1:]:
        head, _, shown = block.partition("\n")
        how, _, text = head.partition(": ")
        columns, _, encoding = how.partition(" ")
        found.append(Picture(text, int(columns), encoding, shown))
    return found


@pytest.mark.parametrize("picture", pictures(), ids=lambda picture: picture.text)
def test_a_network_looks_like_this(picture: Picture) -> None:
    assert drawn(picture.text, picture.columns, picture.encoding) == picture.shown


def test_there_are_pictures_of_all_kinds() -> None:
    shown = "\n".join(picture.shown for picture in pictures())
    assert len(pictures()) > 15
    for sign in ("┤ ├", "┤/├", "┤↑├", "( )", "(/)", "(S)", "(R)", "[STP]", "(TO)", "►1", "1►", "]/[", "~FUN"):
        assert sign in shown, sign


def test_every_encoding_shows_what_it_has() -> None:
    assert "├" in drawn("ORG X0, OUT Y0", encoding="cp852")
    assert "^" in drawn("ORG TU M300, OUT Y0", encoding="cp852")
    assert "Zawór" in drawn("ORG X0, AND M3, OUT Y0", encoding="cp852")
    assert drawn("ORG X0, OUT Y0", encoding="no such").isascii()


@pytest.mark.parametrize(
    "texts",
    [
        ["ORG X0", *["AND X0"] * (LARGEST - 2), "OUT Y0"],
        ["ORG X0", *["OR Y0"] * (LARGEST - 2), "OUT Y0"],
        ["ORG X0", *["OUT Y0"] * (LARGEST - 1)],
        ["ORG X0", *["AND X0", "OUT Y0"] * (LARGEST // 2 - 1)],
        ["ORG X0", "OUT TR 0", "OUT Y0", *["LD TR 0", "AND X0", "OUT Y0"] * (LARGEST // 3 - 1)],
        ["ORG X0", *["LD X1"] * 90, *["ORLD", "AND X0"] * 90, "OUT Y0"],
        ["ORG X0", *["FUN 15 (+1) C0", "FO 0"] * 90, "OUT Y0"],
    ],
    ids=["row", "branches", "coils", "steps", "stores", "deep", "functions"],
)
def test_the_largest_networks_are_drawn(texts: list[str]) -> None:
    lines = drawn(", ".join(texts)).splitlines()
    assert len(lines) > 40
    assert max(map(width_of, lines)) <= 80


TEXTS = st.text(st.sampled_from("aŁó水泵 é\u0301\u202e\t\x1b한"), max_size=16)


@given(CIRCUITS, st.integers(40, 200), st.sampled_from(["utf-8", "ascii", "cp852", "gbk"]), st.data())
def test_no_line_is_wider_than_it_may_be(
    circuit: Circuit, columns: int, encoding: str, data: st.DataObject
) -> None:
    elements = {element for leaf in circuit.leaves for element in leaf.instruction.elements}
    comments = {element: data.draw(TEXTS) for element in sorted(elements)}
    lines = list(draw(circuit, comments, columns, Pen(Letters(encoding))))
    for line in lines:
        assert width_of(line) <= columns, line
        assert line.isprintable()
        line.encode(encoding)
    shown = "\n".join(lines)
    for cell in plan_of(circuit).cells:
        assert sign_of(cell.leaf).name in shown
    for box in plan_of(circuit).boxes:
        assert frame_of(box.leaf).title in shown


@given(CIRCUITS, st.integers(40, 80))
def test_each_cut_wire_has_its_number_at_both_ends(circuit: Circuit, columns: int) -> None:
    shown = "\n".join(draw(circuit, {}, columns, Pen(Letters())))
    ends, begins = Counter(re.findall(r"►(\d+)", shown)), Counter(re.findall(r"(\d+)►", shown))
    assert ends == begins
    assert set(ends.values()) <= {1}
    assert sorted(map(int, ends)) == list(range(1, len(ends) + 1))


@pytest.mark.parametrize(
    ("text", "columns", "lines"),
    [
        ("Start cyklu", 9, ["Start", "cyklu"]),
        ("Błąd pozycji wej", 11, ["Błąd", "pozycji wej"]),
        ("abcdefghij", 4, ["abcd", "efgh", "ij"]),
        ("水泵启动", 5, ["水泵", "启动"]),
        ("e\u0301e\u0301e\u0301", 2, ["e\u0301e\u0301", "e\u0301"]),
        ("", 5, []),
    ],
)
def test_texts_are_broken_between_words(text: str, columns: int, lines: list[str]) -> None:
    assert wrapped(text, columns) == lines


@given(st.text(), st.integers(2, 20))
def test_a_broken_text_is_as_wide_as_it_may_be(text: str, columns: int) -> None:
    spelt = Letters().spell(text)
    lines = wrapped(spelt, columns)
    assert "".join("".join(lines).split()) == "".join(spelt.split())
    assert all(width_of(line) <= columns for line in lines)
