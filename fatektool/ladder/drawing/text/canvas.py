"""A sheet of characters: lines that join where they meet, and text on top of them."""

from __future__ import annotations

from typing import Final

from fatektool.ladder.drawing.text.letters import Letters, pieces

LEFT, RIGHT, UP, DOWN = 1, 2, 4, 8
_BOX: Final = {
    LEFT: "─",
    RIGHT: "─",
    UP: "│",
    DOWN: "│",
    LEFT | RIGHT: "─",
    UP | DOWN: "│",
    RIGHT | DOWN: "┌",
    LEFT | DOWN: "┐",
    RIGHT | UP: "└",
    LEFT | UP: "┘",
    LEFT | RIGHT | DOWN: "┬",
    LEFT | RIGHT | UP: "┴",
    UP | DOWN | RIGHT: "├",
    UP | DOWN | LEFT: "┤",
    LEFT | RIGHT | UP | DOWN: "┼",
}
_ASCII: Final = dict.fromkeys((LEFT, RIGHT, LEFT | RIGHT), "-") | dict.fromkeys((UP, DOWN, UP | DOWN), "|")


class Pen:
    """The characters that lines and signs are made of: box characters, or ASCII where there are none.

    Args:
        letters: what can be written.
    """

    def __init__(self, letters: Letters) -> None:
        self.letters = letters
        self._boxes = letters.has("".join(set(_BOX.values())))
        arrows = letters.has("↑↓►")
        self.contact = ("┤", "├") if self._boxes else ("]", "[")
        self.rising, self.falling = ("↑", "↓") if arrows else ("^", "v")
        self.onward = "►" if arrows else ">"

    def line(self, ways: int) -> str:
        """The character of a line that goes these ways."""
        return _BOX[ways] if self._boxes else _ASCII.get(ways, "+")


class Canvas:
    """The sheet.

    Args:
        pen: what it is drawn with.
    """

    def __init__(self, pen: Pen) -> None:
        self.pen = pen
        self._ways: dict[tuple[int, int], int] = {}
        self._texts: dict[tuple[int, int], str] = {}

    def across(self, line: int, first: int, last: int) -> None:
        """A line from one column to another, both included."""
        for column in range(first, last + 1):
            self._join(line, column, (LEFT if column > first else 0) | (RIGHT if column < last else 0))

    def down(self, column: int, first: int, last: int) -> None:
        """A line from one line of text to another, both included."""
        for line in range(first, last + 1):
            self._join(line, column, (UP if line > first else 0) | (DOWN if line < last else 0))

    def rail(self, lines: int) -> None:
        """The rail on the left, of so many lines, open above and below."""
        for line in range(lines):
            self._join(line, 0, UP | DOWN)

    def write(self, line: int, column: int, text: str) -> None:
        """Text, on top of what is there."""
        for piece, width in pieces(text):
            self._texts[line, column] = piece
            for covered in range(column + 1, column + width):
                self._texts[line, covered] = ""
            column += width

    def lines(self) -> list[str]:
        """What is there."""
        places = [*self._ways, *self._texts]
        lines: list[dict[int, str]] = [{} for _ in range(1 + max((line for line, _ in places), default=-1))]
        for (line, column), ways in self._ways.items():
            if ways:
                lines[line][column] = self.pen.line(ways)
        for (line, column), text in self._texts.items():
            lines[line][column] = text
        return [
            "".join(found.get(column, " ") for column in range(1 + max(found, default=-1))).rstrip()
            for found in lines
        ]

    def _join(self, line: int, column: int, ways: int) -> None:
        self._ways[line, column] = self._ways.get((line, column), 0) | ways
