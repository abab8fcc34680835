"""The characters that lines and signs are made of: box characters, or ASCII where there are none."""

from __future__ import annotations

from typing import TYPE_CHECKING, Final

if TYPE_CHECKING:
    from fatektool.ladder.drawing.text.letters import Letters

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
        self.has_boxes = letters.has("".join(set(_BOX.values())))
        arrows = letters.has("↑↓►")
        self.contact = ("┤", "├") if self.has_boxes else ("]", "[")
        self.rising, self.falling = ("↑", "↓") if arrows else ("^", "v")
        self.onward = "►" if arrows else ">"

    def in_ascii(self) -> None:
        """Draw no box characters."""
        self.has_boxes, self.contact = False, ("]", "[")

    def line(self, ways: int) -> str:
        """The character of a line that goes these ways."""
        return _BOX[ways] if self.has_boxes else _ASCII.get(ways, "+")
