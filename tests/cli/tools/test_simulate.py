"""``simulate``: a process that others talk to."""

from __future__ import annotations

import json
import signal
import socket
from contextlib import contextmanager
from typing import TYPE_CHECKING

import pytest

from fatektool.simulator.build import build_simulation
from tests.cli.running import NEW, Cli, Press, check, one_line, started
from tests.guard import GUARD_S

if TYPE_CHECKING:
    from collections.abc import Iterator
    from pathlib import Path

    from tests.forks.command import Process


@contextmanager
def simulator(*words: object) -> Iterator[Process]:
    running = started("simulate", *words)
    try:
        yield running
    finally:
        running.kill()
        running.communicate()


def listening(running: Process, doors: int = 1) -> list[str]:
    assert running.stdout is not None
    lines = [running.stdout.readline() for _ in range(doors)]
    assert all(line.startswith("listening ") for line in lines)
    return [line.split()[1] for line in lines]


@pytest.mark.parametrize("number", [signal.SIGTERM, signal.SIGINT])
def test_it_serves_every_door_until_it_is_told_to_end(place: Path, cli: Cli, number: signal.Signals) -> None:
    """Both are how it is meant to end: it has no other end."""
    link = place / "plc"
    with simulator("--tcp", "127.0.0.1:0", "--udp", "127.0.0.1:0", "--pty", link) as running:
        doors = listening(running, 3)
        assert [door.partition(":")[0] for door in doors] == ["tcp", "udp", str(link)]
        for door in doors:
            assert cli("status", "-p", door).code == 0
        running.send_signal(number)
        out, err = running.communicate()
    assert (running.returncode, out, err) == (0, "", "")
    assert not link.is_symlink()


def test_it_listens_on_this_computer_alone_unless_told_otherwise() -> None:
    for door in ("0", ":0"):
        with simulator("--tcp", door) as running:
            (address,) = listening(running)
            assert address.startswith("tcp://127.0.0.1:")


def test_json(cli: Cli) -> None:
    with simulator("--tcp", "127.0.0.1:0", "--json") as running:
        assert running.stdout is not None
        text = ""
        while not text.endswith("}\n"):
            text += running.stdout.readline()
        document = json.loads(text)
        check(document, "simulate")
        assert cli("status", "-p", document["listening"][0]).code == 0


def test_state_program_flags_and_stations(press: Press, cli: Cli) -> None:
    words = ["--program", press.new, "--state", "kept", "--station", 3, "--station", 9, "--set", "rom_pack"]
    with simulator("--tcp", "127.0.0.1:0", *words) as running:
        (door,) = listening(running)
        for station in (3, 9):
            assert cli("verify", press.new, "-p", door, "-s", station).code == 0
            assert cli("status", "-p", door, "-s", station, "--json").document("status")["status"]["rom_pack"]
        assert cli("run", "-p", door, "-s", 9, "--yes").code == 0
        assert cli("status", "-p", door, "-s", 4, "--retries", 0, "--timeout", 0.1).code == 3
        running.terminate()
        running.communicate()
    plcs = build_simulation(state="kept").plcs
    assert [plcs[station].running for station in (3, 9)] == [False, True]
    assert tuple(plcs[9].pages) == NEW.pages
    assert plcs[3].rom_pack


START = ["R0=4660", "R1=-2", "Y0=on", "X3=1", "D4:f32=1.5", "DR10=-1", "WM16=0x8001", "R3840=7", "T5=1"]


def test_start_values_are_in_the_memory_inputs_too(cli: Cli, place: Path) -> None:
    names = [text.partition("=")[0] for text in START]
    with simulator("--tcp", "127.0.0.1:0", *[f"--set={text}" for text in START], "--set=running") as running:
        (target,) = listening(running)
        values = cli("read", *names, "-p", target, "--json").document("read")["values"]
        assert list(values.values()) == [4660, -2, True, True, 1.5, -1, 0x8001, 7, True]
        assert cli("status", "--brief", "-p", target, "--json").document("status")["status"]["running"]
        assert cli("snapshot", "--all", "-o", place / "start.json", "-p", target).code == 0
    with simulator("--tcp", "127.0.0.1:0", "--memory", place / "start.json", "--set", "R0=5") as running:
        (target,) = listening(running)
        assert cli("snapshot", "--all", "-o", place / "again.json", "-p", target).code == 0
    done = cli("snapshot", "diff", place / "start.json", place / "again.json")
    assert done.out == "R0  4660 -> 5\n"


def test_faults_strike(cli: Cli) -> None:
    with simulator("--tcp", "127.0.0.1:0", "--fault", "drop=1") as running:
        (door,) = listening(running)
        done = cli("status", "-p", door, "--retries", 1, "--timeout", 0.1)
        assert done.code == 3
        assert (
            "s in total: nothing received; check that the PLC is on, and --station; 'fatektool doctor' looks"
            in one_line(done.err)
        )


def test_another_protocol_through_a_usb_adapter() -> None:
    """The first worked example of the M-series paper, in STOP, at a tick of the adapter."""
    with simulator("--tcp", ":0", "--protocol", "mseries", "--latency-timer", 5) as running:
        (door,) = listening(running)
        host, _, port = door.removeprefix("tcp://").rpartition(":")
        with socket.create_connection((host, int(port)), timeout=GUARD_S) as client:
            client.sendall(bytes.fromhex("511000020140A18455AA"))
            answer = b""
            while len(answer) < 14 and (more := client.recv(14)):
                answer += more
    assert answer.hex().upper() == "521000060140000000002615" + "55AA"


def test_a_port_in_use(cli: Cli) -> None:
    with socket.socket() as taken:
        taken.bind(("127.0.0.1", 0))
        taken.listen()
        place = f"127.0.0.1:{taken.getsockname()[1]}"
        done = cli("simulate", "--tcp", place)
    assert done.code == 3
    assert place in one_line(done.err)


@pytest.mark.parametrize(
    ("code", "words", "message"),
    [
        (2, "", "no address to listen on; give --tcp HOST:PORT, --udp HOST:PORT or --pty LINK"),
        (2, "--tcp here", "address 'here': expected HOST:PORT, such as 127.0.0.1:5000"),
        (2, "--tcp 127.0.0.1:65536", "expected HOST:PORT"),
        (2, "--tcp 127.0.0.1:" + "9" * 5000, "expected HOST:PORT"),
        (2, "--tcp :0 --fault nope=1", "fault 'nope=1': expected KIND=P"),
        (2, "--tcp :0 --fault drop", "fault 'drop': expected KIND=P"),
        (2, "--tcp :0 --fault drop=2", "expected a probability from 0 to 1, got '2'"),
        (2, "--tcp :0 --fault drop=nan", "got 'nan'"),
        (2, "--tcp :0 --fault power-cut=0", "expected the number of a page write, from 1"),
        (2, "--tcp :0 --fault bit-errors=7", "expected a probability from 0 to 1, got '7'"),
        (2, "--tcp :0 --latency-timer nan", "latency timer: expected 0 ms or more, got nan"),
        (2, "--tcp :0 --latency-timer -1", "-1.0 is not in the range 0<=x<=10000"),
        (2, "--tcp :0 --protocol modbus", "'modbus' is not one of 'facon', 'mseries'"),
        (2, "--tcp :0 --fault drop=1 --fault drop=1", "given twice"),
        (2, "--tcp :0 --station 1 --station 1", "given twice"),
        (2, "--tcp :0 --station 0", "0 is not in the range 1<=x<=254"),
        (
            2,
            "--tcp :0 --set nope",
            "'nope': expected ELEMENT=VALUE, such as R0=4660, or one of running, battery_low",
        ),
        (2, "--tcp :0 --set R0=x", "R0"),
        (2, "--tcp :0 --set R99999=1", "expected 0 to 65535, got 99999"),
        (2, "--tcp :0 --set R9000=1", "R9000: the simulated fbe-28mc does not have it"),
        (2, "--tcp :0 --memory no.json", "no.json"),
        (5, "--tcp :0 --memory old.json", "not a snapshot"),
        (2, "--tcp :0 --scan-ms nan", "scan"),
        (2, "--tcp :0 --baud 9600 --format 9", "such as 7E1 or 8N1"),
        (2, "--tcp :0 --program old.json --ladder-words 5", "the program has 400"),
        (2, "--tcp :0 --program no.json", "cannot read no.json"),
        (5, "--tcp :0 --program plc.state", "expected schema"),
        (5, "--tcp :0 --state old.json", "old.json"),
        (5, "--tcp :0 --state no/state", "cannot be written"),
        (5, "--tcp :0 --state plc.state --station 7", "expected the stations 7, got 1"),
    ],
)
@pytest.mark.usefixtures("press")
def test_what_cannot_be_simulated(cli: Cli, code: int, words: str, message: str) -> None:
    for option in ([], ["--json"]):
        done = cli("simulate", *words.split(), *option)
        assert done.code == code
        assert message in one_line(done.err)
        if option:
            done.document("error")
        else:
            assert done.out == ""
