"""Ctrl-C, SIGTERM and SIGKILL while many PLCs are backed up; the live table on a terminal."""

from __future__ import annotations

import json
import signal
import threading
from contextlib import contextmanager
from pathlib import Path
from typing import TYPE_CHECKING

import pytest

from fatektool.program.archive import load_backup, save_backup
from tests.cli.many.fleet.gateway import plcs_of
from tests.cli.running import OLD, check, served, started
from tests.cli.terminal import Terminal
from tests.guard import GUARD_S
from tests.program.samples import backup, program

if TYPE_CHECKING:
    from collections.abc import Iterator

LARGE = program(13184)


@contextmanager
def slow_and_quick() -> Iterator[threading.Event]:
    """Two PLCs, one of which takes long; the event is that it was asked for its sixth page."""
    with served(LARGE, scan_ms=30) as slow, served(OLD) as quick:
        device, asked = slow.simulation.plcs[1], threading.Event()
        original = device.read_page

        def observed(number: int) -> object:
            if number == 5:
                asked.set()
            return original(number)

        device.read_page = observed  # type: ignore[method-assign, assignment]  # to see it from outside
        Path("backups").mkdir()
        Path("fatek.toml").write_text(
            f'[plc.slow]\ntarget = "{slow.target}"\n[plc.quick]\ntarget = "{quick.target}"\n'
            f'[plc.behind]\ntarget = "{slow.target}"\nstation = 2\n'
        )
        yield asked


@pytest.mark.parametrize("as_json", [False, True], ids=["words", "json"])
@pytest.mark.parametrize("number", [signal.SIGINT, signal.SIGTERM])
def test_an_interrupt_tells_what_is_done(number: signal.Signals, *, as_json: bool) -> None:
    with slow_and_quick() as asked:
        command = started("fleet", "backup", "--dir", "backups", *(["--json"] if as_json else []))
        assert asked.wait(GUARD_S)
        while not Path("backups/quick.json").exists():
            assert command.poll() is None
        command.send_signal(number)
        out, err = command.communicate()
    assert command.returncode == 130
    assert err.splitlines()[-1] == "fatektool: interrupted; not done: slow, behind"
    assert "Traceback" not in err
    assert err.splitlines()[-2].startswith("backup: 1 of 3 done, 2 not done")
    if as_json:
        document = json.loads(out)
        check(document, "fleet")
        assert document["interrupted"] is True
        assert {name: plc["exit_code"] for name, plc in plcs_of(document).items()} == {
            "slow": 130,
            "quick": 0,
            "behind": 130,
        }
    else:
        assert out == "quick   done      first backup, FB30, 400 words\n"
    assert [path.name for path in Path("backups").iterdir()] == ["quick.json"]
    assert load_backup(Path("backups/quick.json")).program == OLD


def compare_slow() -> None:
    """Let a check of the slow PLC read its program."""
    save_backup(backup(LARGE), Path("large.json"))
    tables = Path("fatek.toml").read_text().replace("[plc.slow]", '[plc.slow]\nreference = "large.json"')
    Path("fatek.toml").write_text(f'[defaults]\nexpect = "any"\n{tables}')


@pytest.mark.parametrize("as_json", [False, True], ids=["words", "json"])
@pytest.mark.parametrize("number", [signal.SIGINT, signal.SIGTERM])
def test_an_interrupted_check_is_unknown(number: signal.Signals, *, as_json: bool) -> None:
    """A plugin has no 130."""
    with slow_and_quick() as asked:
        compare_slow()
        words = ["--select", "slow", "--select", "behind", *(["--json"] if as_json else [])]
        command = started("fleet", "check", *words)
        assert asked.wait(GUARD_S)
        command.send_signal(number)
        out, err = command.communicate()
    assert (command.returncode, err) == (3, "")
    if as_json:
        document = json.loads(out)
        check(document, "fleet")
        assert (document["interrupted"], document["state"]) == (True, "UNKNOWN")
        assert document["summary"] == {"total": 2, "ok": 0, "failed": 0, "changed": 0, "not_done": 2}
        assert {plc["exit_code"] for plc in document["plcs"]} == {130}
        return
    line, *others = out.splitlines()
    told, figures = line.split(" | ")
    assert told == "FATEK UNKNOWN - 0 of 2 PLCs OK; 2 UNKNOWN: slow, behind; interrupted"
    assert figures.startswith("ok=0 warning=0 critical=0 unknown=2 ")
    assert others == [f"UNKNOWN - {name}: interrupted before it was done" for name in ("slow", "behind")]


def test_an_interrupted_check_keeps_what_was_found_and_calls_nobody_for_the_rest() -> None:
    """A PLC that was not checked to its end has no fault."""
    with slow_and_quick() as asked:
        compare_slow()
        text = Path("fatek.toml").read_text().replace("[plc.quick]", '[plc.quick]\nexpect = "run"')
        Path("fatek.toml").write_text(text)
        alarm = "sh -c 'touch $FATEK_NAME.called'"
        command = started("fleet", "check", "--on-failure", alarm)
        assert asked.wait(GUARD_S)
        while not Path("quick.called").exists():
            assert command.poll() is None
        command.send_signal(signal.SIGINT)
        out, err = command.communicate()
    assert (command.returncode, err) == (2, "")
    told = "FATEK CRITICAL - 0 of 3 PLCs OK; 1 CRITICAL: quick; 2 UNKNOWN: slow, behind; interrupted"
    assert out.split(" | ")[0] == told
    assert [path.name for path in Path().glob("*.called")] == ["quick.called"]


def test_an_interrupted_check_of_one_plc() -> None:
    with slow_and_quick() as asked:
        save_backup(backup(LARGE), Path("large.json"))
        words = ["-p", "slow", "--reference", "large.json", "--expect", "any"]
        command = started("check", *words)
        assert asked.wait(GUARD_S)
        command.send_signal(signal.SIGINT)
        out, err = command.communicate()
    assert (command.returncode, out, err) == (3, "FATEK UNKNOWN - interrupted\n", "")


def test_a_kill_leaves_no_half_file() -> None:
    with slow_and_quick() as asked:
        command = started("fleet", "backup", "--dir", "backups")
        assert asked.wait(GUARD_S)
        command.kill()
        command.communicate()
    names = [path.name for path in Path("backups").iterdir() if path.suffix == ".json"]
    assert names in (["quick.json"], [])


@pytest.mark.parametrize(("columns", "lines"), [(80, 24), (24, 6)])
def test_the_live_table(columns: int, lines: int) -> None:
    with slow_and_quick():
        words = ["fleet", "backup", "--dir", "backups", "--single-pass"]
        with Terminal(*words, columns=columns, lines=lines) as terminal:
            terminal.read_until("reading")
            terminal.read_until("quick   done")
            terminal.type("\x03")
            assert terminal.end() == 130
            assert "backup: 1 of 3 ended" in terminal.text or columns < 30
            assert "backup: 1 of 3 done" in terminal.text.replace("\n", " ")


def test_nothing_of_it_where_nobody_wants_it() -> None:
    with served(OLD) as door:
        tables = f'[plc.press]\ntarget = "{door.target}"\n[plc.nobody]\ntarget = "/dev/nobody"\n'
        Path("fatek.toml").write_text(tables)
        with Terminal("fleet", "status", "--news", "-q", columns=300) as terminal:
            assert terminal.end() == 1
            (line,) = terminal.text.splitlines()
            assert line.startswith("nobody  FAILED    no valid answer: /dev/nobody: ")
