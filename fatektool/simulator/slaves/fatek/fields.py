"""Parses the fields of a request's data one after the other, and refuses them as a PLC does.

FACON and the M-series have the same fields in the same order; the notation is in the ``fields`` of each.

The error of a bad field (FACON paper, section 3; M-series paper, section 2.3):

* **4, illegal format**: too few or too many bytes, an unknown symbol, a register instead of a discrete or
  the reverse.
* **2, illegal value**: an n, a control code or a discrete's state out of its range.
* **A, illegal address**: every element of the right form that this PLC does not have.
"""

from __future__ import annotations

from abc import ABC, abstractmethod
from typing import TYPE_CHECKING

from fatektool.simulator.refusal import Refusal, RefusalCode

if TYPE_CHECKING:
    from fatektool.simulator.elements import SymbolKind


class Fields(ABC):
    """A cursor over the data of one request, and the notation of an answer."""

    def __init__(self, data: bytes) -> None:
        self._data = data
        self._position = 0

    def take(self, count: int) -> bytes:
        """The next ``count`` bytes on the wire."""
        start = self._position
        self._position = end = start + count
        if end > len(self._data):
            raise Refusal(RefusalCode.ILLEGAL_FORMAT)
        return self._data[start:end]

    def end(self) -> None:
        """Refuse further data."""
        if self._position != len(self._data):
            raise Refusal(RefusalCode.ILLEGAL_FORMAT)

    def count(self, limit: int) -> int:
        """n, 1 to ``limit``; 00 means 256 if that is the limit."""
        value = self.take_number()
        if value == 0 and limit == 256:
            return limit
        if value is None or not 1 <= value <= limit:
            raise Refusal(RefusalCode.ILLEGAL_VALUE)
        return value

    def code(self, first: int, last: int) -> int:
        """A control code."""
        value = self.take_digit()
        if value is None or not first <= value <= last:
            raise Refusal(RefusalCode.ILLEGAL_VALUE)
        return value

    def values(self, kind: SymbolKind, count: int) -> list[int]:
        """``count`` values of a register's width."""
        width = kind.bits // 8
        data = self.take_content(width * count)
        return [int.from_bytes(data[at : at + width], "big") for at in range(0, len(data), width)]

    def written_value(self, kind: SymbolKind, value: int) -> bytes:
        """One value for an answer."""
        if kind.bits == 1:
            return self.written_states(bytes((value,)))
        return self.written(value.to_bytes(kind.bits // 8, "big"))

    @abstractmethod
    def take_number(self) -> int | None:
        """The number in an n, 0 to 255; None if invalid."""

    @abstractmethod
    def take_digit(self) -> int | None:
        """The number in a control code; None if invalid."""

    @abstractmethod
    def take_content(self, count: int) -> bytes:
        """``count`` bytes of content."""

    @abstractmethod
    def element(self, *widths: int) -> tuple[SymbolKind, int]:
        """An element of one of ``widths`` bits: its kind and address."""

    @abstractmethod
    def states(self, count: int) -> bytes:
        """``count`` states of discretes as bytes 0 or 1."""

    @abstractmethod
    def written(self, content: bytes) -> bytes:
        """Bytes of content, for an answer."""

    @abstractmethod
    def written_states(self, states: bytes) -> bytes:
        """States of discretes, bytes 0 or 1, for an answer."""
