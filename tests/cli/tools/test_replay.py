"""``simulate --replay``: what was recorded gives the same to the same command again."""

from __future__ import annotations

import json
from contextlib import contextmanager
from pathlib import Path
from typing import TYPE_CHECKING, Any

import pytest

from fatektool.simulator.listen.servers import Server
from fatektool.simulator.replay import Recorded, Replay
from fatektool.transport.trace_reader import read_trace
from tests.cli.running import Cli, one_line, served
from tests.cli.tools.test_simulate import listening, simulator
from tests.hurry import hurried

if TYPE_CHECKING:
    from collections.abc import Iterator

WAITS = ("--timeout", 60)
"""Where every answer comes: a time-out would be one request more than was recorded."""


@contextmanager
def replayed(trace: Path, **options: Any) -> Iterator[tuple[str, Replay]]:
    """The recorded PLC, served over TCP by a thread of this process."""
    records = [
        Recorded(record.time_s, record.direction == "tx", record.data)
        for record in read_trace(trace.read_bytes(), trace.name)
    ]
    replay = Replay(records, **options)
    server = Server(replay)
    door = server.open_tcp()
    with hurried(server):
        yield door.address, replay


def sha256(file: str) -> str:
    return str(json.loads(Path(file).read_text(encoding="utf-8"))["sha256"])


@pytest.mark.parametrize(
    ("name", "faults"),
    [
        ("line.pcap", ""),
        ("line.ndjson", ""),
        ("line.pcap", "drop=0.1"),
        ("line.ndjson", "flip=0.1 noise=0.1 truncate=0.05"),
        ("line.pcap", "late=0.05"),
        ("line.ndjson", "duplicate=0.2"),
        ("line.pcap", "echo=1"),
    ],
)
def test_a_backup(cli: Cli, name: str, faults: str) -> None:
    """With every fault of the recording, as often as it is asked for."""
    trace = Path(name)
    patience = ("--timeout", 0.3, "--retries", 20) if faults else WAITS
    with served(faults=faults.split(), seed=11) as door:
        assert cli("backup", "first.json", "-p", door.target, *patience, "--trace", trace).code == 0
    with replayed(trace) as (target, replay):
        assert cli("backup", "second.json", "-p", target, *patience).code == 0
        if not faults:
            assert cli("backup", "third.json", "-p", target, *patience).code == 0
            assert sha256("third.json") == sha256("first.json")
            assert replay.unknown_count == 0
    assert sha256("second.json") == sha256("first.json")


@pytest.mark.parametrize(
    "words",
    [["status"], ["status", "--brief"], ["read", "R0-R9", "X0-X7", "DR2"], ["discrete", "list", "Y0-Y7"]],
)
def test_what_a_command_says(cli: Cli, words: list[str]) -> None:
    trace = Path("line.ndjson")
    with served() as door:
        door.simulation.plcs[1].write_words("R", 3, [4261])
        first = cli(*words, "-p", door.target, "--trace", trace, "--json", *WAITS)
    with replayed(trace, speed=0) as (target, replay):
        second = cli(*words, "-p", target, "--json", *WAITS)
        assert replay.unknown_count == 0
    documents = [json.loads(done.out) for done in (first, second)]
    for document in documents:
        for changing in ("time", "target"):
            document.pop(changing, None)
    assert documents[0] == documents[1]
    assert first.code == second.code == 0


def test_mseries(cli: Cli) -> None:
    trace, spoken = Path("line.pcap"), ["--protocol", "mseries"]
    with served(protocol="mseries") as door:
        door.simulation.plcs[1].write_words("R", 3, [4261])
        first = cli("read", "R0-R9", "X3", *spoken, "-p", door.target, "--trace", trace, *WAITS)
    assert "4261" in first.out
    with replayed(trace, protocol="mseries") as (target, replay):
        assert cli("read", "R0-R9", "X3", *spoken, "-p", target, *WAITS).out == first.out
        assert replay.unknown_count == 0


def test_a_dead_plc_stays_dead(cli: Cli) -> None:
    trace = Path("line.pcap")
    with served(faults=["drop=1"]) as door:
        first = cli("status", "-p", door.target, "--timeout", 0.03, "--trace", trace)
    with replayed(trace) as (target, _):
        second = cli("status", "-p", target, "--timeout", 0.03)
    assert first.code == second.code == 3
    assert one_line(first.err).partition("to 'read")[2] == one_line(second.err).partition("to 'read")[2]


def test_every_door_and_what_is_said_at_the_end(place: Path, cli: Cli) -> None:
    trace = place / "line.ndjson"
    with served() as door:
        assert cli("status", "-p", door.target, "--trace", trace, *WAITS).code == 0
    link = place / "plc"
    doors = ["--tcp", ":0", "--udp", ":0", "--pty", link]
    with simulator("--replay", trace, "--replay-speed", 0, *doors, "-v") as running_process:
        for target in listening(running_process, 3):
            assert cli("status", "-p", target, *WAITS).code == 0
            assert cli("read", "R1", "-p", target, "--retries", 0, "--timeout", 0.05).code == 3
        running_process.terminate()
        _, err = running_process.communicate()
    assert running_process.returncode == 0
    assert err.splitlines() == ["not in the trace: station 1 46 01R00001"] * 3 + [
        "3 requests not in the trace, not answered: station 1 46 01R00001 (3 times)"
    ]


def test_json(place: Path, cli: Cli) -> None:
    trace = place / "line.ndjson"
    with served() as door:
        assert cli("status", "-p", door.target, "--trace", trace, *WAITS).code == 0
    with simulator("--replay", trace, "--tcp", ":0", "--json", "-q") as running_process:
        assert running_process.stdout is not None
        text = ""
        while not text.endswith("}\n"):
            text += running_process.stdout.readline()
        (target,) = json.loads(text)["listening"]
        assert cli("status", "-p", target, *WAITS).code == 0
        assert cli("read", "R1", "-p", target, "--retries", 0, "--timeout", 0.05).code == 3
        running_process.terminate()
        _, err = running_process.communicate()
    assert err == ""


ASKS = '{"time": "2026-11-22T03:15:00Z", "direction": "tx", "hex": "0230313430433703"}\n'
REFUSALS = [
    (2, "--replay good.ndjson --station 3", "--station does not go with --replay: "),
    (2, "--replay good.ndjson --program x.json", "--program does not go with --replay: "),
    (2, "--replay good.ndjson --state x.state", "--state does not go with --replay: "),
    (2, "--replay good.ndjson --set running", "--set does not go with --replay: "),
    (2, "--replay good.ndjson --model fbe-28mc", "--model does not go with --replay: "),
    (2, "--replay good.ndjson --ladder-words 400", "--ladder-words does not go with --replay: "),
    (2, "--replay good.ndjson --program-seed 1", "--program-seed does not go with --replay: "),
    (2, "--replay good.ndjson --fault drop=1", "--fault does not go with --replay: "),
    (2, "--replay good.ndjson --seed 0", "--seed does not go with --replay: "),
    (2, "--replay good.ndjson --baud 9600", "--baud does not go with --replay: "),
    (2, "--replay good.ndjson --format 7E1", "--format does not go with --replay: "),
    (2, "--replay good.ndjson --scan-ms 1", "--scan-ms does not go with --replay: "),
    (2, "--replay good.ndjson --no-program-commands", "--no-program-commands does not go with --replay: "),
    (2, "--replay good.ndjson --no-error-character", "--no-error-character does not go with --replay: "),
    (2, "--replay good.ndjson --replay-speed -1", "-1"),
    (2, "--replay good.ndjson --replay-speed nan", "replay speed: expected 0 or more, got nan"),
    (2, "--replay-speed 2", "--replay-speed needs --replay TRACE"),
    (2, "--replay nowhere.ndjson", "cannot read nowhere.ndjson"),
    (5, "--replay empty.ndjson", "empty.ndjson: no facon request in the recording"),
    (5, "--replay good.ndjson --protocol mseries", "good.ndjson: no mseries request in the recording"),
    (5, "--replay damaged.ndjson", "damaged.ndjson: line 2: not a trace record"),
    (5, "--replay month.ndjson", "month.ndjson: line 2: expected a time such as"),
    (5, "--replay cut.pcap", "cut.pcap: packet 1 is cut off"),
    (5, "--replay ethernet.pcap", "ethernet.pcap: not a trace of this program"),
]


@pytest.mark.parametrize(("code", "words", "message"), REFUSALS)
def test_what_cannot_be_replayed(place: Path, cli: Cli, code: int, words: str, message: str) -> None:
    head = "4D3CB2A1 0200 0400 00000000 00000000 FFFF0000"
    (place / "good.ndjson").write_text(ASKS)
    (place / "empty.ndjson").write_text("")
    (place / "damaged.ndjson").write_text(ASKS + ASKS[:40])
    (place / "month.ndjson").write_text(ASKS + ASKS.replace("2026-11", "2026-13"))
    (place / "cut.pcap").write_bytes(bytes.fromhex(head + "93000000 00000000"))
    (place / "ethernet.pcap").write_bytes(bytes.fromhex(head + "01000000"))
    done = cli("simulate", "--tcp", ":0", *words.split())
    assert done.code == code
    assert message in one_line(done.err)
    assert done.out == ""


def test_every_other_option_is_refused(cli: Cli) -> None:
    """An option that is added to simulate later must be thought of here."""
    from fatektool.cli.tools.replay import OF_A_REPLAY
    from fatektool.cli.tools.simulate import simulate_command

    Path("good.ndjson").write_text(ASKS, encoding="utf-8")
    examples = {
        "model": "fbe-28mc",
        "states": "running",
        "line_format": "7E1",
        "fault": "drop=1",
        "station": "1",
    }
    for parameter in simulate_command.params:
        if parameter.name in OF_A_REPLAY or parameter.name is None:
            continue
        value = [] if getattr(parameter, "is_flag", False) else [examples.get(parameter.name, "100")]
        done = cli("simulate", "--tcp", ":0", "--replay", "good.ndjson", parameter.opts[0], *value)
        assert done.code == 2
        assert f"{parameter.opts[0]} does not go with --replay: the PLC" in one_line(done.err)
