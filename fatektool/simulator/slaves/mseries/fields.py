"""The notation of fields in M-series requests: bytes.

::

    n        1 byte             00 is 256 where 256 is allowed
    element  58 00 10           X16: the symbol in ASCII, 1 to 3 bytes, then the address, high byte first
             44 57 4D 00 00     DWM0
    value    1, 2 or 4 bytes by the element's width, high byte first; a discrete is 00 or 01

A symbol has no length field: 44 may be D or the beginning of DD, DF, DR, DRT or DWX. The longest symbol that
matches is used. No address below 4300H begins with a byte that would make a symbol longer (M-series
paper, section 2.4).
"""

from __future__ import annotations

from fatektool.simulator.elements import KINDS, SymbolKind
from fatektool.simulator.refusal import Refusal, RefusalCode
from fatektool.simulator.slaves.fatek.fields import Fields

_BY_SYMBOL = {symbol.encode("ascii"): kind for symbol, kind in KINDS.items()}
_SYMBOL_LENGTHS = (3, 2, 1)


class MSeriesFields(Fields):
    """A cursor over bytes."""

    def take_number(self) -> int | None:
        """One byte."""
        return self.take(1)[0]

    def take_digit(self) -> int | None:
        """One byte."""
        return self.take(1)[0]

    def take_content(self, count: int) -> bytes:
        """The same bytes."""
        return self.take(count)

    def element(self, *widths: int) -> tuple[SymbolKind, int]:
        """The longest symbol that matches, and two bytes."""
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

    def states(self, count: int) -> bytes:
        """One byte each."""
        states = self.take(count)
        if states.translate(None, b"\x00\x01"):
            raise Refusal(RefusalCode.ILLEGAL_VALUE)
        return states

    def written(self, content: bytes) -> bytes:
        """The same bytes."""
        return content

    def written_states(self, states: bytes) -> bytes:
        """One byte each."""
        return states
