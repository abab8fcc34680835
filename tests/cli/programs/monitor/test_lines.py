"""``monitor`` without a terminal: one NDJSON line a round, and how it ends."""

from __future__ import annotations

import json
import os
import signal
from subprocess import PIPE
from typing import TYPE_CHECKING, Any

import pytest

from fatektool.transport.trace_reader import read_trace
from tests.cli.programs.monitor.plant import press, switch
from tests.cli.running import check, environment, started
from tests.forks.command import Forked
from tests.plant import cut_after, error_of, spied

if TYPE_CHECKING:
    from pathlib import Path

    from tests.cli.running import Cli, Door

WORDS = ("monitor", "press.pdw", "--encoding", "cp1250", "--network", "1")
READS = {"40", "44", "46", "48", "4E", "4F", "53"}


def rounds(text: str) -> list[Any]:
    found = [json.loads(line) for line in text.splitlines()]
    for document in found:
        check(document, document["schema"].removeprefix("fatektool.").partition("/")[0])
    return found


def shown(cli: Cli, door: Door, *words: object, code: int = 0) -> list[Any]:
    done = cli(*WORDS, "-p", door.target, "--interval", "0", *words)
    assert done.code == code, done
    return rounds(done.out)


@pytest.mark.parametrize("more", [(), ("--json",)])
def test_a_line_a_round(cli: Cli, more: tuple[str, ...]) -> None:
    with press() as door:
        switch(door, X0=1, Y4=1)
        found = shown(cli, door, "--count", "3", *more)
    assert len(found) == 3
    assert found[2]["values"] == {"X0": True, "M421": False, "Y4": True}
    assert found[2]["running"] is True
    assert found[2]["networks"] == [
        {
            "number": 1,
            "reason": None,
            "instructions": [
                {"number": 4, "text": "ORG X0", "carries": [True]},
                {"number": 5, "text": "AND M421", "carries": [False]},
                {"number": 6, "text": "OUT Y4", "carries": [False]},
            ],
        }
    ]
    program = found[2]["program"]
    assert (program["compared"], program["pages"], program["reason"]) == ("same", [1, 2, 4], None)


def test_it_reads_only(cli: Cli, place: Path) -> None:
    """Whatever is refused, lost or differs on the way: no command that writes goes out."""
    with press() as door:
        door.simulation.plcs[1].memory._sizes["M"] = 400
        words = ["--count", "3", "--network", "0-11", "--trace", "t.ndjson", "--retries", "1"]
        shown(cli, door, *words, code=4)
    trace = place / "t.ndjson"
    sent = [record.data for record in read_trace(trace.read_bytes(), trace.name) if record.direction == "tx"]
    assert {frame[3:5].decode() for frame in sent} <= READS
    assert {"40", "4F"} < {frame[3:5].decode() for frame in sent}


def test_an_element_that_is_refused(cli: Cli) -> None:
    with press() as door:
        door.simulation.plcs[1].memory._sizes["M"] = 400
        (first, last) = shown(cli, door, "--count", "2", code=4)
    assert first["values"] == last["values"] == {"X0": False, "M421": None, "Y4": False}
    assert [*last["errors"]] == ["M421"]
    assert [each["carries"] for each in last["networks"][0]["instructions"]] == [[False], [False], [False]]


def test_a_line_that_comes_and_goes(cli: Cli, monkeypatch: pytest.MonkeyPatch) -> None:
    seen: list[bytes] = []
    with press() as door:
        spied(monkeypatch, seen.append, lambda: not 8 < len(seen) < 16)
        done = cli(*WORDS, "-p", door.target, "--interval", "0", "--count", "6", "--retries", "0")
    assert (done.code, len(rounds(done.out))) == (0, 6)
    assert "trying again" in done.err


@pytest.mark.parametrize("more", [(), ("--json",)])
def test_a_line_that_stays_dead(cli: Cli, monkeypatch: pytest.MonkeyPatch, more: tuple[str, ...]) -> None:
    with press() as door:
        cut_after(monkeypatch, 20)
        done = cli(*WORDS, "-p", door.target, "--interval", "0", *more)
    assert done.code == 3
    found = rounds(done.out)
    assert len(found) > 1
    assert [each["schema"] for each in found].count("fatektool.error/1") == len(more)
    assert done.err.splitlines()[-1].startswith("fatektool: no answer")


def test_no_plc(cli: Cli) -> None:
    with press() as door:
        del door.simulation.plcs[1]
        done = cli(*WORDS, "-p", door.target)
    assert "no answer" in error_of(done, 3)


@pytest.mark.parametrize("more", [(), ("--json",)])
def test_ctrl_c(more: tuple[str, ...]) -> None:
    with press() as door:
        job = started(*WORDS, "--interval", "0.01", "-p", door.target, *more)
        assert job.stdout is not None
        first = job.stdout.readline()
        job.send_signal(signal.SIGINT)
        out, err = job.communicate()
    assert job.returncode == 130
    assert err.splitlines()[-1] == "fatektool: interrupted"
    found = rounds(first + out)
    assert (found[-1]["schema"] == "fatektool.error/1") == bool(more)


def test_a_reader_that_is_gone() -> None:
    """It ends by itself, though no count was given."""
    with press() as door:
        reader, writer = os.pipe()
        os.close(reader)
        words = (*WORDS, "--interval", "0", "-p", door.target)
        with Forked(words, stdout=writer, stderr=PIPE, environment=environment()) as command:
            os.close(writer)
            _, err = command.communicate()
        assert (command.wait(), err) == (141, "")


def test_words_that_do_not_fit(cli: Cli) -> None:
    with press() as door:
        for words in (["--why", "Y4", "--count", "3"], ["--network", "99"], ["--count", "0"]):
            error_of(cli(*WORDS, *words, "-p", door.target), 2)
