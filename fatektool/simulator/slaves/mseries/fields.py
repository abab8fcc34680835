"""Reads the fields of an M-series request's data one after the other, and says no as a PLC does.

::

    n        1 byte             00 is 256 where 256 is allowed
    element  58 00 10           X16: the symbol in ASCII, 1 to 3 bytes, then the address, high byte first
             44 57 4D 00 00     DWM0
    value    1, 2 or 4 bytes by the element's width, high byte first; a discrete is 00 or 01

A symbol has no length of its own: 44 may be D or the start of DD, DF, DR, DRT or DWX. The longest symbol that
is there is the one. No address below 4300H begins with a byte that would make a symbol longer (M-series
paper, section 2.4).

Which error a bad field is (section 2.3 gives the words):

* **4, illegal format**: too few or too many bytes, an unknown symbol, a register where a discrete is due or
  the other way round.
* **2, illegal value**: an n, a control code or a discrete's state out of its range.
* **A, illegal address**: every element of the right form that this PLC does not have.
"""

from __future__ import annotations

from fatektool.simulator.elements import KINDS, Kind
from fatektool.simulator.refusal import Refusal, RefusalCode

_BY_SYMBOL = {symbol.encode("ascii"): kind for symbol, kind in KINDS.items()}
_SYMBOL_LENGTHS = (3, 2, 1)


def value_bytes(kind: Kind) -> int:
    """Bytes of one value: 1, 2 or 4."""
    return (kind.bits + 7) // 8


class Fields:
    """A cursor over the data of one request."""

    def __init__(self, data: bytes) -> None:
        self._data = data
        self._position = 0

    def take(self, count: int) -> bytes:
        """The next ``count`` bytes."""
        start = self._position
        self._position = end = start + count
        if end > len(self._data):
            raise Refusal(RefusalCode.ILLEGAL_FORMAT)
        return self._data[start:end]

    def end(self) -> None:
        """Refuses anything that is left."""
        if self._position != len(self._data):
            raise Refusal(RefusalCode.ILLEGAL_FORMAT)

    def count(self, limit: int) -> int:
        """n, 1 to ``limit``; 00 means 256 if that is the limit."""
        value = self.take(1)[0]
        if value == 0 and limit == 256:
            return limit
        if not 1 <= value <= limit:
            raise Refusal(RefusalCode.ILLEGAL_VALUE)
        return value

    def code(self, first: int, last: int) -> int:
        """A control code."""
        value = self.take(1)[0]
        if not first <= value <= last:
            raise Refusal(RefusalCode.ILLEGAL_VALUE)
        return value

    def element(self, *widths: int) -> tuple[Kind, int]:
        """An element of one of ``widths`` bits: its kind and address."""
        start = self._position
        for length in _SYMBOL_LENGTHS:
            kind = _BY_SYMBOL.get(self._data[start : start + length])
            if kind is not None:
                break
        else:
            raise Refusal(RefusalCode.ILLEGAL_FORMAT)
        if kind.bits not in widths:
            raise Refusal(RefusalCode.ILLEGAL_FORMAT)
        self._position = start + len(kind.symbol)
        return kind, int.from_bytes(self.take(2), "big")

    def values(self, kind: Kind, count: int) -> list[int]:
        """``count`` values of a register's width."""
        width = value_bytes(kind)
        data = self.take(width * count)
        return [int.from_bytes(data[at : at + width], "big") for at in range(0, len(data), width)]

    def states(self, count: int) -> bytes:
        """``count`` states of discretes as bytes 0 or 1."""
        states = self.take(count)
        if states.translate(None, b"\x00\x01"):
            raise Refusal(RefusalCode.ILLEGAL_VALUE)
        return states
