"""The fields of a JSON document that is checked to the last byte: taken one by one, each by its type."""

from __future__ import annotations

import reprlib
from typing import Any

from fatektool.errors import DataError


class CheckedDocument:
    """Parses a document; raises the first fault.

    Args:
        name: the file's name, for messages.
    """

    def __init__(self, name: str) -> None:
        self.name = name

    def part(self, document: dict[str, Any], key: str, where: str = "") -> dict[str, Any]:
        """An object."""
        value = document.get(key)
        if not isinstance(value, dict):
            raise self.fault(f"{where}{key}: expected an object", value)
        return value

    def text(self, document: dict[str, Any], key: str, where: str = "") -> str:
        """A text."""
        value = document.get(key)
        if not isinstance(value, str):
            raise self.fault(f"{where}{key}: expected a text", value)
        return value

    def number(self, document: dict[str, Any], key: str, first: int, last: int, where: str = "") -> int:
        """A whole number of a range."""
        value = document.get(key)
        if not isinstance(value, int) or isinstance(value, bool) or not first <= value <= last:
            raise self.fault(f"{where}{key}: expected a whole number of {first} to {last}", value)
        return value

    def same(self, what: str, expected: object, got: object, source: str = "the pages") -> None:
        """Refuse what is not as computed."""
        if expected != got or type(expected) is not type(got):
            raise self.fault(f"{what}: expected {expected!r} from {source}", got)

    def fault(self, what: str, got: object) -> DataError:
        """The error for a field."""
        return DataError(
            f"{self.name}: {what}, got {short(got)}",
            hint="the file is damaged or was edited: use another backup",
        )


def short(value: object) -> str:
    """A value for a message, at most some 60 characters."""
    size = f" ({len(value)} characters)" if isinstance(value, str) and len(value) > 30 else ""
    return reprlib.repr(value) + size
