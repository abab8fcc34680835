"""The elements in a PLC's memory, without the notation of a protocol.

An element is a symbol and an address. The symbol decides the *area* and the width of one element::

    symbol            area        bits  step   example
    X Y M S T C       discretes      1     1   Y9
    WX .. WC          discretes     16    16   WM8   = M23..M8, M8 the lowest bit
    DWX .. DWC        discretes     32    32   DWM0  = M31..M0
    R D F RT RC       registers     16     1   R12
    DR DD DF DRT DRC  registers     32     2   DR0   = R1 * 65536 + R0

``step`` is the size of one element in its area, and so the distance of consecutive elements (FACON paper,
section 4.1).
"""

from __future__ import annotations

from dataclasses import dataclass

from fatektool.simulator.refusal import Refusal, RefusalCode

DISCRETE_AREAS = ("X", "Y", "M", "S", "T", "C")
REGISTER_AREAS = ("R", "D", "F", "RT", "RC")


@dataclass(frozen=True, slots=True)
class SymbolKind:
    """One symbol's meaning.

    Args:
        symbol: as written in a request, ``DWM``.
        area: of its elements, ``M``.
        bits: the width of one element: 1, 16 or 32.
        step: the size of one element in the area.
        packed: True for words made of discretes.
    """

    symbol: str
    area: str
    bits: int
    step: int
    packed: bool

    @property
    def words(self) -> int:
        """Words that one element counts in a request's limit: a discrete as much as a word."""
        return 2 if self.bits == 32 else 1


def _kinds() -> dict[str, SymbolKind]:
    kinds = []
    for area in DISCRETE_AREAS:
        kinds.append(SymbolKind(area, area, 1, 1, packed=False))
        kinds.append(SymbolKind(f"W{area}", area, 16, 16, packed=True))
        kinds.append(SymbolKind(f"DW{area}", area, 32, 32, packed=True))
    for area in REGISTER_AREAS:
        kinds.append(SymbolKind(area, area, 16, 1, packed=False))
        kinds.append(SymbolKind(f"D{area}", area, 32, 2, packed=False))
    return {kind.symbol: kind for kind in kinds}


KINDS = _kinds()


def kind_of(symbol: str, *widths: int) -> SymbolKind:
    """The kind of ``symbol``; refuses an unknown one, and one with another width than ``widths``."""
    kind = KINDS.get(symbol)
    if kind is None or (widths and kind.bits not in widths):
        raise Refusal(RefusalCode.ILLEGAL_FORMAT)
    return kind
