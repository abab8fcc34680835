"""From a target to a PLC, and what is left behind when that fails: nothing."""

from __future__ import annotations

import json
import os
import socket
from typing import TYPE_CHECKING

import pytest

from fatektool import connection
from fatektool.connection import connect
from fatektool.errors import DataError, FatektoolError, LineError, NoAnswer, PortBusy, UsageError
from fatektool.protocol.elements import Element
from fatektool.simulator.build import build_simulation
from fatektool.simulator.listen.servers import Server, running
from tests.guard import GUARD_S
from tests.platforms import symbolic_links

if TYPE_CHECKING:
    from collections.abc import Iterator
    from pathlib import Path

R0 = Element.parse("R0")
NAN, INF = float("nan"), float("inf")


@pytest.fixture
def address() -> Iterator[str]:
    server = Server(build_simulation())
    door = server.open_tcp()
    with running(server):
        yield door.address


REFUSALS = [
    ({"protocol": "modbus"}, "protocol: expected one of facon, .*, got 'modbus'"),
    ({"protocol": ""}, "protocol: .*, got ''"),
    ({"baud": 0}, "baud: expected a whole number from 50 to 4000000, got 0"),
    ({"baud": 10**9}, "baud"),
    ({"format": "9X9"}, "format: expected data bits"),
    ({"format": ""}, "format: expected data bits"),
    ({"station": 0}, "station"),
    ({"station": 255}, "station"),
    ({"station": -1}, "station"),
    ({"timeout_s": 0}, "timeout_s: expected seconds above 0"),
    ({"timeout_s": -1}, "timeout_s: expected seconds above 0"),
    ({"timeout_s": NAN}, "timeout_s: expected seconds above 0"),
    ({"timeout_s": INF}, "timeout_s: expected seconds above 0"),
    ({"retries": -1}, "retries: expected a whole number from 0"),
]


@pytest.mark.parametrize(("options", "words"), REFUSALS)
def test_what_cannot_be_asked_is_refused_and_leaves_nothing_open(
    options: dict[str, object], words: str, address: str
) -> None:
    for target in (address, "sim:"):
        with pytest.raises(UsageError, match=words):
            connect(target, **options)  # type: ignore[arg-type]
    with connect(address, lock_wait_s=0, timeout_s=GUARD_S) as plc:
        assert plc.loopback(b"free") == b"free"


@pytest.mark.parametrize("target", ["", "tcp://", "udp://h:0", "sim:\0"])
def test_what_is_no_target(target: str) -> None:
    with pytest.raises(UsageError):
        connect(target)


@pytest.mark.parametrize("name", ["line.txt", "line", "nowhere/line.pcap"])
def test_a_trace_that_cannot_be_written_leaves_nothing_open(name: str, address: str, tmp_path: Path) -> None:
    with pytest.raises(UsageError, match="trace"):
        connect(address, trace=tmp_path / name)
    connect(address, lock_wait_s=0).close()


def test_a_refused_connection_leaves_no_lock(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(connection, "sleep", lambda _: None)  # between the tries
    with socket.socket() as holder:
        holder.bind(("127.0.0.1", 0))
        target = f"tcp://127.0.0.1:{holder.getsockname()[1]}"
        for _ in range(2):
            with pytest.raises(LineError, match="cannot connect"):
                connect(target, lock_wait_s=0)


def test_one_gateway_one_program(address: str) -> None:
    with connect(address):
        for other in (address, address.replace("127.0.0.1", "localhost")):
            with pytest.raises(PortBusy, match="in use by process") as caught:
                connect(other, lock_wait_s=0)
            assert caught.value.details["holder"] == os.getpid()
    connect(address, lock_wait_s=0).close()


def test_closing_twice(address: str) -> None:
    plc = connect(address)
    plc.close()
    plc.close()
    with plc:
        pass


def test_a_plc_that_went_between_two_questions_is_a_line_error() -> None:
    server = Server(build_simulation())
    door = server.open_tcp()
    with running(server):
        plc = connect(door.address, timeout_s=GUARD_S, retries=0)  # without the pauses between tries
        plc.loopback(b"A")
    with plc, pytest.raises(LineError, match="cannot connect") as caught:
        plc.loopback(b"B")
    assert caught.value.hint


# --- the simulated PLC ------------------------------------------------------------------------------


def test_sim_is_fresh_each_time() -> None:
    with connect("sim:", station=7) as plc:
        plc.write_registers(R0, [5])
        assert plc.read_registers(R0, 1) == (5,)
        with connect("sim:", station=7, lock_wait_s=0) as other:  # nobody else's
            assert other.read_registers(R0, 1) == (0,)


def test_sim_file_keeps_its_memory(tmp_path: Path) -> None:
    target = f"sim:{tmp_path / 'plc.json'}"
    with connect(target) as plc:
        plc.write_registers(R0, [4261])
        plc.write_page(3, bytes(range(128)))
        plc.run()
    with connect(target) as plc:
        assert plc.read_registers(R0, 1) == (4261,)
        assert plc.read_page(3) == bytes(range(128))
        assert plc.brief_status().flags.running


def test_a_new_sim_file_has_the_station_that_was_asked_for(tmp_path: Path) -> None:
    target = f"sim:{tmp_path / 'plc.json'}"
    with connect(target, station=9) as plc:
        plc.write_registers(R0, [9])
    with connect(target, station=9) as plc:
        assert plc.read_registers(R0, 1) == (9,)
    with connect(target, station=1) as plc, pytest.raises(NoAnswer):
        plc.brief_status()


@symbolic_links
def test_two_at_once_to_one_sim_file(tmp_path: Path) -> None:
    file = tmp_path / "plc.json"
    link = tmp_path / "link.json"
    with connect(f"sim:{file}"):
        link.symlink_to(file)
        for name in (file, link, tmp_path / "." / "plc.json"):
            with pytest.raises(PortBusy, match=r"plc\.json is in use by process"):
                connect(f"sim:{name}", lock_wait_s=0)
    connect(f"sim:{link}", lock_wait_s=0).close()


@pytest.mark.parametrize("content", ["", "{}", "not json"])
def test_a_foreign_sim_file_is_refused_kept_and_not_locked(content: str, tmp_path: Path) -> None:
    file = tmp_path / "plc.json"
    file.write_text(content)
    for _ in range(2):
        with pytest.raises(DataError):
            connect(f"sim:{file}", lock_wait_s=0)
    assert file.read_text() == content


def test_a_sim_file_that_cannot_be_written(tmp_path: Path) -> None:
    for _ in range(2):
        with pytest.raises(FatektoolError, match="nowhere") as caught:
            connect(f"sim:{tmp_path / 'nowhere' / 'plc.json'}", lock_wait_s=0)
        assert caught.value.exit_code != 70


@symbolic_links
def test_a_sim_file_that_is_a_link_to_itself(tmp_path: Path) -> None:
    (tmp_path / "plc.json").symlink_to(tmp_path / "plc.json")
    with pytest.raises(DataError, match=r"plc\.json"):
        connect(f"sim:{tmp_path / 'plc.json'}", lock_wait_s=0)


# --- the trace --------------------------------------------------------------------------------------


def test_a_trace_holds_what_went_over_the_wire(tmp_path: Path) -> None:
    trace = tmp_path / "line.ndjson"
    with connect("sim:", trace=trace) as plc:
        plc.brief_status()
    records = [json.loads(line) for line in trace.read_text().splitlines()]
    assert [record["direction"] for record in records] == ["tx", "rx"]
    assert records[0]["hex"] == "0230313430433703"


def test_a_trace_of_a_silent_plc_has_the_questions(tmp_path: Path) -> None:
    file = tmp_path / "plc.json"
    connect(f"sim:{file}", station=2).close()
    trace = tmp_path / "line.pcap"
    with connect(f"sim:{file}", station=1, trace=trace, retries=0) as plc, pytest.raises(NoAnswer):
        plc.brief_status()
    assert trace.read_bytes().endswith(b"\x020140C7\x03")
