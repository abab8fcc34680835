"""Pages on file: what is proven by one reading, what is read again, and what tries to pass for it."""

from __future__ import annotations

import os
from dataclasses import replace
from itertools import pairwise
from typing import TYPE_CHECKING

import pytest
from hypothesis import given
from hypothesis import strategies as st

from fatektool.errors import DataError
from fatektool.jobs.programs.backup import backup
from fatektool.jobs.programs.known import KnownPages, after_an_equal, apart, first_known, neighbours
from fatektool.jobs.programs.restore import RestoreOptions, plan_restore
from fatektool.program.archive import Backup, Proof
from tests.night import seeds
from tests.platforms import posix
from tests.program.samples import backup as backup_of
from tests.program.samples import changed, program
from tests.rigs import DETAILED_STATUS, READ_PAGE, Bench, Seen

if TYPE_CHECKING:
    from collections.abc import Callable
    from pathlib import Path

    from fatektool.program.image import Program

LOOPBACK, BRIEF_STATUS = "4E", "40"
BLANK = b"\xff" * 128


def known(*programs: Program) -> KnownPages:
    return KnownPages(programs, "press.json")


def with_pages(image: Program, pages: dict[int, bytes]) -> Program:
    return replace(image, pages=tuple(pages.get(number, page) for number, page in enumerate(image.pages)))


def requests(bench: Bench) -> dict[str, int]:
    return {command: bench.tap.count.get(command, 0) for command in (READ_PAGE, LOOPBACK, DETAILED_STATUS)}


# --- on the wire --------------------------------------------------------------------------------------


def test_an_unchanged_program_of_207_pages() -> None:
    image = program(13184)
    bench = Bench(image)
    found = backup(bench.plc, known=known(image))
    assert found.program == image
    assert found.proof == Proof("press.json", 207, 0)
    assert found.passes == 1
    assert requests(bench) == {READ_PAGE: 207, LOOPBACK: 1, DETAILED_STATUS: 1}
    assert BRIEF_STATUS not in bench.tap.count
    assert Backup.parse(found.to_bytes()) == found


def test_the_progress_counts_the_pages_that_are_read_again() -> None:
    image = program(1000)
    told: list[tuple[str, int, int]] = []
    bench = Bench(changed(image, 5))
    found = backup(bench.plc, known=known(image), progress=lambda *step: told.append(step))
    again = found.proof.pages_read_twice if found.proof is not None else 0
    assert again > 0
    assert told == [
        *(("reading", done, 17) for done in range(18)),
        *(("reading", 17 + done, 17 + again) for done in range(again + 1)),
    ]
    told.clear()
    backup(Bench(image).plc, known=known(image), progress=lambda *step: told.append(step))
    assert told == [("reading", done, 17) for done in range(18)]


def test_without_anything_on_file_it_is_414() -> None:
    image = program(13184)
    bench = Bench(image)
    found = backup(bench.plc)
    assert found.proof == Proof(None, 0, 207)
    assert requests(bench)[READ_PAGE] == 414


@pytest.mark.parametrize("page", [0, 1, 100, 206])
def test_one_page_changed(page: int) -> None:
    image = program(13184)
    old = with_pages(image, {page: bytes(reversed(image.pages[page]))})
    bench = Bench(image)
    found = backup(bench.plc, known=known(old))
    assert found.program == image
    assert found.proof == Proof("press.json", 206, 1)
    assert requests(bench) == {READ_PAGE: 208, LOOPBACK: 1, DETAILED_STATUS: 2}


def test_a_changed_range_is_read_again_with_the_pages_beside_it() -> None:
    image = program(1000)
    bench = Bench(image)
    found = backup(bench.plc, known=known(with_pages(image, dict.fromkeys(range(5, 9), b"\x55" * 128))))
    assert found.program == image
    assert found.proof == Proof("press.json", len(image.pages) - 6, 6)
    assert requests(bench)[READ_PAGE] == len(image.pages) + 6


def test_a_program_of_which_nothing_is_on_file() -> None:
    image = program(400, seed=1)
    bench = Bench(image)
    found = backup(bench.plc, known=known(program(400, seed=2)))
    assert found.program == image
    assert found.proof is not None
    assert found.proof.pages_read_twice >= 7
    assert requests(bench)[READ_PAGE] == 8 + found.proof.pages_read_twice


def test_a_file_for_another_ladder_size_is_no_help() -> None:
    bench = Bench(program(400))
    found = backup(bench.plc, known=known(program(464)))
    assert found.program == program(400)
    assert found.proof == Proof(None, 0, 8)
    assert found.passes == 2


def test_the_first_program_on_file_is_the_likeliest() -> None:
    """Its size and the order of its pages count; a page of any of them is known."""
    first, second = program(400, seed=1), program(464, seed=2)
    found = known(first, second)
    assert (found.fits(400), found.fits(464)) == (True, False)
    assert sorted(found.order) == [*range(len(first.pages))]
    assert found.has(3, second.pages[3])
    assert not found.has(2, second.pages[3])


def test_blank_pages_are_kept_apart_by_a_short_request() -> None:
    """Most pages of a small program in a large memory: the answer before cannot pass for the next."""
    image = with_pages(program(1000), dict.fromkeys(range(4, 17), BLANK))
    bench = Bench(image)
    found = backup(bench.plc, known=known(image))
    assert found.program == image
    assert found.proof == Proof("press.json", 17, 0)
    assert requests(bench)[READ_PAGE] == 17
    assert bench.tap.count[BRIEF_STATUS] == 13 - 4 - 1


# --- what tries to pass for a page on file ------------------------------------------------------------


def shifted_once(page: int) -> Callable[[Bench], None]:
    """The answer to this page is lost, and the one before it comes once more in its place."""

    def spoil(bench: Bench) -> None:
        last: list[bytes] = []
        done: list[bool] = []

        def forge(seen: Seen, answer: bytes) -> bytes:
            if seen.command == READ_PAGE and seen.page == page and last and not done:
                done.append(True)
                return last[0]
            last[:] = [answer]
            return answer

        bench.tap.forge = forge

    return spoil


@pytest.mark.parametrize("page", range(1, 17))
@pytest.mark.parametrize("blank", [(), range(2, 9), range(2, 17)], ids=["none", "some", "most"])
def test_the_answer_before_once_more_is_not_taken_for_a_page_on_file(page: int, blank: range) -> None:
    """On file it is as its neighbours, in the PLC it has changed, and its answer never comes."""
    old = with_pages(program(1000), dict.fromkeys(blank, BLANK))
    image = with_pages(old, {page: b"\x12\x34" * 64})
    bench = Bench(image)
    shifted_once(page)(bench)
    try:
        found = backup(bench.plc, known=known(old))
    except DataError:  # two readings over a clean line differ
        return
    assert found.program == image


def loaded_while_read(old: Program, new: Program, at: int) -> None:
    """What is kept is one program or the other, never a part of each.

    One case is left, and docs/reliability.md says so: of all changed pages the last alone was read after the
    change. It looks like a program of which one page has changed.
    """
    bench = Bench(old)

    def load(seen: Seen) -> None:
        if seen.command == READ_PAGE and seen.number == at + 1:
            bench.device.pages = list(new.pages)

    bench.tap.before = load
    try:
        found = backup(bench.plc, known=known(old))
    except DataError:
        return
    assert found.proof is not None
    changed_pages = [number for number in range(17) if old.pages[number] != new.pages[number]]
    one_page = at == changed_pages[-1] and found.proof.pages_read_twice == 1
    assert found.program in {old, new} or one_page


@pytest.mark.parametrize("at", range(18))
@pytest.mark.parametrize("new_seed", [2, 3])
def test_another_program_is_loaded_while_it_is_read(at: int, new_seed: int) -> None:
    loaded_while_read(program(1000, seed=1), program(1000, seed=new_seed), at)


@pytest.mark.parametrize("at", range(18))
@pytest.mark.parametrize("first", [1, 5, 12])
def test_an_edit_that_moves_what_follows_is_made_while_it_is_read(at: int, first: int) -> None:
    old = program(1000, seed=1)
    new = {number: bytes(reversed(old.pages[number])) for number in range(first, 15)}
    loaded_while_read(old, with_pages(old, new), at)


def test_a_page_that_differs_in_each_reading_is_in_no_backup() -> None:
    image = program(400)
    bench = Bench(image)

    def forge(seen: Seen, answer: bytes) -> bytes:
        if seen.page != 3:
            return answer
        bench.device.pages[3] = bytes([seen.number]) * 128
        return answer

    bench.tap.forge = forge
    with pytest.raises(DataError, match=r"changed while it was read.*page 3"):
        backup(bench.plc, known=known(with_pages(image, {3: BLANK})))


@pytest.mark.parametrize(
    "fault", ["late=0.2", "duplicate=0.2", "drop=0.2", "flip=0.2", "noise=0.2", "slow=0.2"]
)
@pytest.mark.parametrize("seed", seeds(6, 6))
def test_a_bad_line(fault: str, seed: int) -> None:
    """Late answers, answers twice, lost and damaged ones: right, or refused."""
    image = program(400)
    old = with_pages(image, {3: BLANK, 4: BLANK})
    bench = Bench(image, faults=(fault,), seed=seed, retries=8)
    assert backup(bench.plc, known=known(old)).program == image


# --- a restore ----------------------------------------------------------------------------------------


def test_a_restore_reads_once_what_is_in_the_file_or_in_the_newest_safety_copy() -> None:
    wanted, before = program(400, seed=2), program(400, seed=1)
    half = replace(before, pages=(*wanted.pages[:5], *before.pages[5:]))
    bench = Bench(half)
    plan = plan_restore(bench.plc, backup_of(wanted), RestoreOptions(), known=known(wanted, before))
    assert plan.present.program == half
    assert plan.present.proof == Proof("press.json", 8, 0)
    assert requests(bench)[READ_PAGE] == 8


def test_a_restore_reads_the_others_twice() -> None:
    wanted = program(400, seed=2)
    bench = Bench(changed(wanted, 4))
    plan = plan_restore(bench.plc, backup_of(wanted), RestoreOptions(), known=known(wanted))
    assert plan.present.proof == Proof("press.json", 7, 1)
    assert requests(bench)[READ_PAGE] == 9


@posix("named pipes")
def test_a_pipe_is_no_file_to_compare_with(tmp_path: Path) -> None:
    """``backup >(gzip > x)``: the program goes into it, and nobody writes what could be read."""
    os.mkfifo(tmp_path / "pipe")
    assert first_known([None, tmp_path / "missing.json", tmp_path / "pipe"]) is None


# --- the order ----------------------------------------------------------------------------------------

PAGES = st.lists(st.sampled_from([b"a", b"b", b"c", b"d"]), min_size=1, max_size=40)


@given(PAGES)
def test_neighbours_differ_as_far_as_there_is_an_order(pages: list[bytes]) -> None:
    order = apart(pages)
    assert sorted(order) == list(range(len(pages)))
    most = max(map(pages.count, pages))
    equal = sum(pages[a] == pages[b] for a, b in pairwise(order))
    assert equal == max(0, 2 * most - len(pages) - 1)
    assert len(list(after_an_equal(order, pages))) == equal


@given(st.sets(st.integers(0, 20)), st.integers(21, 30))
def test_neighbours(numbers: set[int], count: int) -> None:
    found = neighbours(sorted(numbers), count)
    assert not found & numbers
    assert all({number - 1, number + 1} & numbers for number in found)
    assert bool(found) == (len(numbers) >= 2)
