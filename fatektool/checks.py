"""Checks of values: the same for an option, a key of a file and an argument."""

from __future__ import annotations

from abc import ABC, abstractmethod
from math import inf
from typing import TYPE_CHECKING, Generic, TypeVar

from fatektool.errors import UsageError

if TYPE_CHECKING:
    from collections.abc import Iterable

T = TypeVar("T")

_SHOWN_CHARS = 60


class Check(ABC, Generic[T]):
    """The check of a value.

    Attributes:
        expected: the valid values as text, to follow "expected" in a message.
    """

    expected: str

    def take(self, value: object) -> T:
        """The value, as it is used.

        Raises:
            ValueError: an invalid value; the message has what was expected, and the value.
        """
        taken = self._taken(value)
        if taken is None:
            raise ValueError(f"expected {self.expected}, got {_shown(value)}")
        return taken

    def parse(self, text: str) -> T:
        """The value in a text, as on the command line.

        Raises:
            ValueError: as ``take``.
        """
        return self.take(self._read(text))

    def require(self, name: str, value: object) -> T:
        """The value of a setting of this name.

        Raises:
            UsageError: as ``take``, with the name before the message.
        """
        try:
            return self.take(value)
        except ValueError as error:
            raise UsageError(f"{name}: {error}") from None

    @abstractmethod
    def _taken(self, value: object) -> T | None:
        """The value as it is used; None if it is invalid."""

    def _read(self, text: str) -> object:
        """The value in a text; the text itself if it is no number."""
        return text


class WholeNumber(Check[int]):
    """A whole number, from ``least`` to ``most``."""

    def __init__(self, least: int, most: int) -> None:
        self.least = least
        self.most = most
        self.expected = f"a whole number from {least} to {most}"

    def _taken(self, value: object) -> int | None:
        number = value if isinstance(value, int) and not isinstance(value, bool) else None
        return number if number is not None and self.least <= number <= self.most else None

    def _read(self, text: str) -> object:
        try:
            return int(text)
        except ValueError:
            return text


class Seconds(Check[float]):
    """Seconds, from ``least`` to ``most``; with ``above``, ``least`` itself is invalid."""

    def __init__(self, least: float, most: float, *, above: bool = False) -> None:
        self.least = least
        self.most = most
        self.above = above
        self.expected = f"seconds {'above' if above else 'from'} {least:g}"
        if most != inf:
            self.expected += f"{',' if above else ''} {'up ' if above else ''}to {most:g}"

    def _taken(self, value: object) -> float | None:
        if not isinstance(value, int | float) or isinstance(value, bool):
            return None
        if not self.least <= value <= self.most or (self.above and value == self.least):  # NaN fails too
            return None
        return float(value)

    def _read(self, text: str) -> object:
        try:
            return float(text)
        except ValueError:
            return text


class OneOf(Check[str]):
    """One of some words."""

    def __init__(self, words: Iterable[str], expected: str | None = None) -> None:
        self.words = tuple(words)
        self.expected = expected or f"one of {', '.join(self.words)}"

    def _taken(self, value: object) -> str | None:
        return str(value) if value in self.words else None


class YesNo(Check[bool]):
    """True or false."""

    expected = "true or false"

    def _taken(self, value: object) -> bool | None:
        return value if isinstance(value, bool) else None


class Text(Check[str]):
    """A text that is not empty."""

    def __init__(self, example: str) -> None:
        self.expected = f"a string such as {example}"

    def _taken(self, value: object) -> str | None:
        return value if isinstance(value, str) and value.strip() else None


def _shown(value: object) -> str:
    try:
        return f"{value!r:.{_SHOWN_CHARS}}"
    except (ValueError, RecursionError):  # a number of thousands of digits
        return "a very long number"
