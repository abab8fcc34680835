"""``--trace`` on every command that talks to a PLC, whatever becomes of the command."""

from __future__ import annotations

import json
import signal
from pathlib import Path
from typing import TYPE_CHECKING

import click
import pytest

from fatektool.cli.app import app
from fatektool.transport.trace_reader import TraceRecord, read_trace
from tests.cli.programs.monitor.plant import IMAGE
from tests.cli.running import OLD, process, served, started
from tests.held import HeldAnswer
from tests.project.files import backup_file

if TYPE_CHECKING:
    from collections.abc import Iterator

    from tests.cli.running import Cli, Press

SUFFIXES = (".pcap", ".ndjson")
TALKING = """\
backup x.json
verify old.json
restore new.json --yes
status
status --brief
run --yes
stop
read R1 X0-X7
write R1=5 Y0=on
discrete list Y0-Y7
discrete disable X1
discrete enable X1
discrete set Y1
discrete reset Y1
snapshot R0-R9
watch R1 --count 2 --interval 0.01
loopback --count 3
doctor
link ports
scan --stations 1-2 --timeout 0.01
check --expect any --reference old.json
monitor ladder.json --count 2 --interval 0.01
"""


def commands(group: click.Group, path: tuple[str, ...] = ()) -> Iterator[tuple[str, click.Command]]:
    """Every command that can be called, with its words."""
    context = click.Context(group)
    for name in group.list_commands(context):
        command = group.get_command(context, name)
        assert command is not None
        yield " ".join([*path, name]), command
        if isinstance(command, click.Group):
            yield from commands(command, (*path, name))


def records(path: Path) -> list[TraceRecord]:
    return list(read_trace(path.read_bytes(), path.name))


def test_whatever_has_a_port_has_a_trace() -> None:
    talking = set()
    for words, command in commands(app):
        options = {parameter.name for parameter in command.params}
        if "port" in options and words != "inventory add":  # which asks no PLC
            assert "trace" in options, words
            talking.add(words.split()[0])
    assert talking == {line.split()[0] for line in TALKING.splitlines()} & set(app.subcommands)


@pytest.mark.parametrize("line", TALKING.splitlines())
def test_every_command_is_recorded(press: Press, cli: Cli, line: str) -> None:
    """In both forms, with the same requests, and the bytes of one record are whole frames."""
    found = []
    backup_file("ladder.json", IMAGE)
    for suffix in SUFFIXES:
        trace = Path(f"line{suffix}")
        words = line.replace("x.json", f"x{suffix}.json").split()
        assert cli(*words, "-p", press.target, "--trace", trace).code in {0, 1}
        found.append(records(trace))
    for of_one in found:
        assert {record.direction for record in of_one} == {"tx", "rx"}
        assert of_one[0].direction == "tx"
        assert all(record.data[0] == 0x02 and record.data[-1] == 0x03 for record in of_one)
        assert [record.time for record in of_one] == sorted(record.time for record in of_one)
    asks_the_same_twice = ("status", "verify", "read", "discrete", "snapshot")
    if line.startswith(asks_the_same_twice):
        pcap, ndjson = ([r.data for r in of_one if r.data[3:5] != b"4E"] for of_one in found)
        assert pcap == ndjson


@pytest.mark.parametrize("suffix", SUFFIXES)
def test_a_command_that_nobody_answers(cli: Cli, press: Press, suffix: str) -> None:
    trace = Path(f"line{suffix}")
    words = ["--station", 9, "--timeout", 0.01, "--retries", 2, "--trace", trace]
    assert cli("status", "-p", press.target, *words).code == 3
    sent = [(record.direction, record.data[:5]) for record in records(trace)]
    assert sent[0] == ("tx", b"\x020940")
    assert len(sent) >= 3
    assert {direction for direction, _ in sent} == {"tx"}


@pytest.mark.parametrize("suffix", SUFFIXES)
@pytest.mark.parametrize("number", [signal.SIGINT, signal.SIGTERM])
def test_a_command_that_is_interrupted(place: Path, suffix: str, number: signal.Signals) -> None:
    trace = place / f"line{suffix}"
    with served(OLD) as door:
        answer = HeldAnswer(door.simulation, "read_page", 5)
        command = started("backup", "x.json", "-p", door.target, "--trace", trace)
        with answer:
            command.send_signal(number)
        command.communicate()
    assert command.returncode == 130
    pages = [record.data for record in records(trace) if record.data[:5] == b"\x02014F"]
    assert any(page[5:9] == b"0005" for page in pages)  # it may have gone on before the signal came
    decoded = process("decode", trace)
    # The interrupt may have come within an answer: that one is cut off, and no other.
    assert (decoded.code, decoded.out.count("fault:")) in {(0, 0), (5, 1)}


def test_a_command_that_is_killed_keeps_all_but_the_last_record(place: Path) -> None:
    trace = place / "line.ndjson"
    with served(OLD) as door:
        answer = HeldAnswer(door.simulation, "read_page", 5)
        command = started("backup", "x.json", "-p", door.target, "--trace", trace)
        with answer:
            command.kill()
            command.communicate()
    lines = [json.loads(line) for line in trace.read_text(encoding="utf-8").splitlines()]
    assert sum(line["direction"] == "rx" for line in lines) >= 5
