"""The ports' registers: every worked example of the chapter."""

from __future__ import annotations

import pytest
from hypothesis import given
from hypothesis import strategies as st

from fatektool.plcports.kinds import TableKind
from fatektool.plcports.ports import (
    PORT_ELEMENTS,
    decode_port,
    is_continuous,
    minimum_scans,
    port_elements,
    slave_protocol,
    timeout_unit_s,
)
from fatektool.plcports.results import InstructionState, Operation, TransactionResult
from fatektool.plcports.settings import SETTING_ELEMENTS, decode_detection, decode_high_speed, decode_modem

PORTS = (1, 2, 3, 4)


def test_d4043_560a() -> None:
    """0.1 s for ports 1 and 3, 0.01 s for 2 and 4; a low byte of 50 is 5 s on port 1, 0.5 s on port 2."""
    assert [timeout_unit_s(0x560A, port) for port in PORTS] == [0.1, 0.01, 0.1, 0.01]
    assert [timeout_unit_s(0x550A, port) for port in PORTS] == [0.01] * 4
    values = {"D4043": 0x560A, "R4147": 50, "R4159": 50}
    assert decode_port(values, 1).rx_timeout_s == 5
    assert decode_port(values, 2).rx_timeout_s == 0.5


def test_d4044_0006() -> None:
    assert [minimum_scans(0x0006, port) for port in PORTS] == [2, 2, 3, 3]
    assert [is_continuous(0x0006, port) for port in PORTS] == [False] * 4


def test_d4044_5618() -> None:
    assert [is_continuous(0x5618, port) for port in PORTS] == [False, False, True, True]
    assert [minimum_scans(0x5618, port) for port in PORTS] == [3] * 4


@pytest.mark.parametrize(
    ("word", "protocols"),
    [
        (0x5502, "RTU FATEK FATEK FATEK"),
        (0x5504, "FATEK RTU FATEK FATEK"),
        (0x5506, "RTU RTU FATEK FATEK"),
        (0x551E, "RTU RTU RTU RTU"),
        (0x5501, "FATEK FATEK FATEK FATEK"),
        (0x0006, "FATEK FATEK FATEK FATEK"),
        (0x5602, "RTU FATEK FATEK FATEK"),
        (0x56E4, "FATEK FATEK RTU ASCII"),
        (0x5603, "ASCII FATEK FATEK FATEK"),
        (0x56B1, "FATEK FATEK ASCII RTU"),
    ],
)
def test_r4047(word: int, protocols: str) -> None:
    assert " ".join(slave_protocol(word, port) for port in PORTS).replace("Modbus ", "") == protocols


def test_where_the_signals_are() -> None:
    table = [
        (each.free, each.finished, each.parameters, each.times, each.result)
        for each in PORT_ELEMENTS.values()
    ]
    assert table == [
        ("M1960", "M1961", "R4146", "R4147", 4045), ("M1962", "M1963", "R4158", "R4159", 4047),
        ("M1936", "M1937", "R4043", "R4045", 4049), ("M1938", "M1939", "R4044", "R4048", 4051),
    ]  # fmt: skip
    assert len(port_elements()) == len(set(port_elements())) == 29
    assert not set(port_elements()) & set(SETTING_ELEMENTS)


def test_a_whole_port() -> None:
    values = {
        "M1936": 1, "M1937": 0, "R4043": 0x5622, "R4045": 0x0332, "R4047": 0x5508, "D4043": 0x5600,
        "D4044": 0x5608, "D4049": 0x0A02, "D4050": 0x0546,
    }  # fmt: skip
    port = decode_port(values, 3)
    assert (port.free, port.finished, port.protocol) == (True, False, "Modbus RTU")
    assert port.parameters == 0x5622
    assert (port.tx_delay_s, port.rx_timeout_s, port.rx_timeout_unit_s) == (0.03, 0.5, 0.01)
    assert (port.minimum_scans, port.continuous) == (3, True)
    assert port.last_result == TransactionResult(0xA, 2, 5, 0x46)


def test_a_port_that_is_not_there() -> None:
    port = decode_port({}, 4)
    assert {getattr(port, name) for name in type(port).__slots__} == {4, None}
    assert decode_port({"R4048": 50}, 4).rx_timeout_s == 0.5  # without D4043 there is one unit


def test_messages() -> None:
    detection = decode_detection({"M1956": 1, "R4148": 0x0C00})
    assert (detection.by_time, detection.interval_ms) == (True, 12)


def test_the_high_speed_link() -> None:
    values = {"R4054": 0x5507, "R4055": 0x0003, "R4058": 9, "R4059": 0x0A11, "R4160": 0x5620, "R4161": 0x5665}
    link = decode_high_speed({"M1958": 1, "M1967": 0} | values)
    assert (link.slave, link.one_cycle) == (True, False)
    assert (link.master_station, link.station, link.station_set) == (7, 3, False)
    assert (link.abnormal_station, link.abnormal_code, link.abnormal_count) == (9, 0x0A, 0x11)
    assert link.abnormal == "no answer from the slave"
    assert (link.timeout, link.parameters) == (0x20, 0x5665)
    other = decode_high_speed({"R4054": 7, "R4055": 0x5504, "R4160": 0x5520})
    assert (other.master_station, other.station, other.station_set, other.timeout) == (1, 4, True, None)


@pytest.mark.parametrize(
    ("code", "words"),
    [
        (0x00, None), (0x01, "framing error"), (0x02, "overrun error"), (0x04, "parity error"),
        (0x08, "CRC error"), (0x0A, "no answer from the slave"),
        (0x0B, "damaged data"), (0x20, "a code that the paper does not list"),
        (0x05, "framing error and parity error (our reading: the paper lists single codes)"),
    ],
)  # fmt: skip
def test_abnormal_codes(code: int, words: str | None) -> None:
    assert decode_high_speed({"R4059": code << 8}).abnormal == words


def test_the_modem() -> None:
    numbers = dict(
        zip([f"R{at}" for at in range(4140, 4146)], [0x8220, 0x1280, 0x0E29, 1, 2, 3], strict=True)
    )
    values = numbers | {"R4149": 0x5500, "R4163": 0x0312, "M1959": 1, "M1964": 1, "M1965": 0, "M1966": 1}
    modem = decode_modem(values)
    assert (modem.on, modem.phone_number, modem.pulse_dialling) == (True, "0228082192", True)
    assert (modem.dial, modem.connected, modem.failed) == (True, False, True)
    assert (modem.dial_control, modem.profile, modem.rings) == (2, 1, 3)
    assert decode_modem(values | {"R4140": 0xFFFF}).phone_number is None
    del values["R4145"]
    assert decode_modem(values).phone_number is None


def test_wr() -> None:
    state = InstructionState.parse([0x0B03, 0x0210, 0, 0, 0x6011, 0, 0, 0])
    assert state.result == TransactionResult(0xB, 3, 2, 0x10)
    assert state.result.command_meaning() == "preset several registers"
    assert state.operation == Operation(waiting=True, repeated=True, active=False, error=True, done=True)


@pytest.mark.parametrize(
    ("command", "kind", "words"),
    [
        (0x10, TableKind.MBUS, "preset several registers"),
        (0x10, TableKind.MD0, None),
        (0x46, TableKind.MD0, "read registers"),
        (0x46, TableKind.MBUS, None),
        (0x46, None, "read registers"),
        (0x46, TableKind.MD1, None),
        (0x00, None, None),
    ],
)
def test_a_command_is_told_in_the_words_of_its_kind(
    command: int, kind: TableKind | None, words: str | None
) -> None:
    assert TransactionResult(0, 0, 2, command).command_meaning(kind) == words


def test_zeros_are_no_transaction() -> None:
    """One to all stations has station 0, and a command all the same."""
    assert TransactionResult.parse(0, 0).none_yet
    assert not TransactionResult.parse(0, 0x0045).none_yet
    assert not TransactionResult.parse(1, 0).none_yet


@pytest.mark.parametrize(
    ("kind", "repeated", "outputs"),
    [
        (TableKind.MD0, True, True),
        (TableKind.MBUS, True, True),
        (TableKind.MD1, None, True),
        (TableKind.MD2, None, True),
        (TableKind.MD3, None, None),
    ],
)
def test_wr_has_only_the_outputs_of_its_mode(
    kind: TableKind, repeated: bool | None, outputs: bool | None
) -> None:
    operation = InstructionState.parse([0, 0, 0, 0, 0xFFFF, 0, 0, 0], kind).operation
    assert operation == Operation(outputs, repeated, outputs, outputs, outputs)


def test_the_code_of_md3_in_either_byte() -> None:
    """The paper does not say which byte of WR+0 holds it."""
    for wr0, code in ((0, 0), (0x0400, 4), (0x0004, 4), (0x0205, 2)):
        assert InstructionState.parse([wr0, *[0] * 7], TableKind.MD3).result.code == code


def test_the_last_result_is_none_unless_execution_is_continuous() -> None:
    """D4045 to D4052 hold a result then alone; else whatever was left there."""
    words = {"D4045": 0x0A01, "D4046": 0x0246}
    for d4044, kept in ((0x5602, True), (0x5604, False), (0x0002, False), (0x0000, False)):
        assert (decode_port(words | {"D4044": d4044}, 1).last_result is not None) is kept
    assert decode_port(words, 1).last_result is None


@given(st.integers(0, 0xFFFF), st.integers(0, 0xFFFF))
def test_wr_both_ways(wr0: int, wr1: int) -> None:
    assert TransactionResult.parse(wr0, wr1).to_words() == (wr0, wr1)


@given(st.dictionaries(st.sampled_from([*port_elements(), *SETTING_ELEMENTS]), st.integers(0, 0xFFFF)))
def test_any_registers_can_be_told_of(values: dict[str, int]) -> None:
    values = {name: raw & 1 if name.startswith("M") else raw for name, raw in values.items()}
    for port in PORTS:
        assert decode_port(values, port).number == port
    assert isinstance(decode_high_speed(values).abnormal, str | None)
    assert isinstance(decode_modem(values).phone_number, str | None)
