"""Every range of the paper at both ends, and the result code behind it."""

from __future__ import annotations

import pytest

from fatektool.plcports.codes import CODES, TRANSACTIONS, meaning, next_step
from fatektool.plcports.kinds import TableKind
from fatektool.plcports.messages import MessageTable
from fatektool.plcports.operands import TableOperand
from fatektool.plcports.rows import SharedBlock, Transaction
from fatektool.plcports.tables import ClinkTable, HighSpeedTable, MbusTable
from tests.rows import each

CLINK_RANGES = """\
0 X 0 255 1
1 Y 0 255 1
2 M 0 1911 1
3 S 0 999 1
4 T 0 255 1
5 C 0 255 1
6 WX 0 240 8
7 WY 0 240 8
8 WM 0 1896 8
9 WS 0 984 8
10 TR 0 255 1
11 CR 0 199 1
12 R 0 3839 1
13 D 0 4095 1
"""
MD3_RANGES = "12 R 0 3839 1\n13 D 0 3999 1\n"
MBUS_MASTERS = "1 Y 0 255 1\n2 M 0 1911 1\n3 S 0 999 1\n12 R 0 3839 1\n13 D 0 3999 1\n"


def ranges(text: str) -> list[tuple[int, int, int, int]]:
    lines = (line.split() for line in text.splitlines())
    return [(int(code), int(first), int(last), int(step)) for code, _, first, last, step in lines]


def md0(*values: int) -> list[int | None]:
    station, command, length, *rest = values
    master, slave = TableOperand(*rest[:2]), TableOperand(*rest[2:])
    return [f.code for f in ClinkTable((Transaction(station, command, length, master, slave),)).faults()]


def md3(*values: int) -> list[int | None]:
    station, command, length, *rest = values
    return [
        f.code for f in HighSpeedTable((SharedBlock(station, command, length, TableOperand(*rest)),)).faults()
    ]


def mbus(*values: int) -> list[int | None]:
    station, command, length, *rest = values
    master, slave = TableOperand(*rest[:2]), TableOperand(*rest[2:])
    return [f.code for f in MbusTable((Transaction(station, command, length, master, slave),)).faults()]


@each(("code", "first", "last", "step"), ranges(CLINK_RANGES))
def test_the_references_of_md0(code: int, first: int, last: int, step: int) -> None:
    for good in (first, first + step, last):
        assert md0(1, 1, 1, code, good, code, good) == []
    assert md0(1, 1, 1, code, last + step, code, first) == [5]
    assert md0(1, 1, 1, code, first, code, last + step) == [5]
    assert md0(1, 1, 1, code, 0xFFFF, code, first) == [5]
    if step > 1:
        for odd in (first + 1, last - 1):
            assert md0(1, 1, 1, code, odd, code, first) == [5]


@each(("code", "first", "last", "step"), ranges(CLINK_RANGES))
def test_all_of_the_data_must_be_within(code: int, first: int, last: int, step: int) -> None:
    stride = 16 if step == 8 else 1
    assert first + 7 * stride <= last
    assert md0(1, 1, 8, code, last - 7 * stride, code, 0) == []
    assert md0(1, 1, 9, code, last - 7 * stride, code, 0) == [5]


@each("master", range(14))
@each("slave", range(14))
def test_types_that_go_together_in_md0(master: int, slave: int) -> None:
    assert md0(1, 1, 1, master, 0, slave, 0) == ([] if (master <= 5) == (slave <= 5) else [6])


def test_the_other_columns_of_md0() -> None:
    good = (12, 0, 12, 100)
    assert md0(0, 2, 1, *good) == []
    assert md0(254, 1, 64, *good) == []
    assert md0(255, 1, 1, *good) == [None]
    assert md0(0, 1, 1, *good) == [0xA]
    for command in (0, 3, 255):
        assert md0(1, command, 1, *good) == [3]
    for length in (0, 65, 255):
        assert md0(1, 1, length, *good) == [2]
    for code in (14, 255):
        assert md0(1, 1, 1, code, 0, 12, 0) == [4]
        assert md0(1, 1, 1, 12, 0, code, 0) == [4]
    assert md0(255, 9, 0, 20, 0, 12, 4000) == [None, 3, 2, 4, 5]


@pytest.mark.parametrize(("code", "first", "last", "step"), ranges(MD3_RANGES))
def test_the_references_of_md3(code: int, first: int, last: int, step: int) -> None:
    assert md3(1, 4, 1, code, first) == []
    assert md3(1, 4, 1, code, last) == []
    assert md3(1, 4, 1, code, last + step) == [5]
    assert md3(1, 4, 32, code, last - 31) == []
    assert md3(1, 4, 32, code, last - 30) == [5]


def test_the_other_columns_of_md3() -> None:
    assert md3(254, 4, 32, 12, 0) == []
    for station in (0, 255):
        assert md3(station, 4, 1, 12, 0) == [None]
    for command in (0, 1, 2, 3, 5):
        assert md3(1, command, 1, 12, 0) == [3]
    for length in (0, 33):
        assert md3(1, 4, length, 12, 0) == [2]
    for code in (0, 11, 14):
        assert md3(1, 4, 1, code, 0) == [4]


@pytest.mark.parametrize(("code", "first", "last", "step"), ranges(MBUS_MASTERS))
def test_the_references_of_an_mbus_master(code: int, first: int, last: int, step: int) -> None:
    slave = (0, 1) if code < 10 else (4, 1)
    assert mbus(1, 2, 1, code, first, *slave) == []
    assert mbus(1, 2, 1, code, last, *slave) == []
    assert mbus(1, 2, 1, code, last + step, *slave) == [5]


@each("slave", [0, 1, 3, 4])
@each("master", [1, 2, 3, 12, 13])
@each("command", [1, 2, 3])
def test_what_mbus_reads_and_writes(master: int, slave: int, command: int) -> None:
    """The table of section 13.2.2: 0 and 1 go with Y M S, 3 and 4 with R D; 1 and 3 are read only."""
    expected = [4] if command != 1 and slave in {1, 3} else []
    if (master < 10) != (slave < 2):
        expected.append(6)
    assert mbus(1, command, 1, master, 0, slave, 1) == expected


def test_the_other_columns_of_mbus() -> None:
    registers, discretes = (12, 0, 4, 1), (2, 0, 0, 1)
    assert mbus(247, 1, 125, *registers) == []
    assert mbus(0, 2, 255, *discretes) == []
    assert mbus(0, 3, 1, *registers) == []
    assert mbus(0, 1, 1, *registers) == [0xA]
    assert mbus(248, 1, 1, *registers) == [None]
    for command in (0, 4):
        assert mbus(1, command, 1, *registers) == [3]
    assert mbus(1, 1, 126, *registers) == [2]
    assert mbus(1, 1, 0, *registers) == [2]
    assert mbus(1, 1, 0, *discretes) == [2]
    for code in (0, 4, 6, 11, 14):
        assert mbus(1, 1, 1, code, 0, 4, 1) == [4]
    for code in (2, 5):
        assert mbus(1, 1, 1, 12, 0, code, 1) == [4]
    assert mbus(1, 1, 1, 12, 0, 4, 0) == [5]
    assert mbus(1, 1, 1, 12, 0, 4, 65535) == []
    assert mbus(1, 1, 2, 12, 0, 4, 65535) == [5]


def test_the_marks_of_mbus() -> None:
    row = Transaction(1, 1, 1, TableOperand(12, 0), TableOperand(4, 1))
    assert MbusTable((row,)).faults() == []
    assert [(f.code, f.reason) for f in MbusTable((row,), mark=0xA551, row_words=8).faults()] == [
        (8, "SR+0: expected A550, got A551"), (8, "SR+1: expected a high byte of 07, got 08"),
    ]  # fmt: skip


def test_a_table_without_rows() -> None:
    for table in (ClinkTable(()), HighSpeedTable(()), MbusTable(())):
        assert [(f.row, f.code, f.reason) for f in table.faults()] == [
            (None, None, "the table has no transactions")
        ]


@pytest.mark.parametrize("receiver", [False, True])
def test_messages(receiver: bool) -> None:
    def codes(mode: int, length: int) -> list[int | None]:
        return [f.code for f in MessageTable(receiver, mode, 0, 0, (0,) * length).faults()]

    good = {0x00, 0x01, 0x80, 0x81} if receiver else {0x00, 0x01, 0x81}
    for mode in range(256):
        assert codes(mode, 1) == ([] if mode in good else [None])
    assert codes(0, 511) == []
    assert codes(0, 0) == ([] if receiver else [2])  # MD2 waits until the program fills its reply in


def test_a_fault_names_its_row() -> None:
    good, wrong = TableOperand(12, 0), TableOperand(12, 3840)
    rows = [Transaction(1, 1, 1, good, good), Transaction(1, 1, 1, good, wrong)]
    (fault,) = ClinkTable(tuple(rows)).faults()
    assert (fault.row, fault.code) == (1, 5)
    assert fault.reason == "slave R3840: expected R0 to R3839"


PAPER_CODES = {"md0": "0 2 3 4 5 6 A B", "md1": "0 2 A B", "md2": "0 2 A B", "md3": "0 2 3 4 5",
               "mbus": "0 2 3 4 5 6 7 8 A B"}  # fmt: skip


@pytest.mark.parametrize("kind", TableKind)
def test_each_kind_has_the_codes_that_the_paper_lists(kind: TableKind) -> None:
    assert [f"{code:X}" for code in CODES[kind]] == PAPER_CODES[kind.value].split()
    for code, words in CODES[kind].items():
        assert (words.next_step is None) == (code == 0)
        assert ("Modbus" in words.meaning) <= (kind is TableKind.MBUS)
        assert "row" not in (words.next_step or "") or not kind.is_message
        assert meaning(code, [kind]) == words.meaning


def test_a_code_means_what_its_kind_says() -> None:
    assert meaning(0, [TableKind.MD3]) == "the table's format is correct; the stations are not checked"
    assert "successful" not in meaning(0, [TableKind.MD3])
    assert "the ladder program of this PLC" in meaning(0xA, [TableKind.MD2])
    assert "wiring" not in (next_step(0xA, [TableKind.MD2]) or "")
    assert meaning(3, [TableKind.MD1]) == "a code that the paper does not list"
    assert next_step(3, [TableKind.MD1]) is None


def test_where_the_kind_is_not_known_each_reading_is_given() -> None:
    assert meaning(0, list(TableKind)) == (
        "md0, md1, md2, mbus: the transaction was successful; "
        "md3: the table's format is correct; the stations are not checked"
    )
    assert meaning(7, list(TableKind)) == "mbus: port error: not port 1 to 4"
    assert meaning(1, list(TableKind)) == "a code that the paper does not list"
    assert meaning(0xA, TRANSACTIONS) == "no answer from the station within the time-out"
    assert next_step(0, list(TableKind)) is None
