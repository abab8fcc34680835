"""What stands around a PDU, explained in each framing; every byte belongs to a field."""

from __future__ import annotations

import pytest

from fatektool.protocol.explain import FrameRole
from fatektool.protocol.registry import new_explainer

READ = {
    "modbus-rtu": (
        bytes.fromhex("11 03 000C 0003 C758"),
        ["station: 17"],
        ["CRC: right"],
    ),
    "modbus-ascii": (
        b":1103000C0003DD\r\n",
        ["start: begins a frame", "station: 17"],
        ["LRC: right", "end: CR LF"],
    ),
    "modbus-tcp": (
        bytes.fromhex("0102 0000 0006 11 03 000C 0003"),
        ["number: 258; the answer repeats it", "protocol: Modbus", "length: 6 bytes follow", "station: 17"],
        [],
    ),
}


@pytest.mark.parametrize("protocol", READ)
def test_a_request(protocol: str) -> None:
    raw, before, behind = READ[protocol]
    (shown,) = new_explainer(protocol).explain(raw, FrameRole.REQUEST)
    assert b"".join(field.raw for field in shown.fields) == raw
    assert [f"{field.name}: {field.meaning}" for field in shown.fields] == [
        *before,
        "function: read holding registers",
        "address: R12, 400013",
        "count: 3: R12 to R14",
        *behind,
    ]
    assert shown.checksum_ok is (True if behind else None)


@pytest.mark.parametrize(
    ("unit", "words"),
    [(0, "0, the PLC at this address"), (255, "255, the PLC at this address"), (254, "254"), (9, "9")],
)
def test_units_over_tcp(unit: int, words: str) -> None:
    raw = bytes.fromhex(f"0001 0000 0006 {unit:02X} 03 000C 0003")
    (shown,) = new_explainer("modbus-tcp").explain(raw, FrameRole.REQUEST)
    assert shown.fields[3].meaning == words


def test_everyone_on_a_serial_line() -> None:
    (shown,) = new_explainer("modbus-ascii").explain(b":0006000C0001ED\r\n", FrameRole.REQUEST)
    assert shown.fields[1].meaning == "broadcast to all PLCs, none answers"


def test_an_exception_of_a_gateway() -> None:
    """It is a gateway's word, and known: not a code that is in no list."""
    raw = bytes.fromhex("0001 0000 0003 01 83 0A")
    (shown,) = new_explainer("modbus-tcp").explain(raw, FrameRole.ANSWER)
    assert shown.fields[-1].meaning == "REFUSED: the gateway reports: no path to the PLC"
