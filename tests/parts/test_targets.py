"""Every kind of target with a real other side: backup, restore, and a line cut in the middle of each."""

from __future__ import annotations

import re
import time
from contextlib import contextmanager
from pathlib import Path
from typing import TYPE_CHECKING, Any, NamedTuple

import click
import pytest
import serial.tools.list_ports

from fatektool.cli.app import app
from fatektool.program.archive import load_backup, save_backup
from fatektool.simulator.build import build_simulation
from fatektool.simulator.listen.pty import PTY_SUPPORTED
from fatektool.simulator.listen.servers import Server, running
from tests.cli.running import one_line
from tests.clocked import clocked
from tests.parts.gateways import ser2net, socat_device, socat_tcp, socat_udp
from tests.parts.programs import needs
from tests.program.samples import backup, program
from tests.root import ROOT

if TYPE_CHECKING:
    from collections.abc import Callable, Iterator
    from contextlib import AbstractContextManager

    from fatektool.simulator.plc import SimulatedPlc
    from tests.cli.running import Cli, Done

WORDS = 320
OLD, NEW = program(WORDS, seed=1), program(WORDS, seed=2)
CUT_AT = 3
"""The page at which the line is cut."""
TRIED_TWICE = ("--format", "8N1", "--timeout", "60", "--retries", "1")
ENOUGH = ("--format", "8N1", "--timeout", "60")

needs_pty = pytest.mark.skipif(not PTY_SUPPORTED, reason="no pseudo terminals here")


class CutClock:
    """A clock on which nobody waits for what a line that is cut will never bring."""

    def __init__(self) -> None:
        self.cut = False
        self._skipped_s = 0.0

    def now(self) -> float:
        return time.monotonic() + self._skipped_s

    def skip(self, seconds: float) -> None:
        self._skipped_s += seconds

    def jump(self, deadline: float, *, sure: bool = False) -> None:
        if self.cut or sure:
            self._skipped_s += max(0.0, deadline - self.now())

    def opened(self, *, keeps: bool) -> None:
        """Whoever comes."""

    def closed(self) -> None:
        """Whoever goes."""

    def asked(self, size: int) -> None:
        """Whatever goes out."""

    def read(self, size: int) -> None:
        """Whatever comes."""


@pytest.fixture
def clock() -> Iterator[CutClock]:
    made = CutClock()
    with clocked(made, bool):
        yield made


class Way(NamedTuple):
    """A way to a simulated PLC.

    Args:
        target: for ``--port``.
        cut: cuts it.
        put_back: mends it.
    """

    target: str
    cut: Callable[[], None]
    put_back: Callable[[], None]


@contextmanager
def by_gateway(make: Callable[..., Any], scheme: str, server: Server, folder: Path) -> Iterator[Way]:
    """Through a gateway before the PLC's pseudo terminal."""
    device = Path(server.open_pty(folder / "plc").address)
    with running(server), make(device, scheme, folder) as gateway:
        yield Way(gateway.target, gateway.cut, gateway.put_back)


@contextmanager
def by_udp(server: Server) -> Iterator[Way]:
    """Through socat, which has datagrams on one side and a connection on the other."""
    door = server.open_tcp()
    with running(server), socat_udp(door.address) as gateway:
        yield Way(gateway.target, gateway.cut, gateway.put_back)


@contextmanager
def by_device(prefix: str, server: Server, folder: Path) -> Iterator[Way]:
    """Over a serial port of this computer, which is socat's: when it goes, the port is pulled out."""
    door = server.open_tcp()
    with running(server), socat_device(door.address, folder / "ttyUSB0") as gateway:
        yield Way(prefix + gateway.target, gateway.cut, gateway.put_back)


@contextmanager
def by_search(server: Server, folder: Path, patch: pytest.MonkeyPatch) -> Iterator[Way]:
    """The same port, found by its description: a pseudo terminal is in no list of serial ports."""
    with by_device("", server, folder) as way:
        found = serial.tools.list_ports_common.ListPortInfo(way.target)
        found.description = "FT232R USB UART of the press"
        patch.setattr(serial.tools.list_ports, "comports", lambda *_, **__: [found])
        yield way._replace(target="hwgrep://FT232R.*press")


WAYS = {
    "tcp, ser2net": needs("ser2net"),
    "rfc2217, ser2net": needs("ser2net"),
    "socket, ser2net": needs("ser2net"),
    "tcp, socat": needs("socat"),
    "udp, socat": needs("socat"),
    "socket, socat": needs("socat"),
    "device, socat": needs("socat"),
    "spy, socat": needs("socat"),
    "alt, socat": needs("socat"),
    "hwgrep, socat": needs("socat"),
}


def opened(name: str, server: Server, folder: Path, patch: pytest.MonkeyPatch) -> AbstractContextManager[Way]:
    scheme, _, part = name.partition(", ")
    if scheme == "hwgrep":
        return by_search(server, folder, patch)
    if scheme in {"device", "spy", "alt"}:
        return by_device("" if scheme == "device" else f"{scheme}://", server, folder)
    if scheme == "udp":
        return by_udp(server)
    return by_gateway(ser2net if part == "ser2net" else socat_tcp, scheme, server, folder)


@pytest.fixture(params=[pytest.param(name, marks=[needs_pty, mark]) for name, mark in WAYS.items()])
def plc_and_way(
    request: pytest.FixtureRequest, place: Path, monkeypatch: pytest.MonkeyPatch, clock: CutClock
) -> Iterator[tuple[SimulatedPlc, Way]]:
    simulation = build_simulation(ladder_words=WORDS, program=OLD.pages)
    with opened(request.param, Server(simulation), place, monkeypatch) as way:

        def cut() -> None:
            way.cut()
            clock.cut = True

        def put_back() -> None:
            way.put_back()
            clock.cut = False

        yield simulation.plcs[1], way._replace(cut=cut, put_back=put_back)


@contextmanager
def cut_at(plc: SimulatedPlc, method: str, page: int, cut: Callable[[], None]) -> Iterator[None]:
    """Cut the line when the PLC is asked for this page, or has just taken it."""
    real, left = getattr(plc, method), [cut]

    def once(number: int, *content: bytes) -> Any:
        answer = real(number, *content)
        if number == page and left:
            left.pop()()
        return answer

    setattr(plc, method, once)
    yield
    setattr(plc, method, real)


def pages(plc: SimulatedPlc) -> tuple[bytes, ...]:
    return tuple(plc.pages)


def test_backup_restore_and_a_line_that_is_cut(
    plc_and_way: tuple[SimulatedPlc, Way], place: Path, cli: Cli
) -> None:
    plc, way = plc_and_way
    save_backup(backup(NEW), place / "new.json")

    with cut_at(plc, "read_page", CUT_AT, way.cut):
        done = cli("backup", "old.json", "-p", way.target, *TRIED_TWICE)
    assert_cut(done, way, 3)
    assert not (place / "old.json").exists()

    way.put_back()
    assert cli("backup", "old.json", "-p", way.target, *ENOUGH).code == 0
    assert load_backup(place / "old.json").program == OLD

    restore = ("restore", "new.json", "-p", way.target, "--yes")
    with cut_at(plc, "write_page", CUT_AT, way.cut):
        done = cli(*restore, *TRIED_TWICE)
    assert_cut(done, way, 6)
    assert "new.json" in done.err
    assert pages(plc)[CUT_AT] == NEW.pages[CUT_AT]
    assert pages(plc)[CUT_AT + 1 :] == OLD.pages[CUT_AT + 1 :]

    way.put_back()
    assert cli(*restore, *ENOUGH).code == 0
    assert pages(plc) == NEW.pages
    (safety,) = place.glob("new.safety-*")  # a device may have another name since: it is the same restore
    assert load_backup(safety).program == OLD


def assert_cut(done: Done, way: Way, code: int) -> None:
    """The exit code of its class, and a message that names the target and the next step."""
    assert done.code == code, done.err
    assert "Traceback" not in done.err
    assert way.target in done.err or "hwgrep" in way.target
    assert code == 6 or re.search(r"gateway|cable|adapter|address", done.err), done.err


# --- loop:// ------------------------------------------------------------------------------------------


def test_a_loop_gives_back_what_is_sent(cli: Cli) -> None:
    done = cli("loopback", "--raw", "02,03", "--count", "3", "-p", "loop://", "--json")
    assert done.code == 0, done.err
    assert done.document("loopback")["ok"] == 3


def test_no_plc_is_at_the_end_of_a_loop(cli: Cli, clock: CutClock) -> None:
    clock.cut = True
    done = cli("status", "-p", "loop://", *TRIED_TWICE)
    assert done.code == 3
    assert "its own request only" in one_line(done.err)


# --- what is named ------------------------------------------------------------------------------------

ELSEWHERE = {
    "modem": "tests/transport/modem/test_port.py",
    "sim": "tests/test_main_job.py",
    "loop": "here",
}
OF_OTHERS = {"http", "https", "file", "ssh", "git", "console"}
"""Schemes of addresses that are no targets."""


def named_schemes() -> set[str]:
    """The schemes of targets that README, docs and help name."""
    texts = [path.read_text(encoding="utf-8") for path in [ROOT / "README.md", *(ROOT / "docs").glob("*.md")]]
    texts += helps(app, click.Context(app, info_name="fatektool"))
    found = set(re.findall(r"\b([a-z][a-z0-9]+)://", "\n".join(texts)))
    return found | set(re.findall(r"\b(sim|modem):", "\n".join(texts))) - OF_OTHERS


def helps(command: click.Command, context: click.Context) -> Iterator[str]:
    yield command.get_help(context)
    if isinstance(command, click.Group):
        for name in command.list_commands(context):
            inner = command.get_command(context, name)
            assert inner is not None
            yield from helps(inner, click.Context(inner, info_name=name, parent=context))


def test_each_scheme_that_is_named_is_tried() -> None:
    tried = {name.partition(", ")[0] for name in WAYS} - {"device"} | set(ELSEWHERE)
    assert named_schemes() - OF_OTHERS == tried
