"""Devices that lie: each lie is found, and said with what it concerns and what to do next."""

from __future__ import annotations

from itertools import count
from typing import TYPE_CHECKING, Any

import pytest

from fatektool.errors import DataError, PlcNotReady, RestoreIncomplete
from fatektool.jobs.programs.backup import backup as back_up
from fatektool.jobs.programs.restore import RestoreOptions, restore
from fatektool.program.archive import load_backup, save_backup
from fatektool.simulator.build import build_plcs
from tests.cli.running import one_line, served
from tests.program.samples import backup, changed, program
from tests.rigs import Bench

if TYPE_CHECKING:
    from collections.abc import Callable, Iterator
    from pathlib import Path

    from fatektool.jobs.programs.restore import RestoreResult
    from fatektool.program.image import Program
    from fatektool.simulator.plc import SimulatedPlc
    from tests.cli.running import Cli, Door

WORDS, PAGES = 256, 5
OLD, NEW, OTHER = (program(WORDS, seed=seed) for seed in (1, 2, 3))
READ, WRITE, STATUS = "read_page", "write_page", "detailed_status"


@pytest.fixture
def door() -> Iterator[Door]:
    with served(OLD) as found:
        yield found


def at_call(device: SimulatedPlc, operation: str, number: int, act: Callable[[], object]) -> None:
    """Let something happen just before the number-th call of an operation."""
    original, calls = getattr(device, operation), count(1)

    def observed(*values: Any) -> Any:
        if next(calls) == number:
            act()
        return original(*values)

    setattr(device, operation, observed)


def another(image: Program, device: SimulatedPlc) -> Callable[[], None]:
    """Somebody takes the PLC off the line and puts one with this program in its place."""

    def swap() -> None:
        device.pages[:] = image.pages

    return swap


def put(bench: Bench, folder: Path, **options: bool) -> RestoreResult:
    return restore(
        bench.plc,
        backup(NEW),
        folder / "new.json",
        confirm=lambda plan, kept: True,  # noqa: ARG005
        options=RestoreOptions(**options),
        safety_folder=folder,
    )


# --- acknowledged and not made --------------------------------------------------------------------------

LIES = {
    "restore": (["restore", "new.json", "--yes"], "worn out or protected"),
    "write": (["write", "R12=5"], "R12: not kept: expected 5, read back 0"),
    "set": (["discrete", "set", "Y3"], "Y3: no effect: the program writes it too; 'fatektool discrete"),
    "disable": (["discrete", "disable", "X3"], "X3: no effect: acknowledged, but nothing changed"),
    "apply": (
        ["snapshot", "apply", "data.json", "--yes"],
        "not kept: expected 0007 in R12, read back 0000",
    ),
}


@pytest.mark.parametrize("as_json", [False, True], ids=["words", "json"])
@pytest.mark.parametrize("lie", LIES)
def test_what_is_acknowledged_and_not_made_is_said(place: Path, cli: Cli, lie: str, *, as_json: bool) -> None:
    words, message = LIES[lie]
    save_backup(backup(NEW), place / "new.json")
    with served(OLD) as honest:
        assert cli("write", "R12=7", "-p", honest.target).code == 0
        assert cli("snapshot", "R12", "-o", "data.json", "-p", honest.target).code == 0
    with served(OLD, faults=("lying-write=1",)) as door:
        done = cli(*words, "-p", door.target, *(["--json"] if as_json else []))
        assert done.code == 4
        assert message in done.err, done.err
        assert "Traceback" not in done.err
        assert door.pages == OLD.pages
    if as_json:
        document = done.document({"restore": "error", "apply": "apply"}.get(lie, words[0]))
        assert document.get("not_taken") or "acknowledged page 1-4" in document["error"]["message"]


@pytest.mark.parametrize("command", ["run", "stop"])
def test_a_mode_that_is_acknowledged_and_does_not_come(cli: Cli, door: Door, command: str) -> None:
    device = door.simulation.plcs[1]
    device.running = command == "stop"
    setattr(device, command, lambda: None)
    done = cli(command, "--yes", "-p", door.target)
    assert done.code == 4
    word, other = ("RUN", "STOP") if command == "run" else ("STOP", "RUN")
    assert f"acknowledged {word}, but its status is still {other}; see 'fatektool status'" in one_line(
        done.err
    )


def test_a_stop_that_is_acknowledged_and_not_made_lets_nothing_be_written(
    place: Path, cli: Cli, door: Door
) -> None:
    save_backup(backup(NEW, target=door.target), place / "new.json")
    device = door.simulation.plcs[1]
    device.running = True
    device.stop = lambda: None  # type: ignore[method-assign]  # as the PLC's own switch has it
    done = cli("restore", "new.json", "--stop", "--run", "--yes", "-q", "-p", door.target)
    assert done.code == 4
    assert "acknowledged STOP, but its status is still RUN" in one_line(done.err)
    assert door.pages == OLD.pages


def test_a_run_that_does_not_come_behind_a_restore(place: Path, cli: Cli, door: Door) -> None:
    """The program is in the PLC and proven: that is said, and that the machine stands."""
    save_backup(backup(NEW, target=door.target), place / "new.json")
    door.simulation.plcs[1].run = lambda: None  # type: ignore[method-assign]  # as an emergency stop has it
    done = cli("restore", "new.json", "--run", "--yes", "-q", "-p", door.target)
    assert done.code == 4
    line = one_line(done.err)
    assert "read back and verified, but the PLC does not RUN: the PLC acknowledged RUN" in line
    assert "see 'fatektool status'" in line
    assert door.pages == NEW.pages


# --- pages that read differently twice --------------------------------------------------------------------


@pytest.mark.parametrize("page", range(PAGES))
def test_a_page_that_reads_differently_twice_is_in_no_backup(
    place: Path, cli: Cli, door: Door, page: int
) -> None:
    at_call(
        door.simulation.plcs[1], READ, PAGES + 1 + page, another(changed(OLD, page), door.simulation.plcs[1])
    )
    done = cli("backup", "x.json", "-p", door.target)
    assert done.code == 5
    expected = f"two passes without line errors read different programs: page {page}"
    assert expected in one_line(done.err)
    assert "check that nobody loads a program" in done.err
    assert list(place.iterdir()) == []
    assert cli("backup", "x.json", "-p", door.target).code == 0  # it has come to rest
    assert load_backup(place / "x.json").program == changed(OLD, page)


def test_a_page_that_never_reads_the_same(place: Path, cli: Cli, door: Door) -> None:
    """A worn-out memory: no backup, no verify and no restore takes one of its readings for the truth."""
    device = door.simulation.plcs[1]
    calls = count()
    device.read_page = lambda page: (  # type: ignore[method-assign]
        OLD.pages[page] if page != 3 else next(calls).to_bytes(128, "big")
    )
    save_backup(backup(NEW, target=door.target), place / "new.json")
    assert cli("backup", "x.json", "-p", door.target).code == 5
    done = cli("restore", "new.json", "--yes", "-p", door.target)
    assert done.code == 5
    assert "two readings without line errors differ in page 3" in one_line(done.err)
    assert door.pages == OLD.pages
    assert [path.name for path in place.iterdir()] == ["new.json"]
    save_backup(backup(OLD), place / "old.json")
    done = cli("verify", "old.json", "-p", door.target)
    assert done.code in {1, 5}
    assert "page 3" in done.out + done.err


# --- another PLC in its place ---------------------------------------------------------------------------


@pytest.mark.parametrize("read", range(3, 2 * PAGES + 1))  # the header is the same in both
def test_a_plc_that_is_exchanged_between_two_pages_of_a_backup(read: int) -> None:
    bench = Bench(OLD)
    at_call(bench.device, READ, read, another(OTHER, bench.device))
    with pytest.raises(DataError, match=r"PLC was (not )?replaced") as caught:
        back_up(bench.plc)
    assert "two passes without line errors read different programs" in caught.value.message


@pytest.mark.parametrize("read", range(3, 2 * PAGES + 1))  # the header is the same in both
def test_a_plc_that_is_exchanged_while_a_restore_reads(place: Path, read: int) -> None:
    bench = Bench(OLD)
    at_call(bench.device, READ, read, another(OTHER, bench.device))
    with pytest.raises(DataError, match=r"PLC was (not )?replaced"):
        put(bench, place)
    assert bench.tap.pages_written == []
    assert list(place.iterdir()) == []


@pytest.mark.parametrize("changed_only", [False, True])
@pytest.mark.parametrize("write", range(3, PAGES))
def test_a_plc_that_is_exchanged_between_two_written_pages(
    tmp_path: Path, write: int, *, changed_only: bool
) -> None:
    """The new one gets the whole program, and it is said that the safety backup is not of what was in it."""
    bench = Bench(OLD)
    at_call(bench.device, WRITE, write, another(OTHER, bench.device))
    result = put(bench, tmp_path, changed_only=changed_only)
    assert bench.pages == NEW.pages
    (warning,) = result.warnings
    assert warning.startswith("page 1")
    assert "held neither the previous nor the new program: was the PLC replaced" in warning


def test_the_warning_is_told(place: Path, cli: Cli, door: Door) -> None:
    save_backup(backup(NEW, target=door.target), place / "new.json")
    device = door.simulation.plcs[1]
    at_call(device, WRITE, 4, another(OTHER, device))
    done = cli("restore", "new.json", "--yes", "--json", "-p", door.target)
    assert done.code == 0
    (warning,) = done.document("restore")["warnings"]
    assert f"warning: {warning}" in done.err
    assert "was the PLC replaced" in warning


# --- what else changes behind one's back ------------------------------------------------------------------


def larger(device: SimulatedPlc) -> Callable[[], None]:
    """Put a PLC with a larger ladder in its place."""
    spare = build_plcs(ladder_words=WORDS + 64)[1]

    def swap() -> None:
        device.model = spare.model
        device.pages[:] = [*device.pages, bytes(128)]

    return swap


FOUND = {
    2: f"does not fit this PLC: expected a ladder size of {WORDS + 64} words, got {WORDS}",
    3: f"ladder_words {WORDS}, then {WORDS + 64}",
    4: f"not the PLC whose program was read .*ladder_words {WORDS}, now {WORDS + 64}.*: nothing was written",
}


@pytest.mark.parametrize("status", FOUND)
def test_a_ladder_size_that_changes_is_found_before_anything_is_written(place: Path, status: int) -> None:
    """53 is asked at first, before each pass, and once more before the first page goes out."""
    bench = Bench(OLD)
    at_call(bench.device, STATUS, status, larger(bench.device))
    with pytest.raises(DataError, match=FOUND[status]) as caught:
        put(bench, place)
    assert caught.value.exit_code == 5
    assert caught.value.hint
    assert bench.tap.pages_written == []


def test_a_ladder_size_that_changes_while_it_is_written(place: Path) -> None:
    """The first pages of a larger ladder read back as they should; 53 is asked behind them."""
    bench = Bench(OLD)
    at_call(bench.device, WRITE, PAGES, larger(bench.device))
    with pytest.raises(RestoreIncomplete) as caught:
        put(bench, place)
    assert f"ladder size is {WORDS + 64} words now, and was {WORDS} before" in caught.value.message


def test_a_ladder_size_that_changes_in_a_backup(place: Path, cli: Cli, door: Door) -> None:
    device = door.simulation.plcs[1]
    at_call(device, STATUS, 2, larger(device))
    done = cli("backup", "x.json", "-p", door.target)
    assert done.code == 5
    assert f"ladder_words {WORDS}, then {WORDS + 64}" in one_line(done.err)
    assert list(place.iterdir()) == []


@pytest.mark.parametrize(("flag", "words"), [("running", "went to RUN"), ("rom_pack", "got a ROM pack")])
def test_a_plc_that_changes_its_state_while_the_question_waits(tmp_path: Path, flag: str, words: str) -> None:
    bench = Bench(OLD)

    def agree(*_: object) -> bool:
        setattr(bench.device, flag, True)
        return True

    with pytest.raises(
        PlcNotReady, match=f"{words} since its program was read: nothing was written"
    ) as caught:
        restore(bench.plc, backup(NEW), tmp_path / "new.json", confirm=agree, safety_folder=tmp_path)
    assert caught.value.exit_code == 4
    assert bench.tap.pages_written == []
    assert bench.pages == OLD.pages
