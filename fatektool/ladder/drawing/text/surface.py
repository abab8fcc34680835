"""What a band is drawn on: characters on a terminal, or a picture whose places are counted in characters."""

from __future__ import annotations

from enum import StrEnum
from typing import TYPE_CHECKING, Protocol

if TYPE_CHECKING:
    from fatektool.ladder.drawing.plan import Net
    from fatektool.ladder.drawing.text.cells import SignText


class Anchor(StrEnum):
    """Which part of a text keeps its place if the letters are narrower than counted."""

    START = "start"
    MIDDLE = "middle"
    END = "end"


class Surface(Protocol):
    """Lines of text from 0 down, columns of characters from 0 to the right."""

    def across(self, line: int, first: int, last: int, net: Net | None) -> None:
        """A wire from one column to another, both included; ``net`` is what it carries."""

    def down(self, column: int, first: int, last: int, net: Net | None) -> None:
        """A wire from one line to another, both included."""

    def rail(self, lines: int) -> None:
        """The rail on the left, of so many lines."""

    def sign(self, line: int, column: int, sign: SignText, number: int) -> None:
        """An instruction's sign, its first character in this column; it covers the wires under it."""

    def frame(self, lines: tuple[int, int], columns: tuple[int, int], title: str, number: int) -> None:
        """The edges of an instruction's box, its title in the upper one; first and last line and column."""

    def write(
        self, line: int, column: int, text: str, anchor: Anchor = Anchor.START, *, quiet: bool = False
    ) -> None:
        """A text, its first character in this column; ``quiet`` is a comment."""
