"""A sheet of characters: lines that join where they meet, and text on top of them."""

from __future__ import annotations

from typing import TYPE_CHECKING

from fatektool.ladder.drawing.text.letters import pieces
from fatektool.ladder.drawing.text.pen import DOWN, LEFT, RIGHT, UP
from fatektool.ladder.drawing.text.surface import Anchor

if TYPE_CHECKING:
    from fatektool.ladder.drawing.plan import Net
    from fatektool.ladder.drawing.text.cells import SignText
    from fatektool.ladder.drawing.text.pen import Pen


class Canvas:
    """The sheet.

    Args:
        pen: what it is drawn with.
    """

    def __init__(self, pen: Pen) -> None:
        self.pen = pen
        self._ways: dict[tuple[int, int], int] = {}
        self._texts: dict[tuple[int, int], str] = {}

    def across(self, line: int, first: int, last: int, net: Net | None) -> None:  # noqa: ARG002
        """A line from one column to another, both included."""
        for column in range(first, last + 1):
            self._join(line, column, (LEFT if column > first else 0) | (RIGHT if column < last else 0))

    def down(self, column: int, first: int, last: int, net: Net | None) -> None:  # noqa: ARG002
        """A line from one line of text to another, both included."""
        for line in range(first, last + 1):
            self._join(line, column, (UP if line > first else 0) | (DOWN if line < last else 0))

    def rail(self, lines: int) -> None:
        """The rail on the left, of so many lines, open above and below."""
        for line in range(lines):
            self._join(line, 0, UP | DOWN)

    def sign(self, line: int, column: int, sign: SignText, number: int) -> None:  # noqa: ARG002
        """An instruction's sign, on top of its wire."""
        self.write(line, column, sign.sign)

    def frame(
        self,
        lines: tuple[int, int],
        columns: tuple[int, int],
        title: str,
        number: int,  # noqa: ARG002
    ) -> None:
        """The edges of an instruction's box, its title in the upper one."""
        for line in lines:
            self.across(line, *columns, None)
        for column in columns:
            self.down(column, *lines, None)
        self.write(lines[0], columns[0] + 2, title)

    def write(
        self,
        line: int,
        column: int,
        text: str,
        anchor: Anchor = Anchor.START,  # noqa: ARG002  # each character has its place
        *,
        quiet: bool = False,  # noqa: ARG002
    ) -> None:
        """Text, on top of what is there."""
        for piece, width in pieces(text):
            self._texts[line, column] = piece
            for covered in range(column + 1, column + width):
                self._texts[line, covered] = ""
            column += width

    def lines(self) -> list[str]:
        """What is there."""
        return ["".join(text for _, text in line) for line in self.lines_in_places()]

    def lines_in_places(self) -> list[list[tuple[int, str]]]:
        """Each line's texts with their columns, without what is blank at its end."""
        places = [*self._ways, *self._texts]
        lines: list[dict[int, str]] = [{} for _ in range(1 + max((line for line, _ in places), default=-1))]
        for (line, column), ways in self._ways.items():
            if ways:
                lines[line][column] = self.pen.line(ways)
        for (line, column), text in self._texts.items():
            lines[line][column] = text
        for found in lines:
            while found and not found[max(found)].strip() and found[max(found)]:
                del found[max(found)]
        return [
            [(column, found.get(column, " ")) for column in range(1 + max(found, default=-1))]
            for found in lines
        ]

    def _join(self, line: int, column: int, ways: int) -> None:
        self._ways[line, column] = self._ways.get((line, column), 0) | ways
