"""A sheet of characters with what a PLC has now: wires that carry are heavy, those not known are dashed.

::

    box      ┣━━┫ ┣━━ carries    ├──┤ ├── does not    ┄┄┤ ├┄┄ not known    (●) on
    ASCII    #==# #==            |--] [--             ..] [..              (*)

So no colour is needed to see it.
"""

from __future__ import annotations

import unicodedata
from itertools import groupby
from typing import TYPE_CHECKING, Final, NamedTuple, TypeAlias

from fatektool.ladder.drawing.plan import RAIL
from fatektool.ladder.drawing.signs import Look
from fatektool.ladder.drawing.text.canvas import Canvas
from fatektool.ladder.drawing.text.draw import bands_of, is_empty
from fatektool.ladder.drawing.text.pen import DOWN, LEFT, RIGHT, UP, Pen

if TYPE_CHECKING:
    from collections.abc import Iterator, Mapping

    from fatektool.ladder.circuit.nodes import Circuit
    from fatektool.ladder.drawing.plan import Net
    from fatektool.ladder.drawing.text.cells import SignText
    from fatektool.ladder.drawing.text.letters import Letters
    from fatektool.ladder.drawing.text.states import LiveStates

_WAYS: Final = {
    "LEFT": LEFT,
    "RIGHT": RIGHT,
    "UP": UP,
    "DOWN": DOWN,
    "HORIZONTAL": LEFT | RIGHT,
    "VERTICAL": UP | DOWN,
}
_DASHED: Final = dict.fromkeys((LEFT, RIGHT, LEFT | RIGHT), "┄") | dict.fromkeys((UP, DOWN, UP | DOWN), "┆")
_ASCII_DASHED: Final = dict.fromkeys((LEFT, RIGHT, LEFT | RIGHT), ".") | dict.fromkeys(
    (UP, DOWN, UP | DOWN), ":"
)


def _heavy() -> dict[tuple[int, int], str]:
    """Box characters by their ways, and those of them that are heavy, as Unicode names them."""
    found: dict[tuple[int, int], str] = {}
    for code in range(0x2500, 0x2580):
        name = unicodedata.name(chr(code)).removeprefix("BOX DRAWINGS ")
        if not {*name.split(" ")} <= {*_WAYS, "LIGHT", "HEAVY", "AND"}:
            continue  # double, dashed, round
        halves = name.split(" AND ")
        ways = heavy = 0
        for half in halves:
            of_half = sum(_WAYS.get(word, 0) for word in half.split(" "))
            weight = half if "HEAVY" in half or "LIGHT" in half else halves[0]
            ways |= of_half
            heavy |= of_half if "HEAVY" in weight else 0
        found[ways, heavy] = chr(code)
    return found


_HEAVY: Final = _heavy()


class Strip(NamedTuple):
    """A part of a row.

    Attributes:
        text: its characters.
        is_lit: they are of what carries, conducts or is on.
    """

    text: str
    is_lit: bool = False


Row: TypeAlias = tuple[Strip, ...]


class LivePen(Pen):
    """A pen with heavy and dashed wires, where the encoding has them all; else it is in ASCII.

    Args:
        letters: what can be written.
    """

    def __init__(self, letters: Letters) -> None:
        super().__init__(letters)
        if not letters.has("".join({*_HEAVY.values(), *_DASHED.values()})):
            self.in_ascii()
        self.lit_contact = ("┫", "┣") if self.has_boxes else ("#", "#")
        self.lit_coil = "●" if self.has_boxes and letters.has("●") else "*"

    def live_line(self, ways: int, lit: int, unsure: int) -> str:
        """The character of a wire.

        Args:
            ways: where it goes.
            lit: where it carries.
            unsure: where that is not known.
        """
        if lit:
            if self.has_boxes:
                return _HEAVY[ways, lit]
            return "=" if ways in {LEFT, RIGHT, LEFT | RIGHT} else "#"
        dashed = _DASHED if self.has_boxes else _ASCII_DASHED
        return dashed[ways] if unsure == ways and ways in dashed else self.line(ways)


class LiveCanvas(Canvas):
    """The sheet.

    Args:
        pen: what it is drawn with.
        states: what the PLC has.
    """

    def __init__(self, pen: LivePen, states: LiveStates) -> None:
        super().__init__(pen)
        self._live_pen = pen
        self._states = states
        self._lit: dict[tuple[int, int], int] = {}
        self._unsure: dict[tuple[int, int], int] = {}
        self._lit_signs: set[tuple[int, int]] = set()

    def across(self, line: int, first: int, last: int, net: Net | None) -> None:
        """A wire from one column to another, both included."""
        super().across(line, first, last, net)
        for column in range(first, last + 1):
            ways = (LEFT if column > first else 0) | (RIGHT if column < last else 0)
            self._mark((line, column), ways, net)

    def down(self, column: int, first: int, last: int, net: Net | None) -> None:
        """A wire from one line to another, both included."""
        super().down(column, first, last, net)
        for line in range(first, last + 1):
            self._mark((line, column), (UP if line > first else 0) | (DOWN if line < last else 0), net)

    def rail(self, lines: int) -> None:
        """The rail, which always carries."""
        super().rail(lines)
        for line in range(lines):
            self._mark((line, 0), UP | DOWN, RAIL)

    def sign(self, line: int, column: int, sign: SignText, number: int) -> None:
        """A sign, another one if it conducts or is on."""
        text, pen = sign.sign, self._live_pen
        is_lit = self._states.of_sign(number) is True
        if is_lit and sign.look is Look.CONTACT:
            text = pen.lit_contact[0] + text[1:-1] + pen.lit_contact[1]
        elif is_lit and text == "( )":
            text = f"({pen.lit_coil})"
        self.write(line, column, text)
        if is_lit:
            self._lit_signs |= {(line, column + place) for place in range(len(text))}

    def rows(self) -> Iterator[Row]:
        """What is there."""
        for place, ways in self._ways.items():
            if ways and place not in self._texts:
                lit, unsure = self._lit.get(place, 0), self._unsure.get(place, 0)
                self._texts[place] = self._live_pen.live_line(ways, lit, unsure)
                if lit:
                    self._lit_signs.add(place)
        for number, line in enumerate(self.lines_in_places()):
            yield tuple(
                Strip("".join(text for _, text in group), is_lit)
                for is_lit, group in groupby(line, key=lambda each: (number, each[0]) in self._lit_signs)
            )

    def _mark(self, place: tuple[int, int], ways: int, net: Net | None) -> None:
        state = self._states.of_net(net)
        if state is not False:
            marked = self._lit if state else self._unsure
            marked[place] = marked.get(place, 0) | ways


def live_rows(
    circuit: Circuit, comments: Mapping[str, str], columns: int, pen: LivePen, states: LiveStates
) -> Iterator[Row]:
    """A circuit with what the PLC has, in rows.

    Args:
        circuit: it.
        comments: of elements, to stand under them.
        columns: how wide a row may be.
        pen: what it is drawn with.
        states: what the PLC has.
    """
    if is_empty(circuit):
        yield (Strip(f"{pen.line(UP | DOWN)} (empty)"),)
    for count, band in enumerate(bands_of(circuit, comments, columns, pen, states)):
        if count:
            yield ()
        canvas = LiveCanvas(pen, states)
        band.draw_on(canvas)
        yield from canvas.rows()
