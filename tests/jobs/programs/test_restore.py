"""A restore that is allowed, or refused before anything is written."""

from __future__ import annotations

from pathlib import Path
from typing import TYPE_CHECKING

import pytest

from fatektool.errors import (
    DataError,
    FatektoolError,
    LineError,
    PlcError,
    PlcNotReady,
    PlcRefused,
    UsageError,
)
from fatektool.jobs.programs.restore import RestoreOptions, RestorePlan, RestoreResult, plan_restore, restore
from fatektool.program.archive import load_backup
from tests.program.samples import backup, changed, header, program
from tests.rigs import READ_PAGE, RUN_STOP, WRITE_PAGE, Bench, Seen

if TYPE_CHECKING:
    from fatektool.program.image import Program

PAGES = 8
OLD, NEW = program(400, seed=1), program(400, seed=2)


def put(bench: Bench, wanted: Program, folder: Path | None, **options: bool) -> RestoreResult:
    """Restore, always agreed to."""
    return restore(
        bench.plc,
        backup(wanted),
        (folder or Path("nowhere")) / "press.json",
        confirm=lambda plan, kept: True,  # noqa: ARG005
        options=RestoreOptions(**options),
        safety_folder=folder,
        save_previous=folder is not None,
    )


# --- what goes well -------------------------------------------------------------------------------------


def test_all_pages_are_written_in_order_and_read_back(tmp_path: Path) -> None:
    bench = Bench(OLD)
    result = put(bench, NEW, tmp_path)
    assert bench.pages == NEW.pages
    assert bench.tap.pages_written == list(range(PAGES))
    assert bench.tap.count[READ_PAGE] == 3 * PAGES  # twice before, once after
    (safety,) = tmp_path.iterdir()
    assert result == RestoreResult(PAGES, 1, verified=True, safety_backup=str(safety), mode_before="stop",
                                   mode_after="stop", warnings=())  # fmt: skip
    assert load_backup(safety).program == OLD
    assert safety.name.startswith("press.safety-st01-")


@pytest.mark.parametrize("pages", [(0,), (3,), (7,), (1, 2, 6)])
def test_changed_only_writes_exactly_the_pages_that_differ(tmp_path: Path, pages: tuple[int, ...]) -> None:
    wanted = changed(OLD, *pages)
    bench = Bench(OLD)
    result = put(bench, wanted, tmp_path, changed_only=True)
    assert bench.pages == wanted.pages
    assert bench.tap.pages_written == list(pages)
    assert (result.pages_written, result.pages_equal) == (len(pages), PAGES - len(pages))


def test_equal_already_writes_nothing_and_asks_nothing(tmp_path: Path) -> None:
    bench = Bench(OLD)
    result = restore(
        bench.plc,
        backup(OLD),
        tmp_path / "x",
        confirm=lambda *_: pytest.fail("asked"),
        safety_folder=tmp_path,
    )
    assert (result.pages_written, result.pages_equal, result.verified) == (0, PAGES, True)
    assert result.safety_backup is None
    assert WRITE_PAGE not in bench.tap.count
    assert list(tmp_path.iterdir()) == []


def test_equal_already_and_running_goes_on_running(tmp_path: Path) -> None:
    bench = Bench(OLD)
    bench.device.running = True
    result = put(bench, OLD, tmp_path, stop=True)
    assert (result.mode_before, result.mode_after) == ("run", "run")
    assert RUN_STOP not in bench.tap.count


def test_a_running_plc_is_stopped_and_runs_again(tmp_path: Path) -> None:
    bench = Bench(OLD)
    bench.device.running = True
    result = put(bench, NEW, tmp_path, stop=True, run=True)
    assert bench.pages == NEW.pages
    assert bench.device.running
    assert (result.mode_before, result.mode_after) == ("run", "run")


def test_a_stopped_plc_stays_stopped_unless_run_is_asked_for(tmp_path: Path) -> None:
    bench = Bench(OLD)
    bench.device.running = True
    assert put(bench, NEW, tmp_path, stop=True).mode_after == "stop"
    assert not bench.device.running


def test_one_pass_over_the_old_program(tmp_path: Path) -> None:
    bench = Bench(OLD)
    put(bench, NEW, tmp_path, single_pass=True)
    assert bench.tap.count[READ_PAGE] == 2 * PAGES


def test_no_safety_backup() -> None:
    bench = Bench(OLD)
    result = put(bench, NEW, None)
    assert result.safety_backup is None
    assert bench.pages == NEW.pages


def test_the_old_program_is_on_disk_before_the_first_page_is_written(tmp_path: Path) -> None:
    bench = Bench(OLD)
    seen_then: list[Program] = []

    def look(seen: Seen) -> None:
        if (seen.command, seen.number) in {(WRITE_PAGE, 1), (RUN_STOP, 1)}:
            seen_then.extend(load_backup(path).program for path in tmp_path.iterdir())

    bench.device.running = True
    bench.tap.before = look
    put(bench, NEW, tmp_path, stop=True)
    assert seen_then == [OLD, OLD]


def test_a_restore_that_is_not_agreed_to_changes_nothing(tmp_path: Path) -> None:
    bench = Bench(OLD)
    bench.device.running = True
    shown: list[tuple[RestorePlan, Path | None]] = []

    def no(plan: RestorePlan, kept: Path | None) -> bool:
        shown.append((plan, kept))
        assert kept is not None
        assert load_backup(kept).program == OLD
        return False

    with pytest.raises(UsageError, match=r"Aborted\. Nothing was written\."):
        restore(bench.plc, backup(NEW), tmp_path / "x.json", confirm=no, options=RestoreOptions(stop=True),
                safety_folder=tmp_path)  # fmt: skip
    ((plan, _),) = shown
    assert plan.pages == tuple(range(PAGES))
    assert not list(tmp_path.iterdir())  # nothing needs a way back
    assert bench.pages == OLD.pages
    assert bench.device.running


def test_an_id_is_worth_a_warning(tmp_path: Path) -> None:
    bench = Bench(OLD)
    bench.device.id_set = True
    (warning,) = put(bench, NEW, tmp_path).warnings
    assert "another ID loads, but will not RUN (error 6)" in warning


# --- what is refused ------------------------------------------------------------------------------------


def refused(bench: Bench, wanted: Program, folder: Path, **options: bool) -> FatektoolError:
    running = bench.device.running
    with pytest.raises(FatektoolError) as caught:
        put(bench, wanted, folder, **options)
    assert WRITE_PAGE not in bench.tap.count
    assert RUN_STOP not in bench.tap.count
    assert bench.device.running == running
    assert list(folder.iterdir()) == []
    return caught.value


@pytest.mark.parametrize("words", [399, 401, 500, 13184])
def test_another_ladder_size(tmp_path: Path, words: int) -> None:
    error = refused(Bench(OLD), program(words), tmp_path)
    assert isinstance(error, DataError)
    assert f"expected a ladder size of 400 words, got {words} in the file" in error.message
    assert error.details == {"plc_ladder_words": 400, "file_ladder_words": words}


@pytest.mark.parametrize("options", [{}, {"stop": True}])
def test_a_rom_pack(tmp_path: Path, options: dict[str, bool]) -> None:
    bench = Bench(OLD)
    bench.device.rom_pack = bench.device.running = True
    error = refused(bench, NEW, tmp_path, **options)
    assert isinstance(error, PlcNotReady)
    assert "take the ROM pack out" in str(error)
    assert READ_PAGE not in bench.tap.count


def test_a_running_plc_that_may_not_be_stopped(tmp_path: Path) -> None:
    bench = Bench(OLD)
    bench.device.running = True
    error = refused(bench, NEW, tmp_path)
    assert isinstance(error, PlcNotReady)
    assert str(error).endswith(
        "expected STOP before its program is written; make the machine safe, then add --stop"
    )


def test_a_header_that_does_not_hold(tmp_path: Path) -> None:
    wanted = program(400, page0=header(400, b"XB30"))
    bench = Bench(OLD)
    error = refused(bench, wanted, tmp_path)
    assert isinstance(error, DataError)
    assert "byte 0: expected F" in error.message
    assert "--any-header" in str(error)
    assert bench.tap.count == {}  # the line is not used for it
    put(bench, wanted, tmp_path, any_header=True)
    assert bench.pages == wanted.pages


def test_a_plc_that_keeps_its_program_to_itself(tmp_path: Path) -> None:
    error = refused(Bench(OLD, program_commands=False), NEW, tmp_path)
    assert isinstance(error, PlcRefused)
    assert "the engineer's project file" in str(error)


def test_a_safety_backup_that_cannot_be_written(tmp_path: Path) -> None:
    bench = Bench(OLD)
    with pytest.raises(UsageError, match="not a folder"):
        restore(bench.plc, backup(NEW), tmp_path / "x", confirm=lambda *_: True,
                safety_folder=tmp_path / "missing")  # fmt: skip
    assert bench.pages == OLD.pages


def test_a_plan_changes_nothing() -> None:
    bench = Bench(OLD)
    plan = plan_restore(bench.plc, backup(changed(OLD, 4)), RestoreOptions(changed_only=True))
    assert plan.pages == (4,)
    assert plan.comparison.page_numbers == [4]
    assert plan.present.program == OLD
    assert set(bench.tap.count) <= {"40", "4E", "4F", "53"}


# --- RUN after it ---------------------------------------------------------------------------------------


@pytest.mark.parametrize(
    ("flag", "code"),
    [
        ("ladder_checksum_error", "5"),
        ("id_differs", "6"),
        ("syntax_error", "7"),
        ("unsupported_instruction", "9"),
    ],
)
def test_run_is_refused_after_the_restore(tmp_path: Path, flag: str, code: str) -> None:
    bench = Bench(OLD)
    setattr(bench.device, flag, True)
    with pytest.raises(PlcError) as caught:
        put(bench, NEW, tmp_path, run=True)
    error = caught.value
    assert error.exit_code == 4
    assert error.message.startswith(
        "the program of FILE is in the PLC, read back and verified, but the PLC does not RUN: the PLC refused"
    )
    assert f"error {code}, cannot run" in error.message
    assert error.hint
    assert error.details["code"] == code
    assert bench.pages == NEW.pages
    assert not bench.device.running


def test_no_answer_to_run_after_the_restore(tmp_path: Path) -> None:
    bench = Bench(OLD)

    def cut(seen: Seen) -> None:
        if seen.command == RUN_STOP:
            bench.tap.forge = lambda _seen, _answer: b"\0"

    bench.tap.before = cut
    with pytest.raises(
        LineError, match="read back and verified, but whether it runs is not known: no answer"
    ):
        put(bench, NEW, tmp_path, run=True)
    assert bench.pages == NEW.pages
