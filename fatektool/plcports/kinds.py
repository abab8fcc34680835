"""The kinds of communication instruction, and the valid areas of their operands.

FBs link paper, sections 13.1.2 (CLINK, FUN151: MD0 to MD3) and 13.2.2 (M-BUS, FUN150); the operand tables
there give HR, ROR and DR for both SR and WR.
"""

from __future__ import annotations

from enum import Enum
from typing import TYPE_CHECKING, Final

if TYPE_CHECKING:
    from fatektool.protocol.elements import Element

OPERAND_AREAS: Final = (("R", 0, 3839), ("R", 5000, 8071), ("D", 0, 3999))
"""The valid areas of operands SR and WR: HR, ROR, DR."""


class TableKind(Enum):
    """The instruction and mode of a table, or of the registers from WR on."""

    MD0 = "md0"
    MD1 = "md1"
    MD2 = "md2"
    MD3 = "md3"
    MBUS = "mbus"

    @property
    def head_words(self) -> int:
        """The number of words that contain the length of the table."""
        return {TableKind.MD0: 1, TableKind.MD3: 1, TableKind.MBUS: 2}.get(self, 3)

    @property
    def is_message(self) -> bool:
        """True for a message of the user's own protocol: no transactions, but bytes sent and received."""
        return self in {TableKind.MD1, TableKind.MD2}


def misplaced(operand: str, start: Element, count: int) -> str | None:
    """What is wrong with the registers of an operand; None if nothing is.

    Args:
        operand: ``SR`` or ``WR``, for the message.
        start: the first register.
        count: the number of registers from there.
    """
    for symbol, first, last in OPERAND_AREAS:
        if start.symbol == symbol and first <= start.address <= last:
            end = start.address + count - 1
            if end <= last:
                return None
            return f"{operand} {start}: {count} words end at {symbol}{end}, past {symbol}{last}"
    areas = ", ".join(f"{symbol}{first} to {symbol}{last}" for symbol, first, last in OPERAND_AREAS)
    return f"{operand} {start}: expected {areas}"
