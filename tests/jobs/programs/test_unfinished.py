"""A restore that does not come to its end: what it says, what the PLC holds, how it is finished."""

from __future__ import annotations

import errno
from pathlib import Path
from typing import TYPE_CHECKING

import pytest

from fatektool.errors import (
    DataError,
    FatektoolError,
    LineError,
    PlcError,
    RestoreIncomplete,
    UsageError,
)
from fatektool.jobs.programs.restore import RestoreOptions, RestoreResult, restore
from fatektool.program.archive import load_backup
from fatektool.simulator.refusal import Refusal
from tests.night import seeds
from tests.program.samples import backup, changed, program
from tests.rigs import READ_PAGE, RUN_STOP, WRITE_PAGE, Bench, Seen

if TYPE_CHECKING:
    from fatektool.jobs.progress import Progress
    from fatektool.program.image import Program

PAGES = 8
OLD, NEW = program(400, seed=1), program(400, seed=2)


def put(
    bench: Bench,
    folder: Path,
    *,
    wanted: Program = NEW,
    safety: bool = True,
    earlier: str | None = None,
    progress: Progress = lambda phase, done, total: None,  # noqa: ARG005
    **options: bool,
) -> RestoreResult:
    return restore(
        bench.plc,
        backup(wanted),
        folder / "press.json",
        confirm=lambda plan, kept: True,  # noqa: ARG005
        options=RestoreOptions(**options),
        save_previous=safety,
        earlier=earlier,
        progress=progress,
    )


def told_right(error: RestoreIncomplete, bench: Bench, wanted: Program = NEW) -> None:
    """What the error says of the pages is what the PLC holds, and of the way back what lies there."""
    if error.details["safety_backup"] is not None:
        assert load_backup(Path(error.details["safety_backup"])).program == OLD
    new, old, uncertain = (error.details[f"pages_{state}"] for state in ("written", "old", "uncertain"))
    for page in new:
        assert bench.pages[page] == wanted.pages[page], page
    for page in old:
        assert bench.pages[page] == OLD.pages[page], page
    assert len({*new, *old, *uncertain}) == len(new) + len(old) + len(uncertain)
    for page in {*range(PAGES)} - {*new, *old, *uncertain}:
        assert bench.pages[page] == wanted.pages[page], page


def finish(bench: Bench, folder: Path, error: RestoreIncomplete, *, written: list[int] | None = None) -> None:
    """The same restore again, for the pages that are left; its way back is the one of the first run."""
    original = error.details["safety_backup"]
    assert load_backup(folder / original).program == OLD
    bench.client()
    bench.device.rom_pack = False
    result = put(bench, folder, changed_only=True, earlier=str(folder / original))
    assert bench.pages == NEW.pages
    assert result.verified
    if result.safety_backup is not None:
        assert load_backup(folder / result.safety_backup).program == OLD
    if written is not None:
        assert bench.tap.pages_written == written


# --- the power goes -------------------------------------------------------------------------------------


@pytest.mark.parametrize("write", range(1, PAGES + 1))
def test_the_power_goes_at_any_page(tmp_path: Path, write: int) -> None:
    bench = Bench(OLD, faults=(f"power-cut={write}",))
    with pytest.raises(RestoreIncomplete) as caught:
        put(bench, tmp_path)
    error = caught.value
    page = write - 1
    assert error.exit_code == 6
    assert error.details["pages_written"] == list(range(page))
    assert error.details["pages_uncertain"] == [page]
    assert error.details["pages_old"] == list(range(page + 1, PAGES))
    assert error.details["mode"] is None
    told_right(error, bench)
    saved = f"previous program saved in {error.details['safety_backup']}"
    uncertain = f"page {page}: uncertain"
    again = "run the same command again"
    for part in (
        "the restore did not complete (no answer",
        uncertain,
        saved,
        "the PLC's mode is not known: do not switch it to RUN; STOP it if it runs",
        again,
    ):
        assert part in str(error)

    bench.simulation.power_on()
    finish(bench, tmp_path, error, written=list(range(max(page, 1), PAGES)))
    assert [load_backup(path).program for path in tmp_path.iterdir()] == [OLD]


def restart_at(bench: Bench, write: int, *, running: bool, made: bool) -> list[bool]:
    """At a write of a page the PLC restarts, without an answer. Gives its mode at each later write."""
    modes: list[bool] = []

    def forge(seen: Seen, answer: bytes) -> bytes:
        if seen.command == WRITE_PAGE and seen.number == write:
            bench.device.running = running
            if not made and seen.page is not None:
                bench.device.pages[seen.page] = OLD.pages[seen.page]
            return b""
        return answer

    def note(seen: Seen) -> None:
        if seen.command == WRITE_PAGE and seen.number > write:
            modes.append(bench.device.running)

    bench.tap.forge, bench.tap.before = forge, note
    return modes


@pytest.mark.parametrize("made", [True, False])
@pytest.mark.parametrize("write", range(1, PAGES + 1))
def test_a_plc_that_restarts_in_run_is_stopped_again(tmp_path: Path, write: int, *, made: bool) -> None:
    bench = Bench(OLD)
    bench.device.running = True
    modes = restart_at(bench, write, running=True, made=made)
    result = put(bench, tmp_path, stop=True)
    assert bench.pages == NEW.pages
    assert not bench.device.running
    assert (result.mode_before, result.mode_after) == ("run", "stop")
    assert not any(
        modes[(not made) :]
    )  # a page whose write was lost is sent once more before its mode is read
    warning = "the PLC went to RUN while its program was written, as after a restart: it was stopped again"
    assert result.warnings == (warning,)


@pytest.mark.parametrize("write", range(2, PAGES + 1))
def test_a_plc_in_stop_that_restarts_in_run_is_not_written_further(tmp_path: Path, write: int) -> None:
    bench = Bench(OLD)
    modes = restart_at(bench, write, running=True, made=True)
    with pytest.raises(RestoreIncomplete) as caught:
        put(bench, tmp_path)
    assert bench.device.running
    assert not modes
    assert caught.value.details["mode"] == "run"
    assert caught.value.details["cause"] == "the PLC went to RUN while its program was written"
    assert "the PLC's mode is RUN: STOP it, its program is incomplete" in caught.value.message
    told_right(caught.value, bench)
    bench.device.running = False
    finish(bench, tmp_path, caught.value)


def test_a_plc_that_restarts_in_stop_is_written_to_the_end(tmp_path: Path) -> None:
    bench = Bench(OLD)
    restart_at(bench, 4, running=False, made=False)
    result = put(bench, tmp_path)
    assert bench.pages == NEW.pages
    assert (result.mode_after, result.warnings) == ("stop", ())


@pytest.mark.parametrize("stop", [True, False])
def test_a_plc_that_goes_to_run_after_the_last_page(tmp_path: Path, *, stop: bool) -> None:
    bench = Bench(OLD)
    bench.device.running = stop

    def switch(seen: Seen) -> None:
        if (seen.command, seen.number) == (WRITE_PAGE, PAGES):
            bench.device.running = True

    bench.tap.after = switch
    result = put(bench, tmp_path, stop=stop)
    assert bench.pages == NEW.pages
    assert bench.device.running is not stop
    assert result.mode_after == ("stop" if stop else "run")
    assert result.warnings[0].endswith("it was stopped again" if stop else "it is in RUN now")


@pytest.mark.parametrize("rollback", [True, False])
def test_a_plc_that_is_silent_to_every_write_holds_its_previous_program(
    tmp_path: Path, *, rollback: bool
) -> None:
    """As an FBs may be, whose protocol has no 50: it answers everything else, so what it holds is known."""
    bench = Bench(OLD)

    def ignore(seen: Seen) -> None:
        if seen.command == WRITE_PAGE and seen.page is not None:
            bench.device.pages[seen.page] = OLD.pages[seen.page]

    bench.tap.after = ignore
    bench.tap.forge = lambda seen, answer: b"" if seen.command == WRITE_PAGE else answer
    with pytest.raises(
        LineError, match="nothing was changed, the PLC holds its previous program and is in STOP"
    ):
        put(bench, tmp_path, rollback=rollback)
    assert bench.pages == OLD.pages


def test_the_power_goes_again_and_again(tmp_path: Path) -> None:
    """Page by page, with a power cut at each second write, the way back stays the first one's."""
    bench = Bench(OLD)
    cuts, earlier = 0, None

    def cut(seen: Seen) -> None:
        if seen.command == WRITE_PAGE and seen.number == 2:
            bench.tap.forge = lambda _seen, _answer: b""
            raise KeyboardInterrupt

    while bench.pages != NEW.pages:
        bench.tap.before = cut
        try:
            put(bench, tmp_path, changed_only=True, earlier=earlier)
        except RestoreIncomplete as error:
            told_right(error, bench)
            earlier = error.saved
        cuts += 1
        bench.client()
        assert cuts <= PAGES
    assert [load_backup(path).program for path in tmp_path.iterdir()] == [OLD]


def test_without_a_safety_backup_that_is_said(tmp_path: Path) -> None:
    bench = Bench(OLD, faults=("power-cut=4",))
    with pytest.raises(RestoreIncomplete, match="previous program not saved") as caught:
        put(bench, tmp_path, safety=False)
    assert caught.value.details["safety_backup"] is None


def test_a_stop_without_an_answer_may_have_stopped_the_machine(tmp_path: Path) -> None:
    bench = Bench(OLD)
    bench.device.running = True
    bench.tap.forge = lambda _, answer: b"" if bench.tap.count.get(RUN_STOP) else answer
    with pytest.raises(
        LineError, match="it is not known whether the PLC is in RUN or in STOP: nothing was written"
    ):
        put(bench, tmp_path, stop=True)
    assert bench.pages == OLD.pages


def test_ctrl_c_at_stop_may_have_stopped_the_machine(tmp_path: Path) -> None:
    bench = Bench(OLD)
    bench.device.running = True

    def interrupt(seen: Seen) -> None:
        if seen.command == RUN_STOP:
            raise KeyboardInterrupt

    bench.tap.after = interrupt
    with pytest.raises(
        KeyboardInterrupt, match="it is not known whether the PLC is in RUN or in STOP; nothing was written"
    ):
        put(bench, tmp_path, stop=True)
    assert not bench.device.running
    assert not list(tmp_path.iterdir())


# --- Ctrl-C ---------------------------------------------------------------------------------------------


@pytest.mark.parametrize("when", ["before", "after"])
@pytest.mark.parametrize("page", range(PAGES))
def test_ctrl_c_at_any_page(tmp_path: Path, page: int, when: str) -> None:
    bench = Bench(OLD)

    def interrupt(seen: Seen) -> None:
        if (seen.command, seen.page) == (WRITE_PAGE, page):
            raise KeyboardInterrupt

    setattr(bench.tap, when, interrupt)
    changed_pages = page - (when == "before")
    if changed_pages < 1:  # page 0, the header, is the same in both
        with pytest.raises(
            KeyboardInterrupt, match="nothing was changed, the PLC holds its previous program"
        ):
            put(bench, tmp_path)
        assert bench.pages == OLD.pages
        return
    with pytest.raises(RestoreIncomplete, match=r"did not complete \(interrupted\)") as caught:
        put(bench, tmp_path)
    written = page + (when == "after")
    assert caught.value.details["pages_written"] == list(range(written))
    assert caught.value.details["pages_old"] == list(range(written, PAGES))
    assert caught.value.details["pages_uncertain"] == []
    assert caught.value.details["mode"] == "stop"
    told_right(caught.value, bench)
    finish(bench, tmp_path, caught.value)


def test_ctrl_c_before_the_first_page_is_sent(tmp_path: Path) -> None:
    """The PLC holds its previous program: that is no restore that did not complete."""
    bench = Bench(OLD)

    def interrupt(now: str, pages: int, _total: int) -> None:
        if (now, pages) == ("writing", 0):
            raise KeyboardInterrupt

    with pytest.raises(KeyboardInterrupt, match="nothing was changed, the PLC holds its previous program"):
        put(bench, tmp_path, progress=interrupt)
    assert bench.pages == OLD.pages
    assert not list(tmp_path.iterdir())


@pytest.mark.parametrize(
    ("phase", "done"),
    [  # page 0, the header, is the same in both programs: with it alone nothing is changed
        *(("writing", done) for done in range(2, PAGES + 1)),
        *(("reading back", done) for done in range(PAGES + 1)),
    ],
)
def test_ctrl_c_between_two_pages(tmp_path: Path, phase: str, done: int) -> None:
    bench = Bench(OLD)

    def interrupt(now: str, pages: int, _total: int) -> None:
        if (now, pages) == (phase, done):
            raise KeyboardInterrupt

    with pytest.raises(RestoreIncomplete) as caught:
        put(bench, tmp_path, progress=interrupt)
    assert caught.value.details["pages_uncertain"] == []
    assert caught.value.details["pages_written"] == list(range(done if phase == "writing" else PAGES))
    told_right(caught.value, bench)
    finish(bench, tmp_path, caught.value)


@pytest.mark.parametrize("page", [4, PAGES + 4])
def test_ctrl_c_before_anything_is_written(tmp_path: Path, page: int) -> None:
    bench = Bench(OLD)

    def interrupt(now: str, done: int, _total: int) -> None:
        if (now, done) == ("reading", page):
            raise KeyboardInterrupt

    with pytest.raises(KeyboardInterrupt):
        put(bench, tmp_path, progress=interrupt)
    assert bench.pages == OLD.pages


# --- the PLC says no ------------------------------------------------------------------------------------


def lock_from(bench: Bench, *pages: int) -> None:
    """The PLC refuses to have these pages written."""

    def lock(seen: Seen) -> None:
        bench.device.rom_pack = seen.command == WRITE_PAGE and seen.page in pages

    bench.tap.before = lock


@pytest.mark.parametrize("rollback", [False, True])
@pytest.mark.parametrize("wanted", [NEW, changed(OLD, 1, 5)], ids=["all pages", "the header is the same"])
def test_the_first_change_is_refused(tmp_path: Path, wanted: Program, *, rollback: bool) -> None:
    bench = Bench(OLD)
    bench.device.running = True
    lock_from(bench, *range(1, PAGES))
    with pytest.raises(PlcError) as caught:
        put(bench, tmp_path, wanted=wanted, stop=True, rollback=rollback)
    error = caught.value
    assert error.exit_code == 4
    assert "the PLC refused to write program page 1 (50): error 3" in error.message
    assert error.message.endswith("nothing was changed, the PLC holds its previous program and is in STOP")
    assert "ROM pack" in str(error.hint)
    assert error.details["code"] == "3"
    assert bench.pages == OLD.pages
    assert not bench.device.running


@pytest.mark.parametrize("page", range(2, PAGES))
def test_a_later_page_is_refused(tmp_path: Path, page: int) -> None:
    bench = Bench(OLD)
    lock_from(bench, page)
    with pytest.raises(RestoreIncomplete) as caught:
        put(bench, tmp_path)
    assert "refused to write program page" in caught.value.details["cause"]
    assert caught.value.details["pages_uncertain"] == []
    assert caught.value.details["pages_old"] == list(range(page, PAGES))
    told_right(caught.value, bench)
    finish(bench, tmp_path, caught.value, written=list(range(page, PAGES)))


@pytest.mark.parametrize("code", [0x2, 0xA])
def test_pages_past_the_end_that_are_refused_and_equal_are_left(tmp_path: Path, code: int) -> None:
    """A PLC that answers reads past its end, but takes no writes there."""
    bench = Bench(OLD)
    wanted = changed(OLD, 2, 5)
    refuse_from(bench, 6, code)
    result = put(bench, tmp_path, wanted=wanted)
    assert bench.pages == wanted.pages
    assert (result.pages_written, result.verified) == (6, True)
    assert result.warnings == ("the PLC refused page 6-7, which it has as on file already",)


@pytest.mark.parametrize(("code", "page"), [(0xA, 5), (0x4, 6), (0x3, 6)])
def test_a_refused_page_that_differs_or_is_not_past_the_end_is_an_error(
    tmp_path: Path, code: int, page: int
) -> None:
    bench = Bench(OLD)
    refuse_from(bench, page, code)
    with pytest.raises(RestoreIncomplete, match=f"refused to write program page {page} ") as caught:
        put(bench, tmp_path, wanted=changed(OLD, 2, 5))
    assert caught.value.details["pages_written"] == list(range(page))


def refuse_from(bench: Bench, first: int, code: int) -> None:
    """The PLC refuses to have the pages from ``first`` on written."""
    write = bench.device.write_page

    def write_page(page: int, content: bytes) -> None:
        if page >= first:
            raise Refusal(code)
        write(page, content)

    bench.device.write_page = write_page  # type: ignore[method-assign]


# --- rollback -------------------------------------------------------------------------------------------


def test_rollback_after_a_refusal(tmp_path: Path) -> None:
    bench = Bench(OLD)
    lock_from(bench, 5)
    with pytest.raises(PlcError) as caught:
        put(bench, tmp_path, rollback=True)
    error = caught.value
    assert error.exit_code == 4
    assert "refused to write program page 5" in error.message
    back = "; rolled back: the PLC holds its previous program and is in STOP, read back and verified"
    assert back in str(error)
    assert error.details["rolled_back"] is True
    assert bench.pages == OLD.pages
    assert bench.tap.pages_written == [0, 1, 2, 3, 4, 5, 0, 1, 2, 3, 4]
    assert load_backup(tmp_path / error.details["safety_backup"]).program == OLD


def test_rollback_after_a_silence(tmp_path: Path) -> None:
    bench = Bench(OLD, faults=("power-cut=4",))

    def power_on(phase: str, _done: int, _total: int) -> None:
        if phase == "rolling back":
            bench.simulation.power_on()

    with pytest.raises(LineError, match=r"no answer.*; rolled back: ") as caught:
        put(bench, tmp_path, rollback=True, progress=power_on)
    assert caught.value.exit_code == 3
    assert bench.pages == OLD.pages


def test_rollback_that_fails_too(tmp_path: Path) -> None:
    bench = Bench(OLD, faults=("power-cut=4",))
    with pytest.raises(RestoreIncomplete, match="; and rolling back failed: no answer") as caught:
        put(bench, tmp_path, rollback=True)
    assert caught.value.details["pages_uncertain"] == [0, 3]
    assert caught.value.details["pages_written"] == [1, 2]
    told_right(caught.value, bench)
    bench.simulation.power_on()
    finish(bench, tmp_path, caught.value)


def test_ctrl_c_while_rolling_back(tmp_path: Path) -> None:
    bench = Bench(OLD)
    lock_from(bench, 5)

    def interrupt(phase: str, done: int, _total: int) -> None:
        if (phase, done) == ("rolling back", 2):
            raise KeyboardInterrupt

    with pytest.raises(RestoreIncomplete, match="and rolling back failed: interrupted") as caught:
        put(bench, tmp_path, rollback=True, progress=interrupt)
    assert caught.value.details["pages_written"] == [2, 3, 4]
    told_right(caught.value, bench)
    finish(bench, tmp_path, caught.value)


# --- lies and other surprises ---------------------------------------------------------------------------


def test_a_plc_that_acknowledges_and_writes_nothing(tmp_path: Path) -> None:
    bench = Bench(OLD, faults=("lying-write=1",))
    with pytest.raises(PlcError, match="acknowledged page 1-7, but has other data there") as caught:
        put(bench, tmp_path)
    assert "nothing was changed, the PLC holds its previous program" in caught.value.message
    assert "worn out or protected" in str(caught.value)
    assert bench.pages == OLD.pages


def test_a_write_that_was_not_made_is_made_again(tmp_path: Path) -> None:
    bench = Bench(OLD)

    def lie(seen: Seen) -> None:
        bench.device.acknowledge_only = seen.page == 4 and seen.number <= PAGES

    bench.tap.before = lie
    assert put(bench, tmp_path).verified
    assert bench.tap.pages_written == [*range(PAGES), 4]
    assert bench.pages == NEW.pages


def test_ctrl_c_between_a_lie_and_its_second_chance(tmp_path: Path) -> None:
    bench = Bench(OLD)

    def lie(seen: Seen) -> None:
        bench.device.acknowledge_only = seen.page in {4, 6}

    def interrupt(phase: str, done: int, _total: int) -> None:
        if (phase, done) == ("writing again", 0):
            raise KeyboardInterrupt

    bench.tap.before = lie
    with pytest.raises(RestoreIncomplete) as caught:
        put(bench, tmp_path, progress=interrupt)
    assert caught.value.details["pages_old"] == [4, 6]
    told_right(caught.value, bench)


def test_a_page_that_holds_neither(tmp_path: Path) -> None:
    bench = Bench(OLD)

    def wear_out(seen: Seen) -> None:
        if (seen.command, seen.page) == (WRITE_PAGE, 4):
            bench.device.pages[4] = bytes(128)

    bench.tap.after = wear_out
    with pytest.raises(RestoreIncomplete, match="acknowledged page 4, but has other data") as caught:
        put(bench, tmp_path)
    assert caught.value.details["pages_uncertain"] == [4]
    told_right(caught.value, bench)


@pytest.mark.parametrize(
    ("error", "cause"),
    [
        (UsageError("cannot write the trace: No space left on device"), "cannot write the trace"),
        (OSError(errno.EIO, "Input/output error"), "a fault of fatektool itself: OSError"),
        (ZeroDivisionError("surprise"), "a fault of fatektool itself: ZeroDivisionError: surprise"),
    ],
)
@pytest.mark.parametrize("rollback", [False, True])
def test_whatever_else_fails_the_plc_is_not_left_without_a_word(
    tmp_path: Path, error: Exception, cause: str, *, rollback: bool
) -> None:
    bench = Bench(OLD)

    def fail(seen: Seen) -> None:
        if (seen.command, seen.number) == (WRITE_PAGE, 5):
            raise error

    bench.tap.before = fail
    with pytest.raises(FatektoolError) as caught:
        put(bench, tmp_path, rollback=rollback)
    assert cause in caught.value.message
    if rollback:
        assert "rolled back: the PLC holds its previous program" in caught.value.message
        assert bench.pages == OLD.pages
        return
    assert isinstance(caught.value, RestoreIncomplete)
    told_right(caught.value, bench)


FAULTS = ["drop", "flip", "truncate", "noise", "duplicate", "late", "slow", "wrong-station", "lying-write"]


@pytest.mark.parametrize("seed", seeds(6, 6))
@pytest.mark.parametrize("p", [0.05, 0.3])
@pytest.mark.parametrize("fault", FAULTS)
def test_over_a_bad_line_it_is_done_or_said_how_far(tmp_path: Path, fault: str, p: float, seed: int) -> None:
    bench = Bench(OLD, faults=(f"{fault}={p}",), seed=seed)
    try:
        result = put(bench, tmp_path)
    except RestoreIncomplete as error:
        told_right(error, bench)
    except (LineError, PlcError, DataError):
        assert bench.pages == OLD.pages
    else:
        assert result.verified
        assert bench.pages == NEW.pages


def test_what_a_restore_asks_of_the_plc_is_as_little_as_can_be(tmp_path: Path) -> None:
    bench = Bench(OLD)
    put(bench, tmp_path, single_pass=True, wanted=changed(OLD, 3), changed_only=True)
    assert bench.tap.count[WRITE_PAGE] == 1
    assert bench.tap.count[READ_PAGE] == 2 * PAGES
    assert RUN_STOP not in bench.tap.count
