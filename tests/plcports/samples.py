"""Tables of every kind, as words and as values, for tests; and all tables there are, for hypothesis."""

from __future__ import annotations

from typing import TYPE_CHECKING

from hypothesis import strategies as st

from fatektool.plcports.kinds import TableKind
from fatektool.plcports.messages import MessageTable
from fatektool.plcports.operands import TableOperand
from fatektool.plcports.rows import SharedBlock, Transaction
from fatektool.plcports.tables import ClinkTable, HighSpeedTable, MbusTable, Table

if TYPE_CHECKING:
    from tests.plant import Plant

READ_R = (2, 1, 4, 12, 0, 12, 100)
"""Station 2, read 4: its R100 to R103 into R0 to R3."""
WRITE_M = (0, 2, 64, 2, 8, 1, 16)
"""Write M8 to M71 into Y16 to Y79 of all stations."""

TABLES: dict[str, tuple[TableKind, tuple[int, ...], Table]] = {
    "md0": (
        TableKind.MD0,
        (2, *READ_R, *WRITE_M),
        ClinkTable(
            (
                Transaction(2, 1, 4, TableOperand(12, 0), TableOperand(12, 100)),
                Transaction(0, 2, 64, TableOperand(2, 8), TableOperand(1, 16)),
            )
        ),
    ),
    "md0 with bytes that the PLC does not take": (
        TableKind.MD0,
        (0x1101, 0x2202, 0x3301, 0x4404, 0x550C, 0x0234, 0x660D, 0x0ABC),
        ClinkTable(
            (
                Transaction(
                    2, 1, 4, TableOperand(12, 0x0234), TableOperand(13, 0xABC), (0x22, 0x33, 0x44, 0x55, 0x66)
                ),
            ),
            0x11,
        ),
    ),
    # The common data of section 13.1.2, MD3: the master sends R0 to R31, station 2 R32 to R47.
    "md3": (
        TableKind.MD3,
        (2, 1, 4, 32, 12, 0, 0, 0, 2, 4, 16, 12, 32, 0xDEAD, 0xBEEF),
        HighSpeedTable(
            (
                SharedBlock(1, 4, 32, TableOperand(12, 0)),
                SharedBlock(2, 4, 16, TableOperand(12, 32), (0xDEAD, 0xBEEF)),
            )
        ),
    ),
    "mbus": (
        TableKind.MBUS,
        (0xA550, 0x0702, 1, 1, 10, 12, 0, 4, 1, 3, 3, 1, 1, 7, 0, 65535, 0x5A5A),
        MbusTable(
            (
                Transaction(1, 1, 10, TableOperand(12, 0), TableOperand(4, 1)),
                Transaction(3, 3, 1, TableOperand(1, 7), TableOperand(0, 65535)),
            ),
            reserved=0x5A5A,
        ),
    ),
    # The loop-back test of section 13.1.2, MD1: STX O K ETX, answered between 02H and 03H.
    "md1": (
        TableKind.MD1,
        (1, 0x0203, 4, 0x02, 0x4F, 0x4B, 0x03),
        MessageTable(receiver=False, mode=1, start_code=2, end_code=3, data=(0x02, 0x4F, 0x4B, 0x03)),
    ),
    # Its other end, MD2: the reply is not filled in yet; codes 0A0DH as in note 3.
    "md2": (
        TableKind.MD2,
        (0x81, 0x0A0D, 0),
        MessageTable(receiver=True, mode=0x81, start_code=0x0A, end_code=0x0D, data=()),
    ),
    "md1 with bytes that the PLC does not take": (
        TableKind.MD1,
        (0x7700, 0, 2, 0x1241, 0x0042),
        MessageTable(False, 0, 0, 0, (0x1241, 0x42), mode_high=0x77),  # noqa: FBT003  # not MD2
    ),
}


def put(plant: Plant, first: str, words: tuple[int, ...]) -> None:
    """Write words into a PLC, from a register on."""
    plant.write(f"{first}:{len(words)}={','.join(map(str, words))}")


byte = st.integers(0, 255)
word = st.integers(0, 0xFFFF)
operand = st.builds(TableOperand, byte, word)


def high_bytes(count: int) -> st.SearchStrategy[tuple[int, ...]]:
    some = st.tuples(*[byte] * count)
    return st.one_of(st.just((0,) * count), some)


row = st.builds(Transaction, byte, byte, byte, operand, operand, high_bytes(5))
block = st.builds(SharedBlock, byte, byte, byte, operand, st.tuples(word, word), high_bytes(4))


def _of(each: st.SearchStrategy[Transaction]) -> st.SearchStrategy[tuple[Transaction, ...]]:
    return st.lists(each, max_size=4).map(tuple)


messages = st.builds(
    MessageTable, st.booleans(), byte, byte, byte, st.lists(word, max_size=8).map(tuple), st.none(), byte
)
tables: st.SearchStrategy[Table] = st.one_of(
    st.builds(ClinkTable, _of(row), byte),
    st.builds(HighSpeedTable, st.lists(block, max_size=4).map(tuple), byte),
    st.builds(MbusTable, _of(row), word, byte, word),
    messages,
)
