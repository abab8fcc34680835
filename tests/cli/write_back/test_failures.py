"""One table of failures over each command whose write can be undone: what the PLC holds, what is said."""

from __future__ import annotations

import errno
import json
import os
import re
import shlex
from itertools import count
from pathlib import Path
from typing import TYPE_CHECKING

import pytest

from fatektool.errors import UsageError
from fatektool.simulator.plc import SimulatedPlc
from fatektool.simulator.refusal import Refusal, RefusalCode
from tests.cli.write_back.writers import WRITERS, WRITES, Bench

if TYPE_CHECKING:
    from collections.abc import Callable

    from tests.cli.running import Cli, Done

WRITERS_OF_THE_PLC = ("write_page", "write_words", "write_discretes", "write_mixed")
QUICK = ("--retries", "0", "--timeout", "0.01")


@pytest.fixture(params=WRITERS)
def bench(request: pytest.FixtureRequest, place: Path, cli: Cli, monkeypatch: pytest.MonkeyPatch) -> Bench:
    return Bench(request.param, place, cli, monkeypatch)


def last(done: Done) -> str:
    return done.err.splitlines()[-1]


# --- nothing is written ---------------------------------------------------------------------------------


def test_nobody_can_be_asked(bench: Bench) -> None:
    done = bench.run()
    assert done.code == 2
    assert last(done).endswith("there is no terminal to ask on: nothing was written; add --yes")
    bench.untouched()


@pytest.mark.parametrize("answer", ["n\n", "\n", ""])
def test_the_answer_is_no(bench: Bench, answer: str) -> None:
    seen: list[list[Path]] = []

    def say() -> str:
        seen.append(bench.copies)
        return answer

    bench.answer(say)
    done = bench.run()
    assert done.code == 2
    assert done.err.endswith("fatektool: Aborted. Nothing was written.\n")
    assert len(seen[0]) == 1  # on disk before the question
    bench.untouched()


def test_ctrl_c_at_the_question(bench: Bench) -> None:
    def interrupt() -> str:
        raise KeyboardInterrupt

    bench.answer(interrupt)
    done = bench.run()
    assert done.code == 130
    assert done.err.endswith("fatektool: interrupted: nothing was written\n")
    bench.untouched()


def test_a_dry_run_names_the_plc_and_writes_nothing(bench: Bench) -> None:
    done = bench.run("--dry-run")
    assert done.code == 0
    lines = done.out.splitlines()
    assert lines[0].split(maxsplit=1) == ["PLC", f"station 1 on {bench.target}"]
    assert f"Previous {bench.writer.copied} will be saved first." in lines
    assert "dry run: nothing was written" in lines
    bench.untouched()


def test_the_disk_is_full(bench: Bench, monkeypatch: pytest.MonkeyPatch) -> None:
    def full(descriptor: int) -> None:  # noqa: ARG001
        raise OSError(errno.ENOSPC, os.strerror(errno.ENOSPC))

    with monkeypatch.context() as patch:
        patch.setattr(os, "fsync", full)
        done = bench.run("--yes")
    assert done.code == 5
    assert "No space left on device: nothing was written into the PLC; free some space" in last(done)
    bench.untouched()


def test_the_safety_folder_cannot_be_used(bench: Bench) -> None:
    done = bench.run("--yes", "--safety-dir", "new.json")
    assert done.code == 2
    assert "new.json is not a folder" in last(done)
    bench.untouched()


@pytest.mark.parametrize(
    ("change", "code", "words"),
    [("running", 4, "went to RUN since"), ("model", 5, "this is not the PLC whose")],
)
def test_the_plc_changes_while_the_question_waits(bench: Bench, change: str, code: int, words: str) -> None:
    made = bench.devices()

    def meanwhile() -> str:
        if change == "running":
            made[-1].running = True
        else:
            status = type(made[-1]).brief_status
            bench.patch.setattr(SimulatedPlc, "brief_status", lambda plc: status(plc)[:1] + b"\x53\0")
            bench.patch.setattr(SimulatedPlc, "detailed_status", other_size(made[-1]))
        return "y\n"

    bench.answer(meanwhile)
    done = bench.run()
    assert done.code == code, done
    assert words in last(done)
    assert "nothing was written" in last(done)
    assert bench.copies == []
    assert bench.records == []
    assert bench.held[:3] == bench.before[:3]


def other_size(plc: SimulatedPlc) -> Callable[[SimulatedPlc], bytes]:
    """53 of a PLC with one more ladder page."""
    answer = bytearray(plc.detailed_status())
    answer[5] ^= 0x40
    return lambda _: bytes(answer)


def test_what_is_there_already_is_not_written(bench: Bench) -> None:
    assert bench.run("--yes").code == 0
    (copy,) = bench.copies
    assert bench.held == bench.after
    done = bench.run()  # which asks nothing
    assert done.code == 0
    assert done.out.startswith("same: ")
    assert bench.copies == [copy]
    bench.undo()


# --- the PLC says no ------------------------------------------------------------------------------------


def test_the_plc_refuses_to_be_written(bench: Bench, monkeypatch: pytest.MonkeyPatch) -> None:
    def refuse(*_: object) -> None:
        raise Refusal(RefusalCode.WRITE_PROHIBITED)

    with monkeypatch.context() as patch:
        for name in WRITERS_OF_THE_PLC:
            patch.setattr(SimulatedPlc, name, refuse)
        done = bench.run("--yes")
    assert done.code == 4
    assert bench.writer.refused in done.err
    assert bench.held == bench.before
    assert bench.records == []


def test_the_plc_acknowledges_and_writes_nothing(bench: Bench, monkeypatch: pytest.MonkeyPatch) -> None:
    with monkeypatch.context() as patch:
        patch.setattr(
            SimulatedPlc, "acknowledge_only", property(lambda _: True, lambda *_: None), raising=False
        )
        done = bench.run("--yes")
    assert done.code == 4
    assert bench.writer.refused in done.err
    assert "acknowledged" in done.err
    assert bench.held == bench.before
    assert bench.records == []


# --- it ends half way -----------------------------------------------------------------------------------


def incomplete(bench: Bench, done: Done) -> str:
    """What is said of a write that ended half way is so; give the command that completes it."""
    assert done.code == 6, done
    error = done.document("error")["error"]
    details = error["details"]
    (copy,) = bench.copies
    assert details[bench.writer.key] == copy.name
    held = bench.held
    if bench.writer.copied == "program":
        for page in set(details["pages_written"]) - set(details["pages_unread"]):
            assert held[0][page] == bench.after[0][page]
        for page in details["pages_old"]:
            assert held[0][page] == bench.before[0][page]
    else:
        states = [details[f"values_{state}"] for state in ("written", "uncertain", "old")]
        for expected, spans in ((bench.after, states[0]), (bench.before, states[2])):
            for symbol, address in each(spans):
                area = 1 if symbol in {"R", "D"} else 2
                assert held[area][symbol][address] == expected[area][symbol][address], (symbol, address)
        assert any(states[:2])
    lines = done.err.splitlines()
    assert lines[-2:] == ["fix the cause, then run:", details["command"]]
    rows = [re.split(" {2,}", line.strip()) for line in lines]
    assert [f"previous {bench.writer.copied}", f"saved in {copy.name}"] in rows
    assert f"fatektool: {error['message'].partition(' (')[0]}" in lines

    warned = bench.cli("read", "R9000", "-p", bench.target)
    assert "into this PLC did not complete" in warned.err
    status = bench.cli("status", "-p", bench.target, "--json").document("status")
    known = [status["unfinished_restore"]] if bench.name == "restore" else status["unfinished_writes"]
    assert [record[bench.writer.key] for record in known] == [str(copy)]
    checked = bench.cli("check", "--expect", "any", "-p", bench.target)
    assert checked.code == (2 if bench.name == "restore" else 1)
    assert f"{bench.name} UNFINISHED since 20" in checked.out
    return str(details["command"])


def each(spans: list[str]) -> list[tuple[str, int]]:
    found = []
    for span in spans:
        first, _, end = span.partition("-")
        symbol = first.rstrip("0123456789")
        low = int(first.removeprefix(symbol))
        found += [(symbol, at) for at in range(low, int((end or first).removeprefix(symbol)) + 1)]
    return found


def complete(bench: Bench, command: str) -> None:
    """The command that was said completes the write; the safety copy is still the first run's."""
    program, *words = shlex.split(command)
    assert program == "fatektool"
    done = bench.cli(*words)
    assert done.code == 0, done
    assert "did not complete" not in done.err
    assert bench.held == bench.after
    assert bench.records == []
    assert "did not complete" not in bench.cli("status", "-p", bench.target).err


def test_the_line_is_cut_at_each_write(bench: Bench) -> None:
    copies: set[int] = set()
    for number in count():
        with pytest.MonkeyPatch.context() as patch:
            bench.cut(patch, number)
            done = bench.run("--yes", "--json", *QUICK)
        if done.code == 0:
            break
        complete(bench, incomplete(bench, done))
        copies.add(len(bench.copies))
        if len(bench.copies) == 1:
            bench.undo()
        bench.reset()
    assert number > (8 if bench.name == "restore" else 1)
    assert min(copies) == 1
    assert bench.held == bench.after


@pytest.mark.parametrize("when", ["before each request", "after each write"])
def test_ctrl_c_at_each_step(bench: Bench, when: str) -> None:
    """Before the first write nothing is changed; after it the same command completes the write."""
    codes: list[int] = []
    for number in count(1):
        sent: list[bytes] = []

        def interrupt(data: bytes, number: int = number, sent: list[bytes] = sent) -> None:
            if when == "before each request" or data[3:5] in WRITES:
                sent.append(data)
                if len(sent) == number:
                    raise KeyboardInterrupt

        def nothing(_: bytes) -> None:
            """Let it pass."""

        with pytest.MonkeyPatch.context() as patch:
            before, after = (interrupt, nothing) if when == "before each request" else (nothing, interrupt)
            bench.each_request(patch, before, after)
            done = bench.run("--yes", "--json")
        if done.code == 0:
            break
        codes.append(done.code)
        wrote = any(data[3:5] in WRITES for data in sent)
        if done.code == 130:
            assert bench.held in (bench.before, bench.after)  # page 0 is the same in both programs
            assert bench.records == []
            if not wrote:
                bench.untouched()
        else:
            assert wrote
            complete(bench, incomplete(bench, done))
        bench.reset()
    assert set(codes) >= {6}
    assert set(codes) <= {6, 130}


def fails_once(bench: Bench, patch: pytest.MonkeyPatch, error: Exception | None = None) -> None:
    """Let something fail behind the third page, or the first write of values; by default the trace."""
    writes = 0

    def fail(data: bytes) -> None:
        nonlocal writes
        writes += data[3:5] in WRITES
        if data[3:5] in WRITES and writes == (3 if bench.name == "restore" else 1):
            raise error or UsageError("cannot write the trace: No space left on device")

    bench.each_request(patch, lambda _: None, fail)


def test_whatever_fails_half_way_the_safety_copy_is_named(
    bench: Bench, monkeypatch: pytest.MonkeyPatch
) -> None:
    with monkeypatch.context() as patch:
        fails_once(bench, patch)
        done = bench.run("--yes", "--json")
    assert "cannot write the trace" in done.document("error")["error"]["details"]["cause"]
    complete(bench, incomplete(bench, done))


def test_a_fault_of_fatektool_half_way_is_named_as_one(bench: Bench, monkeypatch: pytest.MonkeyPatch) -> None:
    with monkeypatch.context() as patch:
        fails_once(bench, patch, RuntimeError("boom"))
        done = bench.run("--yes", "--json")
    cause = done.document("error")["error"]["details"]["cause"]
    assert cause == "a fault of fatektool itself: RuntimeError: boom"
    complete(bench, incomplete(bench, done))


def test_it_is_rolled_back(bench: Bench, monkeypatch: pytest.MonkeyPatch) -> None:
    with monkeypatch.context() as patch:
        fails_once(bench, patch)
        done = bench.run("--yes", "--json", "--rollback")
    assert done.code == 4
    error = done.document("error")["error"]
    assert "cannot write the trace: No space left on device; rolled back: " in error["message"]
    assert error["details"]["rolled_back"] is True
    assert bench.held == bench.before
    assert bench.records == []
    assert [path.name for path in bench.copies] == [error["details"][bench.writer.key]]


def test_a_rollback_that_fails_too(bench: Bench) -> None:
    with pytest.MonkeyPatch.context() as patch:
        bench.cut(patch, 1)
        done = bench.run("--yes", "--json", "--rollback", *QUICK)
    assert "; and rolling back failed: " in done.document("error")["error"]["details"]["cause"]
    complete(bench, incomplete(bench, done))


def test_without_a_safety_copy_that_is_said(bench: Bench) -> None:
    option = "--no-safety-backup" if bench.name == "restore" else "--no-safety-snapshot"
    with pytest.MonkeyPatch.context() as patch:
        bench.cut(patch, 1)
        done = bench.run("--yes", option, *QUICK)
    assert done.code == 6
    said = f"Previous {bench.writer.copied} NOT saved: this write cannot be undone."
    assert said in done.err.splitlines()
    assert re.search(f"  previous {bench.writer.copied} +not saved\n", done.err)
    assert bench.copies == []
    complete(bench, last(done))


def test_the_copy_of_the_first_run_is_used_again_wherever_it_is(bench: Bench) -> None:
    """Only that has the previous contents; one of the second run would have a half."""
    with pytest.MonkeyPatch.context() as patch:
        bench.cut(patch, 1)
        assert bench.run("--yes", "--safety-dir", "first", *QUICK).code == 6
    done = bench.run("--yes", "--safety-dir", "second", "--json")
    assert (done.code, bench.held) == (0, bench.after)
    (copy,) = bench.place.glob("first/*")
    assert not [*bench.place.glob("second/*")]
    named = json.loads(done.out).get(bench.writer.key)  # none if the one write was made, and its answer lost
    assert named is None or Path(named).samefile(copy)
    done = bench.cli(*bench.writer.undo, copy, "-p", bench.target, "--yes", "--safety-dir", "third")
    assert (done.code, bench.held) == (0, bench.before)


def test_the_record_is_of_this_write_alone(bench: Bench) -> None:
    """Another write that completes leaves it there."""
    with pytest.MonkeyPatch.context() as patch:
        bench.cut(patch, 1)
        command = last(bench.run("--yes", *QUICK))
    (record,) = bench.records
    bench.cli("write", "R3000=1", "-p", bench.target)
    other = "snapshot apply" if bench.name != "snapshot apply" else "link modem set"
    done = bench.cli(*WRITERS[other].words, "-p", bench.target, "--yes")
    assert done.code == 0
    assert "into this PLC did not complete" in done.err
    assert bench.records == [record]
    assert bench.cli(*shlex.split(command)[1:]).code == 0
    assert bench.records == []


@pytest.mark.parametrize("bench", [name for name in WRITERS if name != "restore"], indirect=True)
def test_a_snapshot_that_is_written_back_clears_the_record(bench: Bench) -> None:
    """A program that is verified clears that of a restore: see ``test_unfinished``."""
    with pytest.MonkeyPatch.context() as patch:
        bench.cut(patch, 1)
        assert bench.run("--yes", *QUICK).code == 6
    assert len(bench.records) == 1
    bench.undo()
    assert bench.records == []
