"""What text takes on a terminal: columns, not characters; and what a terminal's encoding can show.

A Chinese character takes two columns, a combining mark none. What cannot be shown, or would be obeyed, stands
there as a code, so that a text is as wide as it is counted.
"""

from __future__ import annotations

import unicodedata
from dataclasses import dataclass
from typing import TYPE_CHECKING, Final

if TYPE_CHECKING:
    from collections.abc import Iterator

_WIDE: Final = frozenset("WF")
_NO_WIDTH: Final = frozenset({"Mn", "Me"})


@dataclass(frozen=True, slots=True)
class Letters:
    """What can be written.

    Attributes:
        encoding: of the terminal or file.
    """

    encoding: str = "utf-8"

    def has(self, characters: str) -> bool:
        """True if all of these can be shown."""
        try:
            characters.encode(self.encoding)
        except (UnicodeEncodeError, LookupError):
            return False
        return True

    def spell(self, text: str) -> str:
        """A text as it will be seen: what is not to be shown as it is stands there as its code."""
        return "".join(map(self._spell, text))

    def _spell(self, character: str) -> str:
        if character.isprintable() and self.has(character):
            return character
        return character.encode("unicode_escape").decode("ascii")


def width_of(text: str) -> int:
    """The columns that a text takes."""
    return len(text) if text.isascii() else sum(map(_width, text))


def _width(character: str) -> int:
    if character.isascii():
        return 1
    if unicodedata.category(character) in _NO_WIDTH:
        return 0
    return 2 if unicodedata.east_asian_width(character) in _WIDE else 1


def pieces(text: str) -> Iterator[tuple[str, int]]:
    """Each character with the marks that stand on it, and the columns that it takes."""
    held, columns = "", 0
    for character in text:
        width = _width(character)
        if width and held:
            yield held, columns
            held, columns = "", 0
        held += character
        columns = max(columns, width)
    if held:
        yield held, columns


def wrapped(text: str, columns: int) -> list[str]:
    """A text in lines of so many columns, broken between words where that is possible.

    Args:
        text: without line ends.
        columns: at least 2.
    """
    lines: list[str] = []
    for word in text.split():
        for part in _parts(word, columns):
            if lines and width_of(lines[-1]) + 1 + width_of(part) <= columns:
                lines[-1] += f" {part}"
            else:
                lines.append(part)
    return lines


def _parts(word: str, columns: int) -> Iterator[str]:
    """A word; of one that is too long, pieces."""
    held, used = "", 0
    for piece, width in pieces(word):
        if used + width > columns:
            yield held
            held, used = "", 0
        held += piece
        used += width
    yield held
