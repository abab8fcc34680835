"""Units 0 and 255 of Modbus TCP: the PLC at the address itself, to a client that names no other."""

from __future__ import annotations

import re
from typing import TYPE_CHECKING

import pytest

from fatektool.connection import connect
from fatektool.errors import NoAnswer, UsageError
from fatektool.jobs.elements.writes import write_elements
from fatektool.protocol.commands import WriteRegisters
from fatektool.protocol.elements import Element
from fatektool.protocol.modbus.tcp import TCP
from fatektool.simulator.build import build_plcs
from fatektool.simulator.slaves.modbus.slave import ModbusSlave
from fatektool.simulator.slaves.modbus.tcp import TcpFraming
from tests.exchange.modbus.peer import Peer, linked

if TYPE_CHECKING:
    from pathlib import Path

    from tests.cli.running import Cli


@pytest.mark.parametrize(
    ("request_hex", "answer_hex"),
    [
        ("0001 0000 0006 00 03 0005 0001", "0001 0000 0005 00 03 02 0009"),
        ("0002 0000 0006 FF 03 0005 0001", "0002 0000 0005 FF 03 02 0009"),
        ("0003 0000 0006 00 06 0005 0007", "0003 0000 0006 00 06 0005 0007"),
        ("0004 0000 0006 FF 05 0003 FF00", "0004 0000 0006 FF 05 0003 FF00"),
        ("0005 0000 0006 00 03 1388 7FFF", "0005 0000 0003 00 83 03"),
        ("0006 0000 0006 03 03 0005 0001", ""),  # nobody's
    ],
)
def test_the_first_plc_answers_under_the_number_it_was_asked(request_hex: str, answer_hex: str) -> None:
    plcs = build_plcs([7, 9], "fbs-20mc")
    plcs[7].write_words("R", 5, [9])
    slave = ModbusSlave(plcs, TcpFraming())
    asked = slave.cut(bytes.fromhex(request_hex))
    assert b"".join(slave.answer(each) or b"" for each in asked) == bytes.fromhex(answer_hex)
    assert plcs[9].read_words("R", 5, 1) == [0]  # a write to 0 is for one


@pytest.mark.parametrize("unit", [0, 255])
def test_the_client_uses_them(unit: int, cli: Cli, place: Path) -> None:
    line = ("-p", f"sim:{place / 'plc.state'}", "--protocol", "modbus-tcp", "-s", unit)
    assert cli("write", "R5=7", "Y3=on", "R10:3=1,2,3", *line).code == 0
    done = cli("read", "R5", "Y3", "R10:3", *line, "--json")
    document = done.document("read")
    assert document["station"] == unit
    assert document["values"] == {"R5": 7, "Y3": True, "R10": 1, "R11": 2, "R12": 3}
    assert cli("discrete", "reset", "Y3", *line).code == 0
    assert cli("snapshot", "R5", "Y3", "-o", "s.json", *line).code == 0
    assert cli("snapshot", "apply", "s.json", *line, "--yes").code == 0
    assert cli("scan", "--stations", unit, *line[:4]).code == 0


def test_one_of_the_inventory(cli: Cli, place: Path) -> None:
    (place / "fatek.toml").write_text(
        f'[plc.press]\ntarget = "sim:{place / "plc.state"}"\nprotocol = "modbus-tcp"\nstation = 255\n'
    )
    assert cli("read", "R5", "-p", "press").code == 0


@pytest.mark.parametrize("protocol", ["facon", "mseries", "modbus-rtu", "modbus-ascii"])
@pytest.mark.parametrize("unit", [0, 255])
def test_no_other_protocol_has_them(unit: int, protocol: str, cli: Cli) -> None:
    done = cli("read", "R5", "-p", "sim:", "--protocol", protocol, "-s", unit)
    assert done.code == 2
    assert re.search(rf"station: expected 1 to \d+, got {unit}", done.err)
    with pytest.raises(UsageError, match="station: expected 1 to"):
        connect("sim:", protocol=protocol, station=unit)


@pytest.mark.parametrize("values", [(7,), (7, 8)])
def test_nothing_is_written_to_unit_0_unless_one_plc_answers_under_it(values: tuple[int, ...]) -> None:
    """A gateway hands what comes for 0 to every PLC behind it, and answers nothing."""
    peer = Peer(lambda *_: [])
    link = linked(peer, TCP, station=0, timeout_s=0.1)
    with pytest.raises(NoAnswer):
        link.ask(WriteRegisters(Element("R", 5), values))
    assert {heard[7] for heard in peer.heard} == {3}  # reads alone


def test_what_is_written_to_unit_0_is_written() -> None:
    with connect("sim:", protocol="modbus-tcp", station=0) as plc:
        assert write_elements(plc, [(Element("R", 5), 7), (Element("WM", 8), 0xBEEF)]) == []
        assert plc.read_registers(Element("R", 5), 1) == (7,)
