"""Each typed method once, against the simulator over every kind of line."""

from __future__ import annotations

from contextlib import contextmanager
from typing import TYPE_CHECKING

import pytest

from fatektool.client import Plc
from fatektool.connection import connect
from fatektool.errors import PlcError, PlcRefused
from fatektool.exchange.link import Link
from fatektool.protocol.elements import Element
from fatektool.simulator.build import build_simulation
from fatektool.simulator.listen import pty as pty_door
from fatektool.simulator.listen.servers import Server, running
from fatektool.transport.base import LineSettings
from tests.exchange.peer import RUNNING, STATUS, STOP, STOPPED, Pieces, Rules, frame, linked, soon
from tests.guard import GUARD_S

if TYPE_CHECKING:
    from collections.abc import Callable, Iterator
    from pathlib import Path

    from fatektool.simulator.listen.base import Listener

MEDIA = [
    "memory",
    "tcp",
    "udp",
    pytest.param("pty", marks=pytest.mark.skipif(not pty_door.PTY_SUPPORTED, reason="no pseudo terminals")),
    "socket-url",
]


@contextmanager
def served(medium: str, folder: Path, **options: object) -> Iterator[str]:
    """A simulator; gives its target."""
    if medium == "memory":
        yield "sim:"
        return
    server = Server(build_simulation(**options))  # type: ignore[arg-type]
    doors: dict[str, Callable[[], Listener]] = {
        "tcp": server.open_tcp,
        "udp": server.open_udp,
        "pty": lambda: server.open_pty(folder / "plc"),
        "socket-url": server.open_tcp,
    }
    address = doors[medium]().address
    with running(server):
        yield address.replace("tcp:", "socket:") if medium == "socket-url" else address


@pytest.fixture(params=MEDIA)
def plc(request: pytest.FixtureRequest, tmp_path: Path) -> Iterator[Plc]:
    with served(request.param, tmp_path) as target, connect(target, timeout_s=GUARD_S, lock_wait_s=0) as plc:
        yield plc


def test_every_method(plc: Plc) -> None:
    element = Element.parse
    assert not plc.brief_status().flags.running
    system = plc.detailed_status().system
    assert system.ladder_words == 13184
    assert system.os_version == "3.1"

    plc.run()
    assert plc.brief_status().flags.running
    plc.stop()
    assert not plc.brief_status().flags.running

    plc.disable(element("Y3"))
    assert plc.read_disabled(element("Y2"), 3) == (False, True, False)
    plc.set(element("Y3"))
    assert plc.read_discretes(element("Y0"), 5) == (False, False, False, True, False)
    plc.reset(element("Y3"))
    plc.enable(element("Y3"))
    assert plc.read_disabled(element("Y0"), 256) == (False,) * 256
    plc.write_discretes(element("M0"), [True, False, True])
    assert plc.read_discretes(element("M0"), 3) == (True, False, True)

    plc.write_registers(element("R0"), range(64))
    assert plc.read_registers(element("R0"), 64) == tuple(range(64))
    plc.write_registers(element("DR100"), [0xDEADBEEF, 1])
    assert plc.read_registers(element("R100"), 4) == (0xBEEF, 0xDEAD, 1, 0)
    plc.write_mixed([(element("R12"), 0x1234), (element("M9"), 1), (element("DD0"), 0xCAFEF00D)])
    assert plc.read_mixed([element("DD0"), element("M9"), element("R12")]) == (0xCAFEF00D, 1, 0x1234)
    assert plc.read_mixed([element("DWM0")]) == (0b1000000101,)

    assert plc.loopback(b"ping") == b"ping"
    assert plc.loopback(b"") == b""
    assert plc.read_page(0)[:2] == b"FB"
    page = bytes(range(128))
    plc.write_page(5, page)
    assert plc.read_page(5) == page
    told: list[int] = []
    pages = plc.read_pages([5, 0, 206], told.append)
    assert pages[0] == page
    assert pages[1][:2] == b"FB"
    assert told == [1, 2, 3]

    with pytest.raises(PlcRefused, match="illegal address"):
        plc.read_registers(element("R60000"), 1)
    assert plc.link.counters.trouble == 0
    plc.close()
    plc.close()


def test_the_link_of_another_is_not_closed() -> None:
    peer = Rules()
    link = linked(peer)
    with Plc(link, "rs485"):
        pass
    assert Plc(link, "rs485").brief_status().flags.running


def test_two_plcs_of_one_line() -> None:
    server = Server(build_simulation([1, 2]))
    address = server.open_tcp().address
    with running(server), connect(address, station=1, timeout_s=GUARD_S) as first:
        second = Plc(
            Link(first.link.transport, first.link.codec, 2, LineSettings(), timeout_s=GUARD_S), address
        )
        first.write_registers(Element.parse("R0"), [1])
        second.write_registers(Element.parse("R0"), [2])
        assert first.read_registers(Element.parse("R0"), 1) == (1,)
        assert second.read_registers(Element.parse("R0"), 1) == (2,)


# --- RUN and STOP -----------------------------------------------------------------------------------

RUN = frame("411")


@pytest.mark.parametrize("run", [True, False])
def test_an_acknowledged_mode_that_does_not_come(run: bool) -> None:
    peer = Rules({RUN: frame("410"), STOP: frame("410"), STATUS: STOPPED if run else RUNNING})
    plc = Plc(linked(peer), "rs485")
    word, other = ("RUN", "STOP") if run else ("STOP", "RUN")
    with pytest.raises(PlcError, match=f"acknowledged {word}, but its status is still {other}") as caught:
        plc.run() if run else plc.stop()
    assert caught.value.exit_code == 4
    assert "fatektool status" in str(caught.value.hint)
    assert peer.heard.count(RUN if run else STOP) == 1
    assert plc.link.transport.clock() < 2


@pytest.mark.parametrize("scans", [1, 5, 19])
def test_a_mode_that_comes_a_few_scans_later(scans: int) -> None:
    def status(asked: int) -> Pieces:
        return soon(RUNNING if asked >= scans else STOPPED)

    peer = Rules({RUN: frame("410"), STATUS: status})
    Plc(linked(peer), "rs485").run()
    assert peer.heard.count(RUN) == 1


@pytest.mark.parametrize(
    ("code", "words"), [("5", "checksum"), ("6", "ID differs"), ("7", "syntax error"), ("9", "not supported")]
)
def test_a_refused_run_is_explained(code: str, words: str) -> None:
    peer = Rules({RUN: frame("41" + code)})
    with pytest.raises(PlcRefused, match=words) as caught:
        Plc(linked(peer), "rs485").run()
    assert caught.value.hint
    assert peer.heard.count(RUN) == 1
