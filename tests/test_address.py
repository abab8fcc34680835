"""A PLC's address: each value is checked once, whoever gives it, and what follows from it."""

from __future__ import annotations

import json
from dataclasses import fields
from pathlib import Path
from typing import TYPE_CHECKING, Any

import click
import pytest
from hypothesis import given
from hypothesis import strategies as st

import fatektool
from fatektool.address import CHECKS, DEFAULTS, PlcAddress, Settings
from fatektool.cli import run
from fatektool.cli.plc.status import status_command
from fatektool.cli.shared.connection_options import ROWS, Row, connection_options
from fatektool.errors import UsageError
from fatektool.inventory.entries import parse_inventory
from fatektool.protocol.registry import CODECS
from fatektool.protocols import PROTOCOLS

if TYPE_CHECKING:
    from fatektool.cli.shared.connection import Connection
    from fatektool.cli.shared.output import Voice

FIELDS = {each.name for each in fields(PlcAddress)}
OPTION = {row.field: max(row.words, key=len) for row in ROWS}

OTHER: dict[str, Any] = {
    "target": "tcp://127.0.0.1:1",
    "station": 2,
    "protocol": "mseries",
    "baud": 19200,
    "format": "8N1",
    "timeout_s": 1.5,
    "retries": 4,
    "lock_wait_s": 5.0,
    "read_only": True,
    "low_latency": False,
}
"""Of each field a value that is not its default."""

WRONG = [
    ("target", "", "expected a string such as tcp://192.168.2.3 or /dev/ttyUSB0, got ''"),
    ("station", 256, "expected a whole number from 1 to 254, over modbus-tcp 0 and 255 too, got 256"),
    ("station", -1, "expected a whole number from 1 to 254, over modbus-tcp 0 and 255 too, got -1"),
    ("station", "x", "expected a whole number from 1 to 254, over modbus-tcp 0 and 255 too, got 'x'"),
    ("protocol", "s7", f"expected one of {', '.join(PROTOCOLS)}, got 's7'"),
    ("baud", 49, "expected a whole number from 50 to 4000000, got 49"),
    ("baud", "fast", "expected a whole number from 50 to 4000000, got 'fast'"),
    ("format", "9X3", "expected data bits, parity and stop bits such as 7E1 or 8N1, got '9X3'"),
    ("timeout_s", 0.0, "expected seconds above 0, up to 86400, got 0.0"),
    ("timeout_s", 90000.0, "expected seconds above 0, up to 86400, got 90000.0"),
    ("timeout_s", float("nan"), "expected seconds above 0, up to 86400, got nan"),
    ("retries", 1001, "expected a whole number from 0 to 1000, got 1001"),
    ("retries", "1.5", "expected a whole number from 0 to 1000, got '1.5'"),
    ("lock_wait_s", -1.0, "expected seconds from 0 to 86400, got -1.0"),
    ("lock_wait_s", float("inf"), "expected seconds from 0 to 86400, got inf"),
]


@pytest.mark.parametrize(("field", "value", "words"), WRONG)
def test_a_wrong_value_is_refused_in_the_same_words_everywhere(
    field: str, value: Any, words: str, capsys: pytest.CaptureFixture[str], monkeypatch: pytest.MonkeyPatch
) -> None:
    """As an argument of ``connect``, as a key of the inventory, and as an option."""
    monkeypatch.delenv("FATEKTOOL_PORT", raising=False)
    settings = {"target": "sim:", field: value}
    with pytest.raises(UsageError) as raised:
        fatektool.connect(**settings)
    assert raised.value.message == f"{field}: {words}"

    keys = "".join(f"{key} = {_toml(value)}\n" for key, value in settings.items())
    (fault,) = parse_inventory(f"[plc.p]\n{keys}".encode(), Path("fatek.toml")).faults
    assert fault.message == f"plc.p: {field}: {words}"

    code = run(["status", *(word for key, value in settings.items() for word in (OPTION[key], str(value)))])
    told = capsys.readouterr().err
    assert code == 2
    assert words in told
    assert OPTION[field] in told


def _toml(value: object) -> str:
    return str(value) if isinstance(value, float) else json.dumps(value)


def test_each_wrong_value_has_a_case() -> None:
    of_flags = {field for field, check in CHECKS.items() if check.expected == "true or false"}
    assert {field for field, _, _ in WRONG} == CHECKS.keys() - of_flags


@pytest.mark.parametrize("field", ["read_only", "low_latency"])
def test_a_flag_is_true_or_false(field: str) -> None:
    with pytest.raises(UsageError, match=f"{field}: expected true or false, got 1"):
        PlcAddress("sim:", **{field: 1})  # type: ignore[arg-type]  # on purpose
    (fault,) = parse_inventory(f'[plc.p]\ntarget = "sim:"\n{field} = 1\n'.encode(), Path("f")).faults
    assert fault.message == f"plc.p: {field}: expected true or false, got 1"


# --- one field, one option, one key -----------------------------------------------------------------------


def test_the_arguments_by_name_are_the_fields() -> None:
    """``Settings`` is for type checkers, which cannot derive it."""
    written = {name: hint.__forward_arg__ for name, hint in Settings.__annotations__.items()}
    assert written == {each.name: each.type for each in fields(PlcAddress) if each.name != "target"}


def test_every_field_is_an_option_with_the_field_s_default() -> None:
    assert OPTION.keys() == FIELDS - {"modbus_map"}  # which is for commands that name elements
    options = {each.name: each for each in status_command.params}
    for row in ROWS:
        option = options[row.parameter]
        assert isinstance(option, click.Option)
        assert option.default == DEFAULTS.get(row.field)
        assert option.envvar == row.variable
        assert row.variable is None or f"[env: {row.variable}]" in str(option.help)


def test_every_field_with_a_check_is_a_key_of_the_inventory() -> None:
    assert OTHER.keys() == CHECKS.keys() == FIELDS - {"trace", "modbus_map"}
    keys = "".join(f"{key} = {_toml(value)}\n" for key, value in OTHER.items())
    found = parse_inventory(f"[plc.p]\n{keys}".encode(), Path("fatek.toml"))
    assert found.faults == []
    assert found.plcs["p"].address == PlcAddress(**OTHER)


@pytest.mark.parametrize("row", [row for row in ROWS if row.field in CHECKS.keys() - {"target"}])
def test_an_option_goes_before_the_inventory_even_if_it_is_the_default(row: Row, tmp_path: Path) -> None:
    """But for the one that can only be added: what is read-only stays so."""
    file = tmp_path / "fatek.toml"
    file.write_text("[plc.p]\n" + "".join(f"{key} = {_toml(value)}\n" for key, value in OTHER.items()))
    found: list[Connection] = []

    @click.command
    @connection_options
    def command(connection: Connection, voice: Voice) -> None:
        assert not voice.json
        found.append(connection)

    def address(*words: str) -> PlcAddress:
        command.main(["-p", "p", "--inventory", str(file), *words], standalone_mode=False)
        return found.pop().address

    assert address() == PlcAddress(**OTHER)
    default = DEFAULTS[row.field]
    wanted = "7O1" if default is None else default
    value = [] if isinstance(wanted, bool) else [str(wanted)]
    given = address(row.words[-1].partition("/")[0], *value)
    changed = {row.field: True if row.field == "read_only" else wanted}
    own_format = {"format": None} if row.field == "protocol" else {}
    assert given == PlcAddress(**{**OTHER, **own_format, **changed})


# --- what follows from the values -------------------------------------------------------------------------


@pytest.mark.parametrize(
    ("protocol", "line", "port"),
    [
        ("facon", "9600 7E1", 500),
        ("mseries", "9600 8E1", None),
        ("modbus-rtu", "9600 8E1", None),
        ("modbus-ascii", "9600 7E1", None),
        ("modbus-tcp", "9600 8E1", 502),
    ],
)
def test_what_a_protocol_brings_with_it(protocol: str, line: str, port: int | None) -> None:
    address = PlcAddress("tcp://h", protocol=protocol)
    assert str(address.line_settings) == line
    assert address.codec is CODECS[protocol]
    if port is None:
        with pytest.raises(UsageError, match="expected a port"):
            address.require_consistent()
    else:
        assert address.where.port == port


def test_another_protocol_has_its_own_format() -> None:
    address = PlcAddress("sim:", format="7O1")
    assert address.changed(station=2).format == "7O1"
    assert address.changed(protocol="facon").format == "7O1"
    assert address.changed(protocol="mseries").format is None
    assert address.changed(protocol="mseries", format="8N1").format == "8N1"


def test_what_is_read_only_stays_so() -> None:
    """Neither ``FATEKTOOL_READ_ONLY=0`` nor an argument undoes what the inventory says."""
    assert PlcAddress("sim:", read_only=True).changed(read_only=False).read_only
    assert PlcAddress("sim:").changed(read_only=True).read_only


@pytest.mark.parametrize(
    ("settings", "words"),
    [
        ({"station": 0}, "station: expected 1 to 254, got 0"),
        ({"station": 255}, "station: expected 1 to 254, got 255"),
        ({"target": "COM3", "protocol": "modbus-tcp"}, "protocol modbus-tcp is for networks"),
        ({"target": "COM3", "protocol": "mseries", "format": "7E1"}, "format: expected 8 data bits"),
        ({"target": "tcp://"}, "target 'tcp://'"),
        ({"target": "tcp://h", "protocol": "mseries"}, "target 'tcp://h': expected a port"),
    ],
)
def test_values_that_do_not_go_together(settings: dict[str, Any], words: str) -> None:
    address = PlcAddress(**{"target": "sim:", **settings})
    with pytest.raises(UsageError) as raised:
        address.require_consistent()
    assert raised.value.message.startswith(words)
    assert raised.value.hint


NUMBERS = st.integers() | st.floats() | st.booleans() | st.text() | st.none()


@given(st.sampled_from(sorted(CHECKS)), NUMBERS)
def test_any_value_is_taken_or_refused(field: str, value: object) -> None:
    settings: dict[str, Any] = {"target": "sim:", field: value}
    try:
        address = PlcAddress(**settings)
    except UsageError as error:
        told = error.message
    else:
        again: dict[str, Any] = {"target": "sim:", field: getattr(address, field)}
        assert address == PlcAddress(**again)
        return
    assert told.startswith(f"{field}: expected ")


def test_connect_takes_an_address_or_its_parts() -> None:
    address = PlcAddress("sim:", station=3)
    with fatektool.connect(address) as plc, fatektool.connect("sim:", station=3) as other:
        assert (plc.station, other.station) == (3, 3)
    with fatektool.connect(address, station=4) as plc:
        assert plc.station == 4
