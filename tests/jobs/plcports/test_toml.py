"""The TOML form: as people write it, both ways without loss, and what is wrong with it named."""

from __future__ import annotations

from typing import TYPE_CHECKING

import pytest
from hypothesis import given

from fatektool.errors import DataError
from fatektool.jobs.plcports.toml import load_table
from fatektool.jobs.plcports.toml_text import dump_table
from tests.plcports.samples import TABLES, tables
from tests.rows import each

if TYPE_CHECKING:
    from fatektool.plcports.tables import Table

WRITTEN = {
    "md0": """\
kind = "md0"

[[transaction]]
station = 2
command = "read"
length = 4
master = "R0"
slave = "R100"

[[transaction]]
station = 0
command = "write"
length = 64
master = "M8"
slave = "Y16"
""",
    "md0 with bytes that the PLC does not take": """\
kind = "md0"
count_high = 0x11

[[transaction]]
station = 2
command = "read"
length = 4
master = "R564"
slave = "D2748"
high_bytes = [34, 51, 68, 85, 102]
""",
    "md3": """\
kind = "md3"

[[transaction]]
station = 1
command = "high-speed"
length = 32
data = "R0"

[[transaction]]
station = 2
command = "high-speed"
length = 16
data = "R32"
reserved = [57005, 48879]
""",
    "mbus": """\
kind = "mbus"
reserved = 0x5A5A

[[transaction]]
station = 1
command = "read"
length = 10
master = "R0"
slave = "400001"

[[transaction]]
station = 3
command = "write-single"
length = 1
master = "Y7"
slave = "065535"
""",
    "md1": """\
kind = "md1"
mode = 0x01  # send, then receive without errors
start_code = 0x02
end_code = 0x03
data = "02 4F 4B 03"
""",
    "md2": """\
kind = "md2"
mode = 0x81  # receive even with errors, then reply
start_code = 0x0A
end_code = 0x0D
data = ""
""",
    "md1 with bytes that the PLC does not take": """\
kind = "md1"
mode = 0x00  # send only
mode_high = 0x77
start_code = 0x00
end_code = 0x00
data = "1241 42"
""",
}


@pytest.mark.parametrize("name", TABLES)
def test_as_people_write_it(name: str) -> None:
    _, _, table = TABLES[name]
    assert dump_table(table) == WRITTEN[name]
    assert load_table(WRITTEN[name].encode(), name) == table


@given(tables)
def test_both_ways(table: Table) -> None:
    text = dump_table(table)
    found = load_table(text.encode(), "x.toml")
    assert found == table
    assert dump_table(found) == text


def test_what_no_paper_lists_is_a_number() -> None:
    text = WRITTEN["md0"].replace('"read"', "7").replace('"R0"', '"20:5"')
    table = load_table(text.encode(), "x.toml")
    assert table.to_words()[1:6] == (2, 7, 4, 20, 5)
    assert dump_table(table) == text


def test_a_reserved_word_that_is_not_named_is_left_alone() -> None:
    text = WRITTEN["mbus"].replace("reserved = 0x5A5A\n", "")
    table = load_table(text.encode(), "x.toml")
    assert table.to_words() == TABLES["mbus"][1][:-1]
    assert dump_table(table) == text


WRONG = [
    (
        "md0",
        "kind =",
        "kin =",
        'kind: expected one of md0, md1, md2, md3, mbus, got None; begin with kind = "md0"',
    ),
    ("md0", '"md0"', '"md4"', "kind: expected one of md0, md1, md2, md3, mbus, got 'md4'"),
    ("md0", '"md0"', '["md0"]', "kind: expected one of"),
    ("md0", 'kind = "md0"', 'kind = "md0', "invalid TOML: .*line 1"),
    (
        "md0",
        'kind = "md0"',
        'kind = "md0"\nmark = 1',
        "unknown key 'mark': expected one of kind, transaction, co",
    ),
    ("md0", "[[transaction]]", "[transaction]", "invalid TOML"),
    ("md3", "[[transaction]]", "[[transactions]]", "unknown key 'transactions'"),
    (
        "md0",
        "length = 64",
        "lenght = 64",
        "transaction 1: unknown key 'lenght': expected one of station, comm",
    ),
    ("md0", "length = 64\n", "", "transaction 1: no length: expected a whole number"),
    ("md0", "length = 64", 'length = "64"', "transaction 1: length: expected a whole number, got '64'"),
    ("md0", "length = 64", "length = 64.0", "transaction 1: length: expected a whole number, got 64.0"),
    ("md0", "length = 64", "length = true", "transaction 1: length: expected a whole number, got True"),
    ("md0", "length = 64", "length = 256", "transaction 1: length: expected 0 to 255, got 256"),
    ("md0", "station = 2", "station = -1", "transaction 0: station: expected 0 to 255, got -1"),
    ("md0", '"read"', '"raed"', 'transaction 0: command: expected "read" or "write", got \'raed\''),
    ("md0", '"read"', "true", 'transaction 0: command: expected "read" or "write", got True'),
    ("md0", '"read"', "256", "transaction 0: command: expected 0 to 255, got 256"),
    (
        "md0",
        '"R0"',
        '"Q0"',
        "transaction 0: master: 'Q0': expected one of X Y M S T C WX WY WM WS TR CR R D and",
    ),
    ("md0", '"R0"', '"R99999"', "transaction 0: master: reference: expected 0 to 65535, got 99999"),
    ("md0", '"R0"', "100", 'transaction 0: master: expected a text such as "R100", got 100'),
    ("md0", 'slave = "Y16"', "high_bytes = 1", "transaction 1: no slave"),
    (
        "md0",
        'slave = "Y16"',
        'slave = "Y16"\nhigh_bytes = 1',
        "transaction 1: high_bytes: expected whole numbers",
    ),
    (
        "md0",
        'slave = "Y16"',
        'slave = "Y16"\nhigh_bytes = [1]',
        "transaction 1: high_bytes: number missing",
    ),
    ("md3", '"R32"', '"Y32"', "transaction 1: data: 'Y32': expected one of R D and"),
    ("md3", "48879]", "48879, 1]", "transaction 1: reserved: number: expected 0 to 2, got 3"),
    ("md3", '"high-speed"', '"read"', 'transaction 0: command: expected "high-speed", got'),
    ("mbus", '"400001"', '"R5"', "transaction 0: slave: 'R5': expected a Modbus reference such as 400001"),
    ("mbus", "0x5A5A", "0x15A5A", "reserved: expected 0 to 65535, got 88666"),
    ("md1", "0x01 ", "0x101 ", "mode: expected 0 to 255, got 257"),
    ("md1", '"02 4F 4B 03"', '"02 4F xx 03"', "data: expected bytes in hex such as .*, got 'xx'"),
    ("md1", '"02 4F 4B 03"', '"12345"', "data: expected bytes in hex such as .*, got '12345'"),
    ("md1", "mode", "length = 3\nmode", "length: expected 4, as the data has, got 3"),
    ("md1", "mode", "station = 3\nmode", "unknown key 'station': expected one of kind, mode"),
]


@each(("name", "before", "after", "said"), WRONG)
def test_what_is_wrong_is_named(name: str, before: str, after: str, said: str) -> None:
    text = WRITTEN[name]
    at = text.rindex(before) if name == "md0" and before == "length = 64" else text.index(before)
    changed = text[:at] + after + text[at + len(before) :]
    with pytest.raises(DataError, match=f"^x.toml: {said}") as found:
        load_table(changed.encode(), "x.toml")
    assert "\n" not in str(found.value)


@pytest.mark.parametrize(
    "data", [b"\xff", b"kind = 'md0'\ntransaction = 5", b"kind = 'md0'\ntransaction = [5]", b"", b"[" * 5000]
)
def test_what_is_no_table_at_all(data: bytes) -> None:
    with pytest.raises(DataError, match=r"^x\.toml: "):
        load_table(data, "x.toml")
