"""A restore that did not complete is remembered: who talks to that PLC next is warned."""

from __future__ import annotations

import json
import os
import shlex
from pathlib import Path
from typing import TYPE_CHECKING, Any

import pytest

from fatektool.cli.shared.unfinished import record_of, record_to_use, unfinished
from fatektool.errors import DataError
from fatektool.jobs.write_back.record import Unfinished
from fatektool.simulator.refusal import Refusal
from tests.cli.running import NEW, OLD, Cli, Door, Press, served
from tests.platforms import posix
from tests.program.samples import program

if TYPE_CHECKING:
    from collections.abc import Iterator

WARNING = "warning: a restore into this PLC did not complete: do not switch it to RUN"
QUICK = ("--timeout", "0.2", "--retries", "0")


@pytest.fixture
def door() -> Iterator[Door]:
    with served(faults=["power-cut=4"]) as found:
        yield found


def fail(cli: Cli, press: Press, door: Door) -> str:
    """A restore whose PLC loses its power; the command that finishes it."""
    done = cli("restore", press.new, "-p", door.target, "--yes", *QUICK)
    assert done.code == 6
    door.simulation.power_on()
    return done.err.splitlines()[-1]


def test_who_talks_to_it_next_is_warned(press: Press, cli: Cli, door: Door, state_folder: Path) -> None:
    command = fail(cli, press, door)
    (record,) = state_folder.iterdir()
    (safety,) = press.safety
    again = command  # FILE was a whole path already
    for words in (["status"], ["backup", "x.json"], ["run", "--yes"], ["read", "R0"], ["verify", press.new]):
        done = cli(*words, "-p", door.target)
        lines = done.err.splitlines()
        at = lines.index(WARNING)
        assert lines[at + 1].startswith("  started           20")
        assert lines[at + 2] == f"  file              {press.new}"
        assert lines[at + 3] == f"  previous program  saved in {safety}"
        assert lines[at + 4].startswith(
            "  other PLC?        if another one is connected now, do not finish it here"
        )
        assert lines[at + 4].endswith(f", and delete {record}")
        assert lines[at + 5 : at + 7] == ["  to finish it, run:", again], words
        assert record.exists()
    checked = cli("check", "--expect", "any", "-p", door.target)
    assert checked.code == 2
    assert "restore UNFINISHED since 20" in checked.out
    assert cli("stop", "-p", door.target, "--yes").code == 0
    document = cli("status", "-p", door.target, "--json").document("status")["unfinished_restore"]
    assert (document["file"], document["safety_backup"]) == (str(press.new), str(safety))
    assert document["command"] == again


def test_half_a_program_does_not_run(press: Press, cli: Cli, door: Door) -> None:
    command = fail(cli, press, door)
    for words in (["run", "--yes"], ["run", "--yes", "--json"]):
        done = cli(*words, "-p", door.target)
        assert done.code == 4
        assert (
            f"the PLC stays in STOP: it has pages of {press.new} and pages of the program before" in done.err
        )
        assert done.err.splitlines()[-1].endswith(command)
        assert not door.simulation.plcs[1].running
    assert cli(*shlex.split(command)[1:]).code == 0
    assert cli("run", "--yes", "-p", door.target).code == 0
    assert door.simulation.plcs[1].running


@pytest.mark.parametrize("now", ["the previous", "the new", "another", "no file"])
def test_a_whole_program_runs_whatever_the_record_says(press: Press, cli: Cli, door: Door, now: str) -> None:
    """Another PLC may be connected to the port, or the program may have been loaded in another way."""
    fail(cli, press, door)
    device = door.simulation.plcs[1]
    if now == "no file":
        press.new.unlink()
    else:
        image = {"the previous": OLD, "the new": NEW, "another": program(400, seed=9)}[now]
        device.pages[:] = image.pages
    done = cli("run", "--yes", "-p", door.target)
    assert done.code == 0
    assert WARNING in done.err
    assert device.running


def test_the_command_that_is_said_finishes_it_and_nobody_is_warned_any_more(
    press: Press, cli: Cli, door: Door, state_folder: Path
) -> None:
    command = fail(cli, press, door)
    done = cli(*shlex.split(command)[1:])
    assert done.code == 0
    assert WARNING not in done.err
    assert door.pages == NEW.pages
    assert not list(state_folder.iterdir())
    done = cli("status", "-p", door.target, "--json")
    assert done.err == ""
    assert done.document("status")["unfinished_restore"] is None


def test_another_plc_is_not_meant(press: Press, cli: Cli, door: Door) -> None:
    fail(cli, press, door)
    assert WARNING not in cli("status", "-p", press.target).err
    assert record_of(door.target, 1) != record_of(door.target, 2)
    assert record_of("sim:", 1) is None


def test_two_names_of_one_line_are_one(place: Path) -> None:
    (place / "link").symlink_to(place / "plc.state")
    assert record_of(f"sim:{place}/link", 1) == record_of(f"sim:{place}/plc.state", 1)
    assert record_of("tcp://HOST", 1) == record_of("udp://host:500", 1)


@posix("a symbolic link names an adapter")
def test_an_adapter_that_was_plugged_in_again_is_the_same(tmp_path: Path, state_folder: Path) -> None:
    """``/dev/serial/by-id/…`` is ttyUSB1 then, where it was ttyUSB0."""
    link = tmp_path / "adapter"
    for number in (0, 1):
        (tmp_path / f"ttyUSB{number}").touch()
    link.symlink_to("ttyUSB0")
    target = str(link)
    for about in ((), ("data",)):
        before = record_of(target, 1, *about)
        assert before is not None
        record = Unfinished(target, 1, "2026-11-28T03:15:00Z", "/srv/a.json", None, f"restore {about}")
        record.save(Path(before))

    link.unlink()
    link.symlink_to("ttyUSB1")
    assert {each.command for each in unfinished(target, 1)} == {"restore ()", "restore ('data',)"}
    assert unfinished(target, 2) == unfinished(str(tmp_path / "ttyUSB1"), 1) == []
    for about in ((), ("data",)):
        found = record_to_use(target, 1, *about)
        assert found is not None
        assert Path(found).parent == state_folder
        assert Unfinished.load(Path(found)).command == f"restore {about}"
    assert record_to_use(target, 1, "other") == record_of(target, 1, "other")
    assert record_to_use(target, 2) == record_of(target, 2)


def test_records_of_other_plcs_are_not_read(
    press: Press, cli: Cli, door: Door, monkeypatch: pytest.MonkeyPatch
) -> None:
    """Each command would pay for it, as long as there is one."""
    fail(cli, press, door)
    read: list[str | None] = []
    monkeypatch.setattr("fatektool.cli.shared.unfinished.load", read.append)
    assert unfinished("tcp://127.0.0.1:1", 1) == unfinished("/dev/ttyUSB0", 1) == []
    assert not read
    unfinished(door.target, 1)
    assert len(read) == 1


def test_verify_that_finds_it_whole_clears_it(press: Press, cli: Cli, door: Door, state_folder: Path) -> None:
    fail(cli, press, door)
    assert cli("verify", press.old, "-p", door.target).code == 1
    assert list(state_folder.iterdir())
    door.simulation.plcs[1].pages[:] = OLD.pages
    done = cli("verify", press.old, "-p", door.target)
    assert (done.code, WARNING in done.err) == (0, False)
    assert not list(state_folder.iterdir())


def test_the_record_is_there_before_the_first_page_is_written(
    press: Press, cli: Cli, state_folder: Path
) -> None:
    with served() as door:
        device = door.simulation.plcs[1]
        write, seen = device.write_page, []

        def write_page(page: int, content: bytes) -> None:
            seen.append(len(list(state_folder.iterdir())))
            write(page, content)

        device.write_page = write_page  # type: ignore[method-assign]
        assert cli("restore", press.new, "-p", door.target, "--yes").code == 0
    assert seen == [1] * 8
    assert not list(state_folder.iterdir())


def test_what_changed_nothing_leaves_no_record_and_no_safety_copy(
    press: Press, cli: Cli, state_folder: Path
) -> None:
    with served() as door:
        assert cli("restore", press.new, "-p", door.target).code == 2  # nobody to ask
        assert press.safety == []
        device = door.simulation.plcs[1]

        def write_page(page: int, content: bytes) -> None:  # noqa: ARG001
            raise Refusal(4)

        device.write_page = write_page  # type: ignore[method-assign]
        assert cli("restore", press.new, "-p", door.target, "--yes").code == 4
        assert not list(state_folder.iterdir())
        assert cli("restore", press.new, "-p", door.target, "--yes", "--rollback").code == 4
        assert not list(state_folder.iterdir())


def test_an_attempt_that_changes_nothing_leaves_what_was_known(
    press: Press, cli: Cli, door: Door, state_folder: Path
) -> None:
    fail(cli, press, door)
    (record,) = state_folder.iterdir()
    before = record.read_bytes()
    device = door.simulation.plcs[1]

    def write_page(page: int, content: bytes) -> None:  # noqa: ARG001
        raise Refusal(4)

    device.write_page = write_page  # type: ignore[method-assign]
    assert cli("restore", press.old, "-p", door.target, "--yes").code == 4
    assert record.read_bytes() == before


def test_the_way_back_to_the_last_whole_program_is_kept(press: Press, cli: Cli, state_folder: Path) -> None:
    with served(faults=["power-cut=4"]) as door:
        fail(cli, press, door)
        (first,) = press.safety
    (record,) = state_folder.iterdir()
    other = press.folder / "other.json"
    other.write_bytes(press.old.read_bytes())
    with served(faults=["power-cut=2"]) as second:
        record.rename(str(record_of(second.target, 1)))
        second.simulation.plcs[1].pages[1:3] = NEW.pages[1:3]
        assert cli("restore", other, "-p", second.target, "--yes", *QUICK).code == 6
        found = Unfinished.load(next(iter(state_folder.iterdir())))
    assert found.file == str(other)
    assert found.safety_backup == str(first)


def test_a_record_that_cannot_be_written_stops_nothing(
    press: Press, cli: Cli, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setenv("FATEKTOOL_STATE_DIR", str(press.new))  # a file
    done = cli("restore", press.new, "-p", press.target, "--yes")
    assert done.code == 0
    assert press.program == NEW
    assert "warning: no record of this write, should it not complete: " in done.err


@pytest.mark.parametrize(
    "text", ["", "{}", "[]", "\0", '{"schema": "fatektool.unfinished/1", "station": "1"}']
)
def test_a_record_that_cannot_be_read_is_a_warning(
    press: Press, cli: Cli, state_folder: Path, text: str
) -> None:
    state_folder.mkdir()
    path = str(record_of(press.target, 1))
    with open(path, "w", encoding="utf-8") as file:  # noqa: PTH123
        file.write(text)
    done = cli("status", "-p", press.target, "--json")
    assert done.code == 0
    assert (
        done.err
        == f"warning: a write into this PLC did not complete, and its record cannot be read: {path}\n"
    )
    assert done.document("status")["unfinished_restore"] is None
    assert cli("restore", press.new, "-p", press.target, "--yes").code == 0
    assert not os.path.exists(path)  # noqa: PTH110


def test_a_record_is_read_as_it_was_written(tmp_path: Path) -> None:
    record = Unfinished(
        "tcp://h", 7, "2026-11-22T03:15:00Z", "/a b.json", None, "fatektool restore '/a b.json'"
    )
    record.save(tmp_path / "deep" / "er" / "x.json")
    assert Unfinished.load(tmp_path / "deep" / "er" / "x.json") == record
    found: dict[str, Any] = json.loads((tmp_path / "deep" / "er" / "x.json").read_bytes())
    for key in list(found):
        (tmp_path / "y.json").write_text(json.dumps({name: found[name] for name in found if name != key}))
        with pytest.raises(DataError):
            Unfinished.load(tmp_path / "y.json")
