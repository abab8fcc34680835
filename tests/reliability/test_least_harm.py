"""Least harm: a line to be read is not written; nothing is made, sent or opened that nobody asked for."""

from __future__ import annotations

import hashlib
import json
import os
import re
import stat
from contextlib import contextmanager
from pathlib import Path
from typing import TYPE_CHECKING

import click
import pytest

from fatektool.cli.app import app
from fatektool.cli.tools.simulate import _host_and_port
from fatektool.client import Plc
from fatektool.errors import LineReadOnly, NoAnswer
from fatektool.exchange.link import Link
from fatektool.protocol import commands as requests
from fatektool.protocol.commands import Control, Loopback, Request
from fatektool.protocol.elements import Element
from fatektool.protocol.fatek.facon.codec import FACON
from fatektool.simulator.build import build_simulation
from fatektool.simulator.listen.servers import Server
from fatektool.transport.base import LineSettings
from fatektool.transport.memory import MemoryTransport
from fatektool.transport.trace_reader import read_trace
from tests.cli.programs.monitor.plant import IMAGE
from tests.cli.running import Press, one_line
from tests.cli.shared.test_trace import commands
from tests.project.files import backup_file

if TYPE_CHECKING:
    from collections.abc import Iterator

    from tests.cli.running import Cli

READING = """\
backup x.json
backup x.json --raw x.bin
verify old.json
verify old.json --report x.html
restore new.json --dry-run
status
status --brief
read R1 X0-X7 DR2
discrete list Y0-Y7
snapshot take R0-R9 -o x.json
snapshot apply data.json --dry-run
watch R1 --count 2 --interval 0.01
doctor
loopback --count 3 --report x.html
scan --stations 1-2 --timeout 0.01
check --expect any --reference old.json
link ports
link table show R5000 --kind md0
link table save R5000 x.toml --kind md0
link table write table.toml R5000 --dry-run
link result R100
link modem show
link modem set --auto-answer 2 --dry-run
monitor ladder.json --count 2 --interval 0.01
monitor ladder.json --why Y4
"""
WRITING = """\
restore new.json --yes
run --yes
stop --yes
write R1=5 Y0=on
discrete disable X1
discrete enable X1
discrete set Y1
discrete reset Y1
snapshot apply data.json --yes
link table write table.toml R5000 --yes
link modem set --auto-answer 2 --yes
"""
BROADCASTING = """\
run --yes
stop --yes
write R1=5 Y0=on --yes
discrete disable X1 --yes
discrete enable X1 --yes
discrete set Y1 --yes
discrete reset Y1 --yes
"""
TABLE = """\
kind = "md0"

[[transaction]]
station = 2
command = "read"
length = 4
master = "R0"
slave = "R100"
"""
WRITING_CODES = {b"41", b"42", b"45", b"47", b"49", b"50"}


@pytest.fixture
def press(place: Path, cli: Cli) -> Press:
    """A PLC in RUN, with files that would change it, and one with networks."""
    made = Press(place)
    backup_file("ladder.json", IMAGE)
    (place / "table.toml").write_text(TABLE)
    spare = f"sim:{place.parent / 'spare.state'}"
    assert cli("write", "R0-R9=7", "-p", spare).code == 0
    assert cli("snapshot", "R0-R9", "-o", "data.json", "-p", spare).code == 0
    return made


def asked(trace: Path) -> list[bytes]:
    """The command codes of all that was sent; none where nothing was even opened."""
    if not trace.exists():
        return []
    return [
        record.data[3:5] for record in read_trace(trace.read_bytes(), trace.name) if record.direction == "tx"
    ]


def contents(folder: Path) -> dict[str, str]:
    """Every file of a folder with the hash of what is in it."""
    return {
        str(path.relative_to(folder)): hashlib.sha256(path.read_bytes()).hexdigest()
        for path in sorted(folder.rglob("*"))
        if path.is_file()
    }


# --- --read-only ------------------------------------------------------------------------------------------


def of_lines(lines: str) -> set[str]:
    """The commands of some command lines, by their names."""
    found = set()
    for line in lines.splitlines():
        words = [re.match(r"[a-z]*", word)[0] for word in line.split()]  # type: ignore[index]  # it may be empty
        found.add(next(" ".join(words[:n]) for n in (3, 2, 1) if " ".join(words[:n]) in LEAVES or n == 1))
    return found


LEAVES = {words: command for words, command in commands(app) if not isinstance(command, click.Group)}


def test_every_command_that_has_a_port_is_tried_here() -> None:
    """A new command belongs into READING or WRITING above; with a port it has --read-only."""
    talking = {words for words, command in LEAVES.items() if "port" in {each.name for each in command.params}}
    assert talking - {"inventory add"} == of_lines(READING + WRITING)
    for words in talking:
        assert "read_only" in {each.name for each in LEAVES[words].params}, words
    broadcasting = {
        words for words, command in LEAVES.items() if "broadcast" in {each.name for each in command.params}
    }
    assert broadcasting == of_lines(BROADCASTING) < of_lines(WRITING)


@pytest.mark.parametrize("line", WRITING.splitlines())
def test_every_writing_command_writes_unless_it_must_not(press: Press, cli: Cli, line: str) -> None:
    """Refused before a byte is sent; the same line without --read-only does change the PLC."""
    before, files = press.state.read_bytes(), contents(press.folder)
    words = [*line.split(), "-p", press.target, "--trace", "t.ndjson"]
    done = cli(*words, "--read-only")
    assert done.code == 2
    assert done.out == ""
    assert "this line is read-only, and nothing was sent; to write, leave out --read-only" in one_line(
        done.err
    )
    assert asked(Path("t.ndjson")) == []
    assert press.state.read_bytes() == before
    assert contents(press.folder) == files
    cli(*words)
    assert WRITING_CODES & set(asked(Path("t.ndjson"))) or line.startswith("stop")


@pytest.mark.parametrize("line", READING.splitlines())
def test_every_reading_command_reads_all_the_same(press: Press, cli: Cli, line: str) -> None:
    """Nothing is made beside what is asked for, and the PLC holds what it held."""
    before, files = press.state.read_bytes(), contents(press.folder)
    done = cli(*line.split(), "-p", press.target, "--trace", "t.ndjson", "--read-only")
    assert done.code == 0, done.err
    seen = asked(Path("t.ndjson"))
    assert seen
    assert not WRITING_CODES & set(seen)
    assert press.state.read_bytes() == before
    after = contents(press.folder)
    made = {word for word in line.split() if word.startswith("x.")} | {"t.ndjson"}
    assert after.keys() == files.keys() | made
    assert {name: after[name] for name in files} == files


@pytest.mark.parametrize("value", ["1", "true"])
def test_the_environment_says_it_too(
    press: Press, cli: Cli, monkeypatch: pytest.MonkeyPatch, value: str
) -> None:
    monkeypatch.setenv("FATEKTOOL_READ_ONLY", value)
    assert cli("write", "R1=5", "-p", press.target).code == 2
    assert cli("read", "R1", "-p", press.target).code == 0
    for nothing in ("", "0", "false"):
        monkeypatch.setenv("FATEKTOOL_READ_ONLY", nothing)
        assert cli("write", "R1=5", "-p", press.target).code == 0


def test_the_inventory_says_it_too(press: Press, cli: Cli) -> None:
    """No option takes back what stands there."""
    table = "[plc.{}]\ntarget = {}\nread_only = {}\n"
    text = "".join(
        table.format(name, json.dumps(press.target), flag) for name, flag in (("a", "true"), ("b", "false"))
    )
    Path("fatek.toml").write_text(text)
    assert cli("write", "R1=5", "-p", "a").code == 2
    assert cli("read", "R1", "-p", "a").code == 0
    assert cli("write", "R1=5", "-p", "b").code == 0
    assert cli("write", "R1=6", "-p", "b", "--read-only").code == 2


def test_the_error_has_a_kind_of_its_own(press: Press, cli: Cli) -> None:
    done = cli("write", "R1=5", "-p", press.target, "--read-only", "--json")
    assert done.document("error")["error"]["kind"] == "line_read_only"


class Ear:
    """A line that answers nothing, and keeps what it hears."""

    def __init__(self) -> None:
        self.heard: list[bytes] = []

    def receive(self, data: bytes, _now: float) -> list[tuple[float, bytes]]:
        self.heard.append(data)
        return []


R0, Y0 = Element.parse("R0"), Element.parse("Y0")
WRITES: list[Request[None]] = [
    requests.RunStop(run=True),
    requests.ControlDiscrete(Control.SET, Y0),
    requests.WriteDiscretes(Y0, (True,)),
    requests.WriteRegisters(R0, (1,)),
    requests.WriteMixed(((R0, 1),)),
    requests.WritePage(0, bytes(128)),
]


def test_those_are_all_the_requests_that_write() -> None:
    kinds = [each for each in vars(requests).values() if isinstance(each, type) and issubclass(each, Request)]
    assert {kind for kind in kinds if kind.writes} == {type(each) for each in WRITES}


@pytest.mark.parametrize("request_", WRITES, ids=lambda each: f"{each.command:02X}")
def test_no_way_through_a_link_lets_a_write_out(request_: Request[None]) -> None:
    """Whichever command forgot to look: not a byte goes out, neither fence nor question before it."""
    ear = Ear()
    link = Link(MemoryTransport(ear), FACON, 1, LineSettings(), read_only=True)
    link.receiver.needs_fence = True
    for way in (link.ask, link.attempts.once, link.broadcast):
        with pytest.raises(LineReadOnly, match=f"{request_.command:02X}"):
            way(request_)
    assert ear.heard == []


# --- --broadcast ------------------------------------------------------------------------------------------


@pytest.fixture
def two(place: Path) -> str:
    """Two PLCs on one line, in a file."""
    build_simulation([1, 7], ladder_words=64, state=place / "two.state")
    return f"sim:{place / 'two.state'}"


def frames(trace: Path) -> list[bytes]:
    return [record.data for record in read_trace(trace.read_bytes(), trace.name) if record.direction == "tx"]


@pytest.mark.parametrize("as_json", [False, True], ids=["words", "json"])
@pytest.mark.parametrize("line", BROADCASTING.splitlines())
def test_a_broadcast_is_sent_to_station_0_and_not_proven(
    two: str, cli: Cli, line: str, *, as_json: bool
) -> None:
    words = [*line.split(), "-p", two, "-s", "0", "--trace", "t.ndjson", *(["--json"] if as_json else [])]
    done = cli(*words)
    assert done.code == 2
    assert "0 is broadcast, to which no PLC replies: add --broadcast" in one_line(done.err)
    assert not Path("t.ndjson").exists()
    done = cli(*words, "--broadcast")
    assert (done.code, done.err) == (0, "")
    sent = frames(Path("t.ndjson"))
    assert {frame[1:3] for frame in sent} == {b"00"}
    if as_json:
        document = done.document("broadcast")
        assert (document["station"], document["verified"], document["sent"]) == (0, False, len(sent))
    else:
        assert re.search(
            r"sent to every PLC on the line\nPLCs do not reply to broadcasts, so success cannot be checked",
            done.out,
        )


def test_every_plc_does_it(two: str, cli: Cli, place: Path) -> None:
    assert cli("write", "R1=5", "Y3=on", "-p", two, "-s", 0, "--broadcast", "--yes").code == 0
    assert cli("run", "-p", two, "-s", 0, "--broadcast", "--yes").code == 0
    plcs = build_simulation(state=place / "two.state").plcs
    assert {plc.read_words("R", 1, 1)[0] for plc in plcs.values()} == {5}
    assert all(plc.read_discretes("Y", 3, 1) == b"\x01" and plc.running for plc in plcs.values())


def test_the_bytes_of_a_broadcast_are_those_of_the_paper(two: str, cli: Cli) -> None:
    """FACON: STX, station 00, 41, 0 for STOP, the sum of all before it, ETX."""
    assert cli("stop", "-p", two, "-s", 0, "--broadcast", "--yes", "--trace", "t.ndjson").code == 0
    assert frames(Path("t.ndjson")) == [b"\x0200410F7\x03"]


@pytest.mark.parametrize("line", BROADCASTING.splitlines())
def test_a_broadcast_asks_first(two: str, cli: Cli, line: str) -> None:
    words = [word for word in line.split() if word != "--yes"]
    done = cli(*words, "-p", two, "-s", 0, "--broadcast", "--trace", "t.ndjson")
    assert done.code == 2
    assert one_line(done.err).endswith("nothing was done; add --yes")
    assert asked(Path("t.ndjson")) == []


def test_a_broadcast_takes_option_and_station(two: str, cli: Cli) -> None:
    done = cli("stop", "-p", two, "--broadcast", "--yes")
    assert done.code == 2
    assert "expected station 0, got 1; add -s 0, or leave out --broadcast" in one_line(done.err)


def test_a_broadcast_over_a_read_only_line(two: str, cli: Cli) -> None:
    done = cli("stop", "-p", two, "-s", 0, "--broadcast", "--yes", "--read-only", "--trace", "t.ndjson")
    assert done.code == 2
    assert "read-only" in one_line(done.err)
    assert asked(Path("t.ndjson")) == []


@pytest.mark.parametrize("line", [line for line in READING.splitlines() if not line.startswith("scan")])
def test_what_needs_an_answer_has_no_broadcast(press: Press, cli: Cli, line: str) -> None:
    done = cli(*line.split(), "-p", press.target, "-s", 0)
    assert done.code in {2, 3}  # 3 is what a monitoring plugin says of a wrong command line
    assert "station: expected 1 to 254, got 0" in done.err + done.out


def test_the_frames_of_a_broadcast_have_their_time() -> None:
    """Nobody says when it is done, so the next one waits for as long as a PLC may take."""
    ear = Ear()
    link = Link(MemoryTransport(ear), FACON, 1, LineSettings(), timeout_s=0.5)
    plc = Plc(link, "sim:")
    for _ in range(3):
        plc.broadcast(requests.RunStop(run=False))
    wire_s = len(ear.heard[0]) * LineSettings().byte_time_s
    assert link.transport.clock() == pytest.approx(3 * (0.5 + wire_s))
    with pytest.raises(NoAnswer):
        link.ask(Loopback(b"1"))


# --- files and doors --------------------------------------------------------------------------------------

MAKING = """\
backup x.json --raw x.bin
verify old.json --report x.html
snapshot R0 -o x.json
snapshot R0 -o x.csv --report x.html
status --trace x.pcap
status --trace x.ndjson
link table save R5000 x.toml --kind md0
loopback --count 2 --report x.html
restore new.json --yes
snapshot apply data.json --yes
link table write table.toml R5000 --yes
status -p sim:x.state
"""


@contextmanager
def umask(mask: int) -> Iterator[None]:
    before = os.umask(mask)
    try:
        yield
    finally:
        os.umask(before)


@pytest.mark.skipif(os.name != "posix", reason="POSIX rights")
@pytest.mark.parametrize("mask", [0, 0o022, 0o077])
@pytest.mark.parametrize("line", MAKING.splitlines())
def test_what_is_made_is_for_its_owner_and_the_group(press: Press, cli: Cli, line: str, mask: int) -> None:
    before = set(press.folder.iterdir())
    words = line.split() if "-p" in line else [*line.split(), "-p", press.target]
    with umask(mask):
        done = cli(*words)
    assert done.code == 0, done.err
    made = set(press.folder.iterdir()) - before
    assert made
    for path in made:
        assert stat.S_IMODE(path.stat().st_mode) == 0o640 & ~mask, path.name


@pytest.mark.parametrize(
    ("text", "host"),
    [("0", "127.0.0.1"), (":0", "127.0.0.1"), ("127.0.0.1:0", "127.0.0.1"), ("0.0.0.0:0", "0.0.0.0")],  # noqa: S104  # which has to be named
)
def test_the_simulator_listens_to_this_computer_alone_unless_told(text: str, host: str) -> None:
    server = Server(build_simulation(ladder_words=64))
    for kind, opened in (("tcp", server.open_tcp), ("udp", server.open_udp)):
        assert opened(*_host_and_port(text)).address.startswith(f"{kind}://{host}:")
    assert server.open_tcp().address.startswith("tcp://127.0.0.1:")
    server.close()
