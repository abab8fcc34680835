"""``loopback``, ``scan`` and ``doctor`` as processes: on ports, sockets, terminals; interrupted, cut off."""

from __future__ import annotations

import json
import os
import signal
from contextlib import contextmanager
from pathlib import Path
from typing import TYPE_CHECKING, Any

import pytest

from fatektool.simulator.build import Simulation, build_simulation
from fatektool.simulator.listen.servers import Server
from tests.cli.running import Cli, check, process, served, started
from tests.cli.terminal import Terminal
from tests.hurry import hurried

if TYPE_CHECKING:
    from collections.abc import Iterator

needs_pty = pytest.mark.skipif(not hasattr(os, "openpty"), reason="no pseudo terminals here")


@contextmanager
def port(link: Path, **options: Any) -> Iterator[Simulation]:
    """PLCs behind a pty."""
    simulation = build_simulation(**options)
    server = Server(simulation)
    server.open_pty(link)
    with hurried(server):
        yield simulation


@needs_pty
def test_a_loopback_test_on_a_serial_port(place: Path, cli: Cli) -> None:
    with port(place / "plc", baud=115200, scan_ms=2):
        done = cli(
            "loopback", "-p", place / "plc", "--baud", 115200, "--count", 48, "--timeout", 60, "--json"
        )
    assert done.code == 0, done
    found = done.document("loopback")
    assert (found["sent"], found["ok"], found["verdict"]) == (48, 48, "pass")
    assert found["bytes_sent"] == found["bytes_received"]
    assert 0.4 < found["line_use"] < 1
    assert found["turnaround_ms"]["min"] >= 2
    assert [row["size"] for row in found["by_size"]] == [0, 1, 16, 64, 128, 256]
    assert sum(bar["count"] for bar in found["histogram"]) == 48
    assert found["line"] == "115200 7E1"


@needs_pty
def test_a_scan_of_a_serial_port_prints_each_station_at_once(place: Path) -> None:
    with port(place / "plc", stations=[2, 4], baud=115200):
        command = started("scan", "-p", place / "plc", "--baud", 115200, "--stations", "2-254")
        assert command.stdout is not None
        assert command.stdout.readline().startswith("station   2  115200 7E1  facon  STOP  FBE, 13K steps")
        assert command.stdout.readline().startswith("station   4  ")
        command.send_signal(signal.SIGINT)
        out, err = command.communicate()
    assert command.returncode == 130
    assert out == ""
    assert "2 stations found with " in err
    assert err.endswith("interrupted\n")


def test_a_scan_over_tcp_knows_no_speed(cli: Cli) -> None:
    with served(stations=[1, 3]) as door:
        done = cli("scan", "-p", door.target, "--stations", "1-3", "--timeout", "2", "--json")
    assert done.code == 0
    found = done.document("scan")["found"]
    assert [(each["station"], each["baud"], each["format"]) for each in found] == [
        (1, None, None),
        (3, None, None),
    ]


@needs_pty
def test_a_station_that_answers_with_two_formats_is_one(place: Path, cli: Cli) -> None:
    with port(place / "plc", stations=[2]):
        done = cli("scan", "-p", place / "plc", "--stations", "2", "--formats", "7E1,8N1", "--timeout", "2")
    assert done.code == 0
    assert len(done.out.splitlines()) == 2
    assert "1 station found (2 settings) with " in done.err


def test_nobody_there_is_a_no(cli: Cli) -> None:
    with served() as door:
        done = cli("scan", "-p", door.target, "--stations", "9", "--timeout", "0.01")
    assert (done.code, done.out) == (1, "")
    assert "no stations found with 1 request in" in done.err
    assert "check that the PLC is on" in done.err


@pytest.mark.parametrize("as_json", [False, True], ids=["words", "json"])
def test_ctrl_c_shows_the_figures_so_far(*, as_json: bool) -> None:
    words = ["loopback", "--duration", 3600, *["--json"] * as_json]
    with (
        served(baud=115200) as door,
        Path("out").open("wb") as out,
        Terminal(*words, "-p", door.target, stdout=out.fileno()) as terminal,
    ):
        terminal.read_until(" ok, 0 errors")  # the counters, while it runs
        terminal.type("\x03")
        assert terminal.end() == 130
        assert "of 3600 s" in terminal.text
    text = Path("out").read_text(encoding="utf-8")
    if as_json:
        found = json.loads(text)
        check(found, "loopback")
        assert found["ended"] == "interrupted"
        assert found["sent"] == found["ok"] >= 1
    else:
        assert "figures so far" in text


@needs_pty
@pytest.mark.parametrize("columns", [40, 100])
def test_on_a_terminal_figures_and_a_histogram_fit(columns: int) -> None:
    with served(faults=["drop=0.2"]) as door, Terminal(
        "loopback", "-p", door.target, "--count", 24, "--timeout", 0.05, columns=columns
    ) as terminal:  # fmt: skip
        assert terminal.end() == 1
    text = terminal.text[terminal.text.index("PLC  ") :]
    assert "█" in text
    bars = [line for line in text.splitlines() if "█" in line]
    assert max(map(len, bars)) <= columns
    assert "FAULT: some requests get no answer" in text
    assert "fail: error rate 0." in text


def test_a_line_that_is_cut_in_the_middle_gives_the_figures_so_far() -> None:
    server = Server(build_simulation(baud=115200))
    door = server.open_tcp()
    words = ["loopback", "-p", door.address, "--duration", 3600, "--json"]
    with Path("out").open("wb") as out, Terminal(*words, stdout=out.fileno()) as terminal:
        with hurried(server):
            terminal.read_until(" ok, 0 errors")
        server.close()
        assert terminal.end() == 1
    assert "warning: the line was lost: " in terminal.text
    found = json.loads(Path("out").read_text(encoding="utf-8"))
    check(found, "loopback")
    assert (found["ended"], found["verdict"]) == ("line lost", "fail")
    assert found["ok"] >= 1


@needs_pty
def test_a_port_that_is_pulled_out_gives_the_figures_so_far(place: Path) -> None:
    server = Server(build_simulation(baud=115200))
    server.open_pty(place / "plc")
    with Path("out").open("wb") as out, Terminal(
        "loopback", "-p", place / "plc", "--baud", 115200, "--duration", 3600, stdout=out.fileno()
    ) as terminal:  # fmt: skip
        with hurried(server):
            terminal.read_until(" ok, 0 errors")
        server.close()
        assert terminal.end() == 1
    assert "check that the adapter is plugged in" in terminal.text.replace("\n", " ")
    assert "line lost: figures so far" in Path("out").read_text(encoding="utf-8")


def test_a_report_and_the_document_agree(cli: Cli, place: Path) -> None:
    with served(faults=["drop=0.1"]) as door:
        done = cli(
            "loopback", "-p", door.target, "--count", 30, "--timeout", "0.02", "--json", "--report", "x.html"
        )
    found = done.document("loopback")
    html = (place / "x.html").read_text(encoding="utf-8")
    assert f">{found['sent']}<" in html
    assert f">{found['ok']}<" in html


def test_quiet_means_no_counters_and_words_only_where_asked_for() -> None:
    with served() as door:
        done = process("loopback", "-p", door.target, "--count", 12, "--timeout", 60)
        assert (done.code, done.err) == (0, "")
        assert done.out.endswith("pass\n")
        done = process("doctor", "-p", door.target)
    assert (done.code, done.err) == (0, "")
    assert "no faults found" in done.out


@needs_pty
def test_a_plc_at_another_speed_is_found(place: Path, cli: Cli) -> None:
    simulation = build_simulation(stations=[1, 3], baud=38400)
    server = Server(simulation)
    server.open_pty(place / "plc", 38400)
    with hurried(server):
        words = ["-p", place / "plc", "--timeout", "1", "--json"]
        done = cli("scan", *words, "--stations", "1-3", "--bauds", "9600,38400")
        assert done.code == 0
        found = done.document("scan")["found"]
        assert [(each["station"], each["baud"]) for each in found] == [(1, 38400), (3, 38400)]
        done = cli("doctor", *words, "-s", 3)
        assert done.code == 1
        advice = done.document("doctor")["findings"][-1]["advice"]
        assert advice.startswith("use: fatektool status -p ")
        assert advice.endswith("/plc -s 1 --baud 38400 --line 7E1")
        assert done.document("doctor")["searched"]["stations"] == [1]
        words_of = cli("doctor", *words[:-1], "-s", 3).out.split("\n\n")[1]
        assert words_of.startswith("FOUND: station 1 answers at 38400 7E1\n")
        assert "A and B" not in words_of


@needs_pty
def test_a_speed_that_no_terminal_has(cli: Cli) -> None:
    done = cli("simulate", "--pty", "plc", "--baud", 12345, "--strict-baud")
    assert done.code == 2
    assert "no 12345 bits per second" in done.err
    assert not Path("plc").is_symlink()
    assert cli("simulate", "--pty", "plc", "--strict-baud").code == 2
