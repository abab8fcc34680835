"""Networks as ladders in SVG, each part at the same line and column of characters as in the text drawing.

For a screen reader, every drawing is one image with the name of its network; a table has the instructions.
The parts keep their size: in a narrow window, a wide drawing scrolls.
"""

from __future__ import annotations

from enum import StrEnum
from typing import TYPE_CHECKING, Final

from fatektool.ladder.circuit.reading import NoCircuit, circuit_of
from fatektool.ladder.drawing.signs import Look
from fatektool.ladder.drawing.text.draw import bands_of, is_empty
from fatektool.ladder.drawing.text.letters import Letters, width_of
from fatektool.ladder.drawing.text.pen import Pen
from fatektool.ladder.drawing.text.surface import Anchor
from fatektool.report.markup import NEWLINE, Html, join, tag
from fatektool.report.page import note

if TYPE_CHECKING:
    from collections.abc import Mapping

    from fatektool.ladder.drawing.plan import Net
    from fatektool.ladder.drawing.text.cells import SignText
    from fatektool.ladder.networks import Network

WIDE: Final = 88
"""The columns of a drawing with the full width of the page."""
HALF: Final = 62
"""The columns of one of two drawings side by side."""
_COLUMN: Final = 8
_LINE: Final = 18
_EDGE: Final = 12
_TALL: Final = 7
_PEN: Final = Pen(Letters())


class DiffMark(StrEnum):
    """The change of an instruction between two programs."""

    ADDED = "added"
    REMOVED = "removed"


_SIGNS: Final = {DiffMark.ADDED: "+", DiffMark.REMOVED: "\N{MINUS SIGN}"}


def ladder(
    network: Network,
    comments: Mapping[str, str],
    name: str,
    columns: int = WIDE,
    marks: Mapping[int, DiffMark] | None = None,
) -> Html | None:
    """The drawing of a network; None if it cannot be drawn.

    Args:
        network: the network.
        comments: of elements, drawn under them.
        name: the image's id.
        columns: the maximum width, in characters.
        marks: the instructions that were added or removed.
    """
    circuit = circuit_of(network)
    if isinstance(circuit, NoCircuit):
        return None
    if is_empty(circuit):
        return note("An empty network.")
    picture, top = _Picture(marks or {}), 0
    for band in bands_of(circuit, comments, columns, _PEN):
        picture.begin(top)
        band.draw_on(picture)
        top += band.lines + 1
    return picture.image(name, f"Network {network.name} as a ladder", top - 1)


def not_drawn(network: Network) -> Html:
    """The reason why a network cannot be drawn."""
    circuit = circuit_of(network)
    assert isinstance(circuit, NoCircuit)  # noqa: S101  # the caller's condition
    return note(f"Not drawn: {circuit.reason} (instruction {circuit.number:04}).")


class _Picture:
    """An image that is being drawn.

    Args:
        marks: the instructions that were added or removed.
    """

    def __init__(self, marks: Mapping[int, DiffMark]) -> None:
        self._marks = marks
        self._top = 0
        self._widest = 0
        self._wires: list[str] = []
        self._signs: list[str] = []
        self._under: list[Html] = []
        self._parts: list[Html] = []

    def begin(self, line: int) -> None:
        """Continue below, from this line on."""
        self._top = line

    def image(self, name: str, title: str, lines: int) -> Html:
        """The complete image.

        Args:
            name: its id.
            title: of the image.
            lines: its number of lines.
        """
        width, height = self._widest + _EDGE, lines * _LINE + 2 * _EDGE
        drawn = tag(
            "svg",
            tag("title", title, id=f"{name}-title"),
            tag("desc", "Its instructions are in the table.", id=f"{name}-desc"),
            *self._under,
            tag("path", d="".join(self._wires), class_="wire"),
            tag("path", d="".join(self._signs), class_="sign") if self._signs else "",
            join(self._parts, NEWLINE),
            id=name,
            class_="ladder",
            role="img",
            aria_labelledby=f"{name}-title {name}-desc",
            viewBox=f"0 0 {width} {height}",
            width=width,
            height=height,
        )
        return tag("div", drawn, class_="scroll", role="region", aria_label=title, tabindex="0")

    def across(self, line: int, first: int, last: int, net: Net | None) -> None:  # noqa: ARG002
        """A wire along a line."""
        if first < last:
            self._wires.append(f"M{self._x(first)} {self._y(line)}H{self._x(last)}")

    def down(self, column: int, first: int, last: int, net: Net | None) -> None:  # noqa: ARG002
        """A wire down a column."""
        self._wires.append(f"M{self._x(column)} {self._y(first)}V{self._y(last)}")

    def rail(self, lines: int) -> None:
        """The rail."""
        top = self._y(0) - _LINE // 2
        self._parts.append(tag("path", d=f"M{self._x(0)} {top}v{lines * _LINE}", class_="rail"))

    def sign(self, line: int, column: int, sign: SignText, number: int) -> None:
        """An instruction's sign."""
        columns = width_of(sign.sign)
        left, right, y = self._x(column), self._x(column + columns - 1), self._y(line)
        inside = sign.sign[1:-1].strip() if columns > 1 else sign.sign
        match sign.look:
            case Look.CONTACT:
                self._signs.append(f"M{left} {y - _TALL}v{2 * _TALL}M{right} {y - _TALL}v{2 * _TALL}")
            case Look.COIL:
                bow = f"{y - _TALL}q-6 {_TALL} 0 {2 * _TALL}", f"{y - _TALL}q6 {_TALL} 0 {2 * _TALL}"
                self._signs.append(f"M{left + 3} {bow[0]}M{right - 3} {bow[1]}")
            case Look.STEP:
                self._signs.append(f"M{left} {y - _TALL}H{right}v{2 * _TALL}H{left}z")
        self._inside((left + right) / 2, y, inside)
        aside = (
            (width_of(sign.name) - columns) % 2 * _COLUMN // 2
        )  # a name of even width is beside the middle
        half = max(columns, width_of(sign.name)) * _COLUMN // 2 + 3 + aside
        middle = (left + right) // 2
        self._mark(number, middle - half - 9, y - _LINE - _TALL, middle + half, y + _TALL + 3)

    def frame(self, lines: tuple[int, int], columns: tuple[int, int], title: str, number: int) -> None:
        """The edges of an instruction's box, open at its title."""
        left, right = map(self._x, columns)
        top, foot = map(self._y, lines)
        after = left + (2 + width_of(title)) * _COLUMN
        self._signs.append(f"M{after} {top}H{right}V{foot}H{left}V{top}h{_COLUMN}")
        self.write(lines[0], columns[0] + 2, title)
        self._mark(number, left - 13, top - _TALL - 4, right + 4, foot + 4)

    def write(
        self, line: int, column: int, text: str, anchor: Anchor = Anchor.START, *, quiet: bool = False
    ) -> None:
        """A text."""
        if not text:
            return
        columns = width_of(text)
        place = {Anchor.START: 0.0, Anchor.MIDDLE: columns / 2, Anchor.END: float(columns)}[anchor]
        x = (column + place) * _COLUMN + _EDGE
        self._widest = max(self._widest, (column + columns) * _COLUMN + _EDGE)
        self._text(x, self._y(line), text, anchor, "" if quiet else "strong")

    def _inside(self, x: float, y: float, inside: str) -> None:
        """The text or arrow in a sign."""
        if inside == "/":
            self._signs.append(f"M{x - 4:g} {y + 6}l8 -12")
        elif inside in {_PEN.rising, _PEN.falling}:
            way = -1 if inside == _PEN.rising else 1
            self._signs.append(f"M{x:g} {y - 6 * way}v{12 * way}l-3 {-4 * way}m3 {4 * way}l3 {-4 * way}")
        elif inside:
            self._text(x, y, inside, Anchor.MIDDLE, "strong")

    def _mark(self, number: int, left: int, top: int, right: int, foot: int) -> None:
        mark = self._marks.get(number)
        if mark is not None:
            area = tag("rect", x=left, y=top, width=right - left, height=foot - top, rx=3)
            sign = tag("text", _SIGNS[mark], x=left + 2, y=top + 12)
            self._under.append(tag("g", area, sign, class_=mark.value))

    def _text(self, x: float, y: float, text: str, anchor: Anchor, kind: str) -> None:
        self._parts.append(
            tag("text", text, x=f"{x:g}", y=f"{y + 4.5:g}", text_anchor=anchor.value, class_=kind or None)
        )

    def _x(self, column: int) -> int:
        x = column * _COLUMN + _COLUMN // 2 + _EDGE
        self._widest = max(self._widest, x)
        return x

    def _y(self, line: int) -> int:
        return (self._top + line) * _LINE + _LINE // 2 + _EDGE
