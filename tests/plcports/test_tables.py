"""Tables as registers hold them: literal words, both ways, nothing lost; how long a table is."""

from __future__ import annotations

from typing import TYPE_CHECKING

import pytest
from hypothesis import given
from hypothesis import strategies as st

from fatektool.errors import DataError, UsageError
from fatektool.plcports.kinds import TableKind
from fatektool.plcports.messages import MAX_MESSAGE, MessageTable
from fatektool.plcports.operands import CLINK_TYPES, MBUS_MASTER_TYPES, MBUS_SLAVE_TYPES, TableOperand
from fatektool.plcports.results import Fault
from fatektool.plcports.rows import SharedBlock, Transaction
from fatektool.plcports.tables import ClinkTable, Table, kind_of, parse_table, place_faults, table_words
from fatektool.protocol.elements import Element
from tests.plcports.samples import TABLES, tables

if TYPE_CHECKING:
    from random import Random


@pytest.mark.parametrize("name", TABLES)
def test_words_and_values(name: str) -> None:
    kind, words, table = TABLES[name]
    assert parse_table(kind, words) == table
    assert table.to_words() == words
    assert kind_of(table) is kind


@pytest.mark.parametrize("name", TABLES)
def test_the_head_tells_the_length(name: str) -> None:
    kind, words, _ = TABLES[name]
    assert table_words(kind, words[: kind.head_words]) == len(words)
    for count in range(len(words)):
        with pytest.raises(DataError, match=f"got {count}"):
            parse_table(kind, words[:count])
    with pytest.raises(DataError, match=f"expected {len(words)} words"):
        parse_table(kind, (*words, 0))


@given(tables)
def test_both_ways(table: Table) -> None:
    assert parse_table(kind_of(table), table.to_words()) == table


@given(
    st.sampled_from(TableKind),
    st.lists(st.integers(0, 0xFFFF), min_size=3, max_size=3),
    st.randoms(use_true_random=False),
)
def test_any_words_are_a_table_that_goes_back_as_it_came(
    kind: TableKind, head: list[int], random: Random
) -> None:
    head = [word & 0xFF03 for word in head]  # short ones
    count = table_words(kind, head)
    words = [*head, *(random.randrange(0x10000) for _ in range(count))][:count]
    table = parse_table(kind, words)
    assert table.to_words() == tuple(words)
    assert all(fault.reason for fault in table.faults())


def test_a_message_longer_than_there_may_be() -> None:
    words = (0, 0, 600, *range(MAX_MESSAGE))
    table = parse_table(TableKind.MD1, words)
    assert isinstance(table, MessageTable)
    assert (table.message_length, len(table.data)) == (600, 511)
    assert table.to_words() == words
    assert table.faults() == [Fault(None, 2, "length: expected 1 to 511, got 600")]


def test_data_are_the_low_bytes() -> None:
    _, _, table = TABLES["md1 with bytes that the PLC does not take"]
    assert isinstance(table, MessageTable)
    assert table.message == b"AB"


@pytest.mark.parametrize(
    ("text", "code", "reference"),
    [
        ("X0", 0, 0), ("Y255", 1, 255), ("m1911", 2, 1911), ("S999", 3, 999), ("T1", 4, 1), ("C2", 5, 2),
        ("WX240", 6, 240), ("WY0", 7, 0), ("WM1896", 8, 1896), ("WS984", 9, 984), ("TR255", 10, 255),
        ("RT255", 10, 255), ("CR199", 11, 199), ("RC199", 11, 199), ("R3839", 12, 3839), ("D4095", 13, 4095),
        ("20:100", 20, 100),
    ],
)  # fmt: skip
def test_operands_of_clink(text: str, code: int, reference: int) -> None:
    assert TableOperand.parse(text, CLINK_TYPES) == TableOperand(code, reference)
    canonical = text.upper().replace("RT", "TR").replace("RC", "CR")
    assert TableOperand(code, reference).written(CLINK_TYPES) == canonical


@pytest.mark.parametrize(
    ("text", "code", "reference"),
    [("000001", 0, 1), ("100001", 1, 1), ("365535", 3, 65535), ("400101", 4, 101), ("40101", 4, 101)],
)
def test_operands_of_modbus_slaves(text: str, code: int, reference: int) -> None:
    assert TableOperand.parse(text, MBUS_SLAVE_TYPES) == TableOperand(code, reference)
    assert TableOperand(code, reference).written(MBUS_SLAVE_TYPES) == f"{text[0]}{reference:05}"


@given(st.builds(TableOperand, st.integers(0, 255), st.integers(0, 0xFFFF)))
def test_operands_both_ways(operand: TableOperand) -> None:
    for types in (CLINK_TYPES, MBUS_MASTER_TYPES, MBUS_SLAVE_TYPES):
        assert TableOperand.parse(operand.written(types), types) == operand


@pytest.mark.parametrize(
    "text", ["", "R", "100", "Z1", "R-1", "R65536", "WX999999", "256:0", "1:65536", "F1"]
)
def test_no_operand(text: str) -> None:
    with pytest.raises(UsageError):
        TableOperand.parse(text, CLINK_TYPES)


@pytest.mark.parametrize("text", ["R100", "200001", "4001", "4000001", "466000", "X0"])
def test_no_operand_of_a_modbus_slave(text: str) -> None:
    with pytest.raises(UsageError):
        TableOperand.parse(text, MBUS_SLAVE_TYPES)


def test_what_fits_no_word() -> None:
    good = TableOperand(12, 0)
    for values in ((256, 1, 1), (1, -1, 1), (1, 1, 256)):
        with pytest.raises(UsageError):
            Transaction(*values, good, good)
        with pytest.raises(UsageError):
            SharedBlock(*values, good)
    for high in ((0,) * 4, (0,) * 6, (0, 0, 0, 0, 256)):
        with pytest.raises(UsageError, match="high_bytes"):
            Transaction(1, 1, 1, good, good, high)
    for reserved in ((0,), (0, 0, 0), (0, 65536)):
        with pytest.raises(UsageError, match="reserved"):
            SharedBlock(1, 4, 1, good, reserved)
    with pytest.raises(UsageError, match="expected 0 to 255, got 256"):
        ClinkTable((Transaction(1, 1, 1, good, good),) * 256)
    with pytest.raises(UsageError, match="expected 2, as the data has, got 3"):
        MessageTable(False, 0, 0, 0, (1, 2), 3)  # noqa: FBT003  # not MD2
    with pytest.raises(UsageError, match="at most 511 bytes, got 512"):
        MessageTable(False, 0, 0, 0, (0,) * 512)  # noqa: FBT003  # not MD2


@pytest.mark.parametrize(
    ("start", "count", "said"),
    [
        ("R0", 8, None), ("R3832", 8, None), ("R3833", 8, "end at R3840, past R3839"),
        ("R4999", 8, "expected R0 to R3839"), ("R5000", 3072, None), ("R5000", 3073, "past R8071"),
        ("D3999", 1, None), ("D3999", 2, "past D3999"), ("D4000", 1, "expected R0"),
        ("WM0", 1, "expected R0"),
    ],
)  # fmt: skip
def test_where_a_table_may_be(start: str, count: int, said: str | None) -> None:
    found = place_faults(Element.parse(start), count)
    assert [fault.code for fault in found] == ([] if said is None else [None])
    assert all(said is not None and said in fault.reason for fault in found)
