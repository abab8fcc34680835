"""Gateways that serve one connection and free it late: by a script, and ser2net itself."""

from __future__ import annotations

import contextlib
import math
import re
import socket
import threading
from contextlib import contextmanager
from pathlib import Path
from typing import TYPE_CHECKING

import pytest

from fatektool import connection
from fatektool.cli.many.fleet import status as fleet_status
from fatektool.jobs.status import read_status
from fatektool.simulator.build import build_simulation
from fatektool.simulator.listen.pty import PTY_SUPPORTED
from fatektool.simulator.listen.servers import Server, running
from fatektool.transport.lock import PortLock
from tests.cli.many.fleet.gateway import plcs_of
from tests.guard import GUARD_S
from tests.parts.gateways import ser2net
from tests.parts.programs import needs
from tests.program.samples import program

if TYPE_CHECKING:
    from collections.abc import Iterator

    from fatektool.client import Plc
    from fatektool.jobs.status import StatusReport
    from tests.cli.running import Cli

WORDS = 128
STATIONS = (1, 2, 3)


class OneAtATime:
    """A gateway before a PLC's server: one connection at a time, freed late.

    Args:
        plc: address of the server.
        late: how many are turned away after a connection ended, before the next one is served.
        says: what others are told before they are closed; None refuses them with a reset.

    Attributes:
        noticed: set when the end of the last connection was noticed.
    """

    def __init__(self, plc: str, late: float, says: bytes | None) -> None:
        host, _, port = plc.partition("://")[2].rpartition(":")
        self._plc = (host, int(port))
        self._late = late
        self._says = says
        self._to_turn_away = 0.0
        self._busy = threading.Lock()
        self.noticed = threading.Event()
        self.served = self.refused = 0
        self._listening = socket.create_server(("127.0.0.1", 0))
        self.target = f"tcp://127.0.0.1:{self._listening.getsockname()[1]}"
        threading.Thread(target=self._accept, daemon=True).start()

    def close(self) -> None:
        self._listening.close()

    def _accept(self) -> None:
        while True:
            try:
                client, _ = self._listening.accept()
            except OSError:
                return
            if self._to_turn_away > 0 or not self._busy.acquire(blocking=False):
                self._to_turn_away -= 1
                self.refused += 1
                if self._says is None:
                    client.setsockopt(socket.SOL_SOCKET, socket.SO_LINGER, b"\1\0\0\0\0\0\0\0")
                else:
                    client.sendall(self._says)
                client.close()
                continue
            self.served += 1
            self.noticed.clear()
            threading.Thread(target=self._serve, args=(client,), daemon=True).start()

    def _serve(self, client: socket.socket) -> None:
        with client, socket.create_connection(self._plc) as plc:
            back = threading.Thread(target=_pump, args=(plc, client), daemon=True)
            back.start()
            _pump(client, plc)
            self._to_turn_away = self._late
        self._busy.release()
        self.noticed.set()


def _pump(source: socket.socket, sink: socket.socket) -> None:
    with contextlib.suppress(OSError):
        while data := source.recv(4096):
            sink.sendall(data)


@pytest.fixture(autouse=True)
def no_pauses(monkeypatch: pytest.MonkeyPatch) -> None:
    """Before a connection that failed is tried again."""
    monkeypatch.setattr(connection, "sleep", lambda _: None)


@contextmanager
def busy_gateway(late: float, says: bytes | None) -> Iterator[OneAtATime]:
    simulation = build_simulation(STATIONS, ladder_words=WORDS, program=program(WORDS).pages)
    server = Server(simulation)
    door = server.open_tcp()
    with running(server):
        gateway = OneAtATime(door.address, late, says)
        yield gateway
        gateway.close()


def inventory(*targets: str) -> None:
    text = "[defaults]\nformat = '8N1'\n"
    for station, target in enumerate(targets, 1):
        text += f'[plc.plc-{station}]\ntarget = "{target}"\nstation = {station}\n'
    Path("fatek.toml").write_text(text, encoding="utf-8")


WAYS = [pytest.param(None, id="reset"), pytest.param(b"Port already in use\r\n", id="says so")]


@pytest.mark.parametrize("says", WAYS)
@pytest.mark.parametrize("job", [("status",), ("backup", "--dir", "."), ("check", "--no-reference")])
def test_plcs_behind_one_gateway_share_its_connection(
    cli: Cli, place: Path, says: bytes | None, job: tuple[str, ...]
) -> None:
    with busy_gateway(math.inf, says) as gateway:  # a second connection would never be served
        inventory(*[gateway.target] * 3)
        done = cli("fleet", *job, "--json")
    found = plcs_of(done.document("fleet"))
    up = 2 if job[0] == "check" else 0  # they are in STOP
    assert [plc["exit_code"] for plc in found.values()] == [up] * 3, done.err
    assert (gateway.served, gateway.refused) == (1, 0)
    assert job[0] != "backup" or len([*place.glob("plc-*.json")]) == 3


@pytest.mark.parametrize("says", WAYS)
def test_commands_one_behind_the_other_wait_for_the_gateway(cli: Cli, says: bytes | None) -> None:
    with busy_gateway(2, says) as gateway:
        for station in STATIONS:
            done = cli("status", "-p", gateway.target, "-s", station, "--timeout", "2")
            assert done.code == 0, done.err
            assert gateway.noticed.wait(GUARD_S)
    assert gateway.served == 3
    assert gateway.refused >= 4


@pytest.mark.parametrize("says", WAYS)
def test_a_gateway_that_stays_busy_is_named(cli: Cli, says: bytes | None) -> None:
    with busy_gateway(math.inf, says) as gateway:
        assert cli("status", "-p", gateway.target).code == 0
        done = cli("status", "-p", gateway.target, "--timeout", "0.01", "--retries", "2")
    assert done.code == 3
    assert "Traceback" not in done.err
    assert "ther programs may use" in done.err
    assert says is None or re.search("after it sent 'Port already in use'|reset", done.err), done.err


def test_a_plc_that_is_silent_does_not_keep_the_line_from_the_next(cli: Cli) -> None:
    with busy_gateway(1, None) as gateway:
        inventory(*[gateway.target] * 3)
        text = (
            Path("fatek.toml")
            .read_text(encoding="utf-8")
            .replace("station = 2", "station = 77\ntimeout_s = 0.01")
        )
        Path("fatek.toml").write_text(text, encoding="utf-8")
        done = cli("fleet", "status", "--json")
    assert [plc["exit_code"] for plc in plcs_of(done.document("fleet")).values()] == [0, 3, 0], done.err


def test_who_waits_for_the_line_gets_it_between_two_plcs(cli: Cli, monkeypatch: pytest.MonkeyPatch) -> None:
    order: list[str] = []
    with busy_gateway(1, None) as gateway:
        waiting = PortLock(gateway.target.partition("://")[2], 60)

        def wait() -> None:
            waiting.acquire()
            order.append("other")
            waiting.release()

        other = threading.Thread(target=wait)

        def status(plc: Plc, *, brief: bool) -> StatusReport:
            if not order:
                other.start()
                while not waiting.wanted():
                    threading.Event().wait(0.01)
            order.append("plc")
            return read_status(plc, brief=brief)

        monkeypatch.setattr(fleet_status, "read_status", status)
        inventory(*[gateway.target] * 3)
        assert cli("fleet", "status", "--brief").code == 0
        other.join()
    assert order == ["plc", "other", "plc", "plc"]
    assert gateway.served == 2


# --- ser2net ------------------------------------------------------------------------------------------


@needs("ser2net")
@pytest.mark.skipif(not PTY_SUPPORTED, reason="no pseudo terminals here")
@pytest.mark.parametrize("scheme", ["tcp", "socket", "rfc2217"])
def test_a_fleet_behind_ser2net(cli: Cli, place: Path, scheme: str) -> None:
    simulation = build_simulation(STATIONS, ladder_words=WORDS, program=program(WORDS).pages)
    server = Server(simulation)
    device = Path(server.open_pty(place / "plc").address)
    one = "  options:\n    max-connections: 1\n"
    with running(server), ser2net(device, scheme, place, one) as gateway:
        inventory(*[gateway.target] * 3)
        for _ in range(2):  # the second run finds the gateway as the first left it
            done = cli("fleet", "backup", "--dir", ".", "--json")
            assert [plc["exit_code"] for plc in plcs_of(done.document("fleet")).values()] == [0] * 3, done.err


@needs("ser2net")
@pytest.mark.skipif(not PTY_SUPPORTED, reason="no pseudo terminals here")
def test_ser2net_that_another_holds_is_waited_for(
    cli: Cli, place: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    server = Server(build_simulation([1], ladder_words=WORDS))
    device = Path(server.open_pty(place / "plc").address)
    with running(server), ser2net(device, "tcp", place) as gateway:
        host, _, port = gateway.target.partition("://")[2].rpartition(":")
        with socket.create_connection((host, int(port))) as holder:
            holder.sendall(b"\x020140C7\x03")
            assert holder.recv(1)  # it has the port
            done = cli("status", "-p", gateway.target, "--timeout", "0.01", "--retries", "2")
            assert done.code == 3
            assert re.search("after it sent 'Port already in use'|reset", done.err), done.err
            assert "ther programs may use" in done.err
            pauses: list[float] = []

            def pause(seconds: float) -> None:
                if not pauses:
                    holder.shutdown(socket.SHUT_RDWR)
                pauses.append(seconds)
                threading.Event().wait(0.02)  # ser2net takes a while to notice

            monkeypatch.setattr(connection, "sleep", pause)
            done = cli("status", "-p", gateway.target, "--timeout", "2", "--retries", "1000")
            assert pauses
            assert done.code == 0, done.err
