"""A scripted modem on a pseudo terminal, and commands as processes that call through it."""

from __future__ import annotations

import json
import os
import signal
import threading
from contextlib import contextmanager
from typing import TYPE_CHECKING

import pytest

from fatektool.connection import connect
from fatektool.errors import PortBusy
from fatektool.program.archive import load_backup
from fatektool.simulator.build import Simulation, build_simulation
from fatektool.simulator.listen.servers import Server
from fatektool.transport.base import LineSettings
from fatektool.transport.serial_line.port import open_serial
from tests.cli.running import OLD, check, one_line, started
from tests.guard import GUARD_S
from tests.held import HeldAnswer
from tests.hurry import hurried
from tests.transport.modem.scripted import SILENCE, ScriptedModem

if TYPE_CHECKING:
    from collections.abc import Iterator
    from pathlib import Path

    from tests.cli.running import Cli

pytestmark = pytest.mark.skipif(not hasattr(os, "openpty"), reason="no pseudo terminals here")

QUICK = "&guard=0.05&pause=0"


@contextmanager
def plugged_in(place: Path, modem: ScriptedModem) -> Iterator[str]:
    """The modem on a pty; gives a target that calls through it."""
    server = Server(modem)
    server.open_pty(place / "ttyUSB0")
    with hurried(server):
        yield f"modem:{place / 'ttyUSB0'}?number=0228082192{QUICK}"


def a_plc() -> Simulation:
    return build_simulation(ladder_words=OLD.ladder_words, program=OLD.pages)


@pytest.mark.parametrize("echo", [False, True], ids=["plain", "echo"])
@pytest.mark.parametrize("figures", [False, True], ids=["words", "figures"])
def test_status_over_a_modem(place: Path, cli: Cli, *, echo: bool, figures: bool) -> None:
    modem = ScriptedModem(["BUSY", "CONNECT 9600"], a_plc().line(), echo=echo, figures=figures, stubborn=True)
    with plugged_in(place, modem) as target:
        done = cli("status", "--json", "-p", target, "--baud", 115200, "--format", "8N1")
    assert done.code == 0, done
    assert done.document("status")["target"] == target
    assert (modem.online, modem.hung_up, modem.guard_broken) == (False, 1, False)
    assert [command for command in modem.commands if "ATD" in command] == ["ATDT0228082192"] * 2


def test_a_backup_over_a_modem_with_its_trace(place: Path, cli: Cli) -> None:
    modem = ScriptedModem(plc=a_plc().line())
    with plugged_in(place, modem) as target:
        done = cli("backup", "x.json", "-p", target, "--baud", 115200, "--trace", "x.ndjson", "-v")
    assert done.code == 0, done
    assert load_backup(place / "x.json").program == OLD
    assert (modem.online, modem.hung_up) == (False, 1)
    assert "to the modem: ATDT0228082192" in done.err
    records = [json.loads(line) for line in (place / "x.ndjson").read_text().splitlines()]
    assert len(records) > 20
    assert all(record["hex"].startswith("02") for record in records)  # PLC frames, no modem commands


@pytest.mark.parametrize("as_json", [False, True], ids=["words", "json"])
@pytest.mark.parametrize("outcome", ["BUSY", "NO CARRIER", "NO ANSWER", "NO DIALTONE", "ERROR"])
def test_no_connection_is_an_error_of_the_line(place: Path, cli: Cli, outcome: str, *, as_json: bool) -> None:
    with plugged_in(place, ScriptedModem([outcome])) as target:
        done = cli("status", "-p", target, *["--json"] * as_json)
    assert done.code == 3
    assert f"to 0228082192 in {1 if outcome[-5:] in {'LTONE', 'ERROR'} else 3} t" in one_line(done.err)
    assert outcome in done.err
    if as_json:
        assert done.document("error")["error"]["details"]["result"] == outcome


def test_silence_on_the_line_ends_after_its_time(place: Path, cli: Cli) -> None:
    modem = ScriptedModem([SILENCE])
    with plugged_in(place, modem) as target:
        done = cli("status", "-p", f"{target}&wait=1&tries=1")
    assert done.code == 3
    assert "in 1 try: the modem reported nothing for 1 s; no result:" in one_line(done.err)
    assert modem.aborted == 1


@pytest.mark.parametrize("as_json", [False, True], ids=["words", "json"])
@pytest.mark.parametrize("number", [signal.SIGINT, signal.SIGTERM])
def test_a_backup_that_is_interrupted_hangs_up(place: Path, number: signal.Signals, *, as_json: bool) -> None:
    simulation = a_plc()
    modem = ScriptedModem(plc=simulation.line())
    answer = HeldAnswer(simulation, "read_page", 3)
    with plugged_in(place, modem) as target:
        command = started("backup", "x.json", "-p", target, *["--json"] * as_json)
        with answer:
            command.send_signal(number)
        out, err = command.communicate()
    assert command.returncode == 130
    assert one_line(err) == "fatektool: interrupted"
    if as_json:
        check(json.loads(out), "error")
    assert (modem.online, modem.hung_up, modem.guard_broken) == (False, 1, False)
    assert not (place / "x.json").exists()


@pytest.mark.parametrize("number", [signal.SIGINT, signal.SIGTERM])
def test_a_call_that_is_interrupted_before_its_outcome_is_given_up(
    place: Path, number: signal.Signals
) -> None:
    dialled = threading.Event()

    class Watched(ScriptedModem):
        def receive(self, data: bytes, now: float) -> list[tuple[float, bytes]]:
            pieces = super().receive(data, now)
            if self.dialling_until is not None:
                dialled.set()
            return pieces

    modem = Watched([SILENCE])
    with plugged_in(place, modem) as target:
        command = started("status", "-p", target)
        assert dialled.wait(GUARD_S)
        command.send_signal(number)
        _, err = command.communicate()
    assert command.returncode == 130
    assert one_line(err) == "fatektool: interrupted"
    assert (modem.aborted, modem.dialling_until) == (1, None)
    assert modem.commands[-1] == "ATH"


def test_a_killed_process_leaves_a_call_that_the_next_one_ends(place: Path, cli: Cli) -> None:
    modem = ScriptedModem(plc=a_plc().line(), guard_s=0.04, online=True)
    with plugged_in(place, modem) as target:
        done = cli("status", "--brief", "-p", target)
    assert done.code == 0, done
    assert (modem.online, modem.hung_up) == (False, 2)


def test_a_carrier_lost_in_the_middle_of_a_backup(place: Path, cli: Cli) -> None:
    modem = ScriptedModem(plc=a_plc().line(), carrier_bytes=900)
    with plugged_in(place, modem) as target:
        done = cli("backup", "x.json", "-p", target)
    assert done.code == 3
    assert "the call ended (NO CARRIER); a bad telephone line" in one_line(done.err)
    assert not (place / "x.json").exists()
    assert modem.commands[-1] == "ATH"


def test_a_port_that_is_pulled_out_during_a_call(place: Path, cli: Cli) -> None:
    server: list[Server] = []

    class Pulled:
        def receive(self, data: bytes, now: float) -> list[tuple[float, bytes]]:
            assert data
            assert now
            server[0].listeners[0].close()
            return []

        datagram = receive

    server.append(Server(ScriptedModem(plc=Pulled())))
    server[0].open_pty(place / "ttyUSB0")
    with hurried(server[0]):
        done = cli("status", "-p", f"modem:{place / 'ttyUSB0'}?number=1{QUICK}")
    assert done.code == 3
    assert "the port is lost" in one_line(done.err)


def test_a_scan_over_a_modem_asks_more_than_one_plc(place: Path, cli: Cli) -> None:
    modem = ScriptedModem(plc=build_simulation(stations=[1, 3]).line())
    with plugged_in(place, modem) as target:
        done = cli("scan", "-p", target, "--stations", "1-3", "--timeout", "2", "--json")
    found = done.document("scan")["found"]
    assert [(each["station"], each["baud"]) for each in found] == [(1, None), (3, None)]
    assert (modem.online, modem.hung_up) == (False, 1)


def test_the_doctor_does_not_look_for_other_speeds_behind_a_modem(place: Path, cli: Cli) -> None:
    modem = ScriptedModem()
    with plugged_in(place, modem) as target:
        done = cli("doctor", "-p", target, "--timeout", "0.05", "--json")
    assert done.code == 1
    found = done.document("doctor")
    assert [finding["rule"] for finding in found["findings"]] == ["silence"]
    assert found["elsewhere"] == []


@pytest.mark.parametrize("number", ["022%3BATH", "022%0DATD999", "ATZ", "02-28", ""])
def test_a_number_that_is_none_opens_no_port(cli: Cli, number: str) -> None:
    done = cli("status", "-p", f"modem:/dev/nope?number={number}")
    assert done.code == 2
    assert "number: expected 1 to 40 of the digits" in one_line(done.err)


def test_the_lock_is_that_of_the_port(place: Path) -> None:
    modem = ScriptedModem(plc=a_plc().line())
    with plugged_in(place, modem) as target, connect(target) as plc:
        assert plc.brief_status().flags.running is False
        port = str((place / "ttyUSB0").resolve())
        for other in (port, f"modem:{port}?number=1"):
            with pytest.raises(PortBusy, match="in use by process"):
                connect(other, lock_wait_s=0)


def test_a_pty_has_no_dtr_and_other_ports_have(place: Path) -> None:
    server = Server(a_plc())
    server.open_pty(place / "tty")
    with hurried(server), open_serial(str(place / "tty"), LineSettings()) as port:
        assert port.set_dtr(on=False) is False
    with open_serial("loop://", LineSettings()) as loop:
        assert loop.set_dtr(on=False) is True
        assert loop.set_dtr(on=True) is True
