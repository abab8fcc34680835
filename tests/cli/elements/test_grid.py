"""``read`` on a terminal: a grid, rows of bits, text; and a value a line in a pipe."""

from __future__ import annotations

from typing import TYPE_CHECKING

import pytest

from fatektool.cli.elements.grid import terminal_lines
from fatektool.jobs.elements.items import ItemValues, value_of
from fatektool.jobs.elements.selection import parse_items
from fatektool.protocol.values import raw_text
from tests.cli.terminal import Terminal

if TYPE_CHECKING:
    from tests.plant import Plant


def screen(words: str, raws: dict[str, int | None], columns: int = 80, **comments: str) -> list[str]:
    """What a terminal shows of these elements; a raw value is 0 unless given, None for an error."""
    items = parse_items(words.split())
    given = {item.key: raws.get(item.key, 0) for item in items}
    values = {item.key: value_of(item, given[item.key]) for item in items}
    raw = {
        item.key: None if given[item.key] is None else raw_text(given[item.key] or 0, item.element.kind.bits)
        for item in items
    }
    found = ItemValues(items, values, raw, {}, [], 1)
    return list(terminal_lines(found, comments, columns))


def test_registers_are_a_grid_of_tens() -> None:
    assert screen("R8-R21", {"R8": 0xFFFB, "R12": 30000, "R21": None}) == [
        "        +0     +1     +2     +3     +4     +5     +6     +7     +8     +9",
        "R0                                                              -5      0",
        "R10      0      0  30000      0      0      0      0      0      0      0",
        "R20      0      -",
    ]


@pytest.mark.parametrize(("columns", "across"), [(200, 10), (80, 10), (60, 5), (30, 2), (10, 1), (1, 1)])
def test_a_row_has_as_many_registers_as_fit(columns: int, across: int) -> None:
    head, *rows = screen("R0-R9", {"R3": 0x8000}, columns)
    assert len(head.split()) == across
    assert len(rows) == 10 // across
    assert [word for row in rows for word in row.split()[1:]] == ["0"] * 3 + ["-32768"] + ["0"] * 6
    assert columns < 10 or max(map(len, rows)) <= columns


def test_registers_of_two_words_keep_their_step() -> None:
    assert screen("DR1:8", {"DR3": 0xFFFFFFFF, "DR15": 7}) == [
        "       +0   +2   +4   +6   +8  +10  +12  +14  +16  +18",
        "DR1     0   -1    0    0    0    0    0    7",
    ]
    assert screen("WM8:8", {"WM8": 1, "WM120": 2})[1].split() == ["WM8", "1", *["0"] * 6, "2"]
    assert screen("D4:8:f32", {"D4": 0x3FC00000})[1].split()[:2] == ["D0", "1.5"]


def test_discretes_are_bits_below_a_ruler() -> None:
    assert screen("X5-X31", {"X5": 1, "X20": 1, "X31": None}, 40) == [
        "     +0         +10        +20",
        "     0123456789 0123456789 0123456789",
        "X0        10000 0000000000 1000000000",
        "X30  0-",
    ]
    assert screen("Y100-Y107", {"Y107": 1}) == ["      +0", "      0123456789", "Y100  00000001"]
    assert screen("X0-X19", {"X0": 1}, 1)[2:] == ["X0   1000000000", "X10  0000000000"]


def test_text_is_one_text() -> None:
    assert screen("R0-R4:str", {"R0": 0x5250, "R1": 0x5345, "R2": 0x0053, "R3": 0x5858}) == ["R0-R4  PRESS"]
    assert screen("R0-R1:strh", {"R0": 0x4142, "R1": 0x1B00}) == ["R0-R1  AB\\x1b"]
    assert screen("R0-R1:str", {}) == ['R0-R1  ""']
    assert screen("R0:str", {"R0": 0x4241}) == ["R0  AB"]


def test_few_and_commented_ones_are_a_list() -> None:
    assert screen("R0-R6 R9 Y0", {"R9": 0xFFFF}) == [*(f"R{n}  0" for n in range(7)), "R9  -1", "Y0  off"]
    lines = screen("R5 R10-R20 X0", {}, R15="TIME")
    assert lines[0] == "R5   0"
    assert "R15  0    TIME" in lines
    assert "X0   off" in lines
    assert screen("R3 R10-R19 R30", {}) == [
        "R3  0", "", "     +0  +1  +2  +3  +4  +5  +6  +7  +8  +9", "R10" + "   0" * 10, "", "R30  0",
    ]  # fmt: skip


def test_a_pipe_gets_a_value_a_line_and_a_terminal_a_grid(plant: Plant) -> None:
    plant.write("R12=-5", "DR20=-1", "R100-R103:str=PRESS 4")
    assert plant.cli("read", "R12", "DR20", "R12:1").out == "R12   -5\nDR20  -1\n"
    assert plant.cli("read", "R100-R103:str").out.split("\n")[:2] == ["R100  PR", "R101  ES"]
    assert plant.json("read", "read", "R100-R103:str")["values"]["R100"] == "PR"
    with Terminal("read", "R10-R19", "R100-R103:str", "-p", plant.target, columns=60) as terminal:
        assert terminal.end() == 0
    assert "R10   0   0  -5   0   0   0   0   0   0   0" in terminal.text
    assert "R100-R103  PRESS 4" in terminal.text
    refused = plant.cli("write", "R0-R1:str=too long")
    assert (refused.code, "expected at most 4 characters, got 8" in refused.err) == (2, True)
    assert plant.cli("write", "R0-R1:str=a,b").code == 0
    assert plant.cli("read", "R0-R1:hex").out == "R0  2C61\nR1  0062\n"
