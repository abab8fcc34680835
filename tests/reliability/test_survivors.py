"""What mutants of the code lived in unseen: second chances that fail, limits, what an error carries."""

from __future__ import annotations

import errno
from pathlib import Path
from typing import TYPE_CHECKING, Any

import pytest

from fatektool.errors import DataError, FatektoolError, LineError, RestoreIncomplete, UsageError
from fatektool.files.atomic import file_error, read_bounded, require_folder, require_place
from fatektool.jobs.programs.backup import backup
from fatektool.jobs.programs.known import KnownPages
from fatektool.jobs.programs.reading import MOST_PASSES
from fatektool.jobs.programs.restore import RestoreOptions, RestoreResult, restore
from fatektool.jobs.programs.safety import find_safety_backup, save_safety_backup
from fatektool.program.archive import Backup, load_backup, save_backup
from fatektool.program.headers.families import read_header
from fatektool.program.image import Program
from fatektool.program.plc_record import fault_of
from tests.program.samples import backup as backup_of
from tests.program.samples import changed, document, file_of, header, plc_record, program
from tests.rigs import READ_PAGE, WRITE_PAGE, Bench, Seen, framed

if TYPE_CHECKING:
    from collections.abc import Callable

PAGES = 8
OLD, NEW = program(400, seed=1), program(400, seed=2)


def put(bench: Bench, folder: Path, **options: bool) -> RestoreResult:
    return restore(
        bench.plc,
        backup_of(NEW),
        folder / "press.json",
        confirm=lambda plan, kept: True,  # noqa: ARG005
        options=RestoreOptions(**options),
        safety_folder=folder,
    )


def unfinished(bench: Bench, folder: Path, **options: bool) -> RestoreIncomplete:
    with pytest.raises(RestoreIncomplete) as caught:
        put(bench, folder, **options)
    return caught.value


def lying(bench: Bench, *pages: int, until: int = PAGES) -> Callable[[Seen], None]:
    """Acknowledge the first writes of these pages and make none of them."""

    def lie(seen: Seen) -> None:
        bench.device.acknowledge_only = seen.page in pages and seen.number <= until

    return lie


# --- what a PLC holds when a second chance fails ------------------------------------------------------------


def test_a_plc_that_stores_something_else_is_not_called_unchanged(tmp_path: Path) -> None:
    """Not one page is new, and the old program is gone all the same."""
    bench = Bench(OLD)

    def garble(seen: Seen) -> None:
        if seen.command == WRITE_PAGE and seen.page is not None:
            bench.device.pages[seen.page] = bytes(128)

    bench.tap.after = garble
    error = unfinished(bench, tmp_path)
    assert "acknowledged page 0-7, but has other data there" in error.message
    assert "page 0-7: uncertain" in error.message
    assert error.details["pages_uncertain"] == list(range(PAGES))


def test_a_page_whose_second_write_is_refused_is_what_it_was(tmp_path: Path) -> None:
    bench = Bench(OLD)
    lie = lying(bench, 4, 6)

    def lie_and_refuse(seen: Seen) -> None:
        lie(seen)
        bench.device.rom_pack = seen.number > PAGES and seen.command == WRITE_PAGE

    bench.tap.before = lie_and_refuse
    error = unfinished(bench, tmp_path)
    assert error.details["pages_old"] == [4, 6]
    assert error.details["pages_uncertain"] == error.details["pages_unread"] == []
    assert "page 0-3, 5, 7: the new program; page 4, 6: the previous program; " in error.message
    assert [page for page in range(PAGES) if bench.pages[page] != NEW.pages[page]] == [4, 6]


def test_a_foreign_page_whose_second_write_is_refused_stays_uncertain(tmp_path: Path) -> None:
    bench = Bench(OLD)

    def garble(seen: Seen) -> None:
        if (seen.command, seen.page, seen.number) == (WRITE_PAGE, 4, 5):
            bench.device.pages[4] = bytes(128)

    def refuse(seen: Seen) -> None:
        bench.device.rom_pack = seen.number > PAGES and seen.command == WRITE_PAGE

    bench.tap.after, bench.tap.before = garble, refuse
    error = unfinished(bench, tmp_path)
    assert error.details["pages_uncertain"] == [4]
    assert "page 4: uncertain" in error.message


def test_a_page_that_was_written_again_and_not_read_back_is_called_so(tmp_path: Path) -> None:
    bench = Bench(OLD)
    lie = lying(bench, 5)

    def cut(seen: Seen) -> None:
        lie(seen)
        if seen.command == READ_PAGE and seen.number > 3 * PAGES:
            raise KeyboardInterrupt

    bench.tap.before = cut
    error = unfinished(bench, tmp_path)
    assert error.details["pages_written"] == list(range(PAGES))
    assert error.details["pages_unread"] == [5]
    assert "(interrupted): page 0-4, 6-7: the new program; page 5: written but not read back" in str(error)


def test_acknowledged_pages_are_not_called_new_before_they_are_read(tmp_path: Path) -> None:
    bench = Bench(OLD, faults=("power-cut=6",))
    bench.tap.before = lying(bench, 2)
    error = unfinished(bench, tmp_path)
    assert error.details["pages_written"] == error.details["pages_unread"] == [0, 1, 2, 3, 4]
    assert bench.pages[2] == OLD.pages[2]
    assert "the new program" not in error.message
    assert (
        "page 0-4: written but not read back; page 5: uncertain; page 6-7: the previous program"
        in error.message
    )


def test_what_was_rolled_back_says_what_to_do_about_the_cause(tmp_path: Path) -> None:
    bench = Bench(OLD)
    bench.tap.before = lying(bench, 3, until=2 * PAGES)
    with pytest.raises(FatektoolError, match="rolled back") as caught:
        put(bench, tmp_path, rollback=True)
    assert bench.pages == OLD.pages
    assert caught.value.hint == "the PLC's program memory may be worn out or protected"
    assert caught.value.details["rolled_back"] is True


# --- passes -----------------------------------------------------------------------------------------------


def unsteady(bench: Bench, agree_from: int, noisy: set[int]) -> None:
    """Each pass reads another page 7 until ``agree_from``; in noisy passes a byte of noise comes too."""

    def forge(seen: Seen, answer: bytes) -> bytes:
        if seen.command != READ_PAGE or seen.page != PAGES - 1:
            return answer
        number = min(seen.passes, agree_from)
        forged = framed(b"014F0" + b"%02X" % number * 128) if number < agree_from else answer
        return b"\xff" * (seen.passes in noisy) + forged

    bench.tap.forge = forge


def test_the_last_pass_that_may_be_needed_is_read() -> None:
    bench = Bench(OLD)
    unsteady(bench, MOST_PASSES - 1, set(range(1, MOST_PASSES + 1)))
    found = backup(bench.plc)
    assert found.passes == MOST_PASSES
    assert found.program == OLD


def test_and_not_one_more() -> None:
    bench = Bench(OLD)
    unsteady(bench, MOST_PASSES, set(range(1, MOST_PASSES + 2)))
    with pytest.raises(LineError, match=f"no two of {MOST_PASSES} passes"):
        backup(bench.plc)


def unsteady_page(bench: Bench, page: int, agree_from: int) -> None:
    """Each reading of many pages finds another page until ``agree_from``; a byte of noise comes with it."""
    readings = 0
    read_pages = bench.plc.read_pages

    def counted(*words: Any, **named: Any) -> list[bytes]:
        nonlocal readings
        readings += 1
        return read_pages(*words, **named)

    def forge(seen: Seen, answer: bytes) -> bytes:
        if (seen.command, seen.page) != (READ_PAGE, page):
            return answer
        return b"\xff" + (framed(b"014F0" + b"%02X" % readings * 128) if readings < agree_from else answer)

    bench.tap.forge = forge
    bench.plc.read_pages = counted  # type: ignore[method-assign]  # to count them


@pytest.mark.parametrize("agree_from", [MOST_PASSES - 1, MOST_PASSES])
def test_a_page_that_is_not_as_on_file_is_read_as_many_times(agree_from: int) -> None:
    bench = Bench(OLD)
    unsteady_page(bench, 5, agree_from)
    known = KnownPages((changed(OLD, 5),), "press.json")
    if agree_from < MOST_PASSES:
        assert backup(bench.plc, known=known).program == OLD
        return
    with pytest.raises(LineError, match=f"no two of {MOST_PASSES} readings of page 5 agree"):
        backup(bench.plc, known=known)


def test_trouble_in_an_earlier_pass_does_not_excuse_two_clean_ones_that_differ() -> None:
    bench = Bench(OLD)
    unsteady(bench, 99, {1})
    with pytest.raises(DataError, match="two passes without line errors read different programs: page 7"):
        backup(bench.plc)


# --- the way back -------------------------------------------------------------------------------------------


def test_the_way_back_is_found_behind_newer_files_that_are_none(tmp_path: Path) -> None:
    mine = save_safety_backup(backup_of(OLD), tmp_path / "press.json", tmp_path)
    (tmp_path / "press.safety-st01-20991231T235959Z.json").write_text("{")
    save_backup(backup_of(program(500)), tmp_path / "press.safety-st01-20991230T000000Z.json")
    half = Program(400, (*NEW.pages[:3], *OLD.pages[3:]))
    save_backup(backup_of(half), tmp_path / "press.safety-st01-20991229T000000Z.json")
    found = find_safety_backup(half, NEW, 1, tmp_path / "press.json", tmp_path)
    assert found == mine


# --- limits and what an error carries ---------------------------------------------------------------------


@pytest.mark.parametrize(("passes", "taken"), [(0, False), (1, True), (1000, True), (1001, False)])
def test_the_number_of_passes(passes: int, taken: bool) -> None:
    data = file_of(document(OLD) | {"passes": passes})
    if taken:
        assert Backup.parse(data).passes == passes
        return
    with pytest.raises(DataError, match=f"passes: expected a whole number of 1 to 1000, got {passes}"):
        Backup.parse(data)


@pytest.mark.parametrize(("count", "taken"), [(-1, False), (0, True), (65535, True), (65536, False)])
def test_a_count_of_the_plc_record(count: int, taken: bool) -> None:
    record = plc_record(400)
    record["system"]["timers"] = count
    expected = ("plc.system.timers: expected a whole number of 0 to 65535", count)
    assert fault_of(record) == (None if taken else expected)


@pytest.mark.parametrize(("part", "got"), [({"b": 1, "a": 2}, ["a", "b"]), ("text", "text"), (None, None)])
def test_what_stands_there_instead_of_a_plc_record_is_told(part: object, got: object) -> None:
    assert fault_of(part) == ("plc: expected an object of status, system", got)


@pytest.mark.parametrize(
    ("start", "signature"),
    [(b"FB3!", "FB3!"), (b"FB3~", "FB3~"), (b"FB3 ", None), (b"FB3\x7f", None), (b"FB3\x80", None)],
)
def test_a_signature_is_of_characters_that_can_be_seen(start: bytes, signature: str | None) -> None:
    assert read_header([header(400, start)], 400).signature == signature


@pytest.mark.parametrize(
    ("start", "words"), [(b"FB3!", "! (21)"), (b"FB3~", "~ (7E)"), (b"FB3 ", "20"), (b"FB3\x7f", "7F")]
)
def test_a_byte_is_shown_as_a_character_if_it_is_one(start: bytes, words: str) -> None:
    assert read_header([header(400, start)], 400).faults == (f"byte 3: expected a digit, got {words}",)


def test_a_file_of_just_the_limit(tmp_path: Path) -> None:
    path = tmp_path / "x"
    path.write_bytes(b"12345")
    assert read_bounded(path, 5) == b"12345"
    with pytest.raises(DataError, match="expected at most 4 bytes, got more"):
        read_bounded(path, 4)


ERRORS: dict[str, tuple[Callable[[Path], Any], type[FatektoolError], str]] = {
    "a folder": (lambda path: require_place(path.parent, overwrite=True), UsageError, ""),
    "no folder": (lambda path: require_folder(path / "none"), UsageError, "none"),
    "kept": (lambda path: require_place(path, overwrite=False), UsageError, "x"),
    "too long": (lambda path: read_bounded(path, 1), DataError, "x"),
    "missing": (lambda path: load_backup(path.parent / "y"), UsageError, "y"),
    "damaged": (load_backup, DataError, "x"),
}


@pytest.mark.parametrize("name", ERRORS)
def test_an_error_of_a_file_names_the_file_for_scripts_and_people(name: str, tmp_path: Path) -> None:
    act, kind, last = ERRORS[name]
    path = tmp_path / "x"
    path.write_bytes(b"12345")
    with pytest.raises(kind) as caught:
        act(path)
    assert Path(caught.value.details["file"]).name == last or last == ""
    assert caught.value.details["file"] in caught.value.message


@pytest.mark.parametrize(
    ("number", "kind", "hint"),
    [
        (errno.ENOSPC, DataError, "free some space and run it again; the file is unchanged"),
        (errno.EDQUOT, DataError, "free some space and run it again; the file is unchanged"),
        (errno.EFBIG, DataError, "free some space and run it again; the file is unchanged"),
        (errno.EIO, DataError, "check the disk"),
        (errno.EACCES, UsageError, "check the name and the permissions"),
    ],
)
def test_what_a_file_system_says(number: int, kind: type[FatektoolError], hint: str) -> None:
    error = file_error("write", Path("/a/b"), OSError(number, "words of the system"))
    assert type(error) is kind
    assert error.message == "cannot write /a/b: words of the system"
    assert error.hint == hint
    assert error.details == {"file": "/a/b"}
