"""A PLC that refuses pages past its end gave its whole program; FBs images, in both byte orders."""

from __future__ import annotations

from typing import TYPE_CHECKING

import pytest

from fatektool.errors import DataError, PlcRefused
from fatektool.jobs.programs.backup import backup
from fatektool.jobs.programs.restore import RestoreOptions, RestorePlan, carry_out, plan_restore
from fatektool.jobs.programs.safekeeping import require_ladder
from fatektool.jobs.programs.verify import verify
from fatektool.program.archive import Backup
from fatektool.program.image import Program
from fatektool.protocol.plc_errors import PROGRAM_REFUSED
from fatektool.simulator.refusal import Refusal
from tests.program.samples import backup as backup_of
from tests.program.samples import header, program
from tests.rigs import READ_PAGE, Bench, Simulated, simulated

if TYPE_CHECKING:
    from fatektool.simulator.plc import SimulatedPlc

SHORT = 128
"""Pages of a b1-14mc: its ladder of 8192 words asks for 129."""


def refusing(device: SimulatedPlc, first: int, code: int, *, but: int | None = None) -> None:
    """Make a PLC refuse the pages from ``first`` on."""
    read = device.read_page

    def read_page(page: int) -> bytes:
        if page >= first and page != but:
            raise Refusal(code)
        return read(page)

    device.read_page = read_page  # type: ignore[method-assign]


@pytest.mark.parametrize("swapped", [False, True])
@pytest.mark.parametrize(("model", "pages"), [("b1-14mc", 128), ("fbs-24mc", 320), ("fbs-20mc", 512)])
def test_an_fbs_image_is_backed_up_and_found_again(model: str, pages: int, *, swapped: bool) -> None:
    one = simulated(model=model, program_swapped=swapped)
    kept = backup(one.plc)
    assert kept.passes == 2
    assert kept.program.pages == tuple(one.device.pages)
    assert len(kept.program.pages) == pages
    header = kept.program.header
    assert (header.family, header.valid, header.odd) == ("fbs", True, ())
    assert header.byte_order == ("swapped" if swapped else "as paper")
    assert Backup.parse(kept.to_bytes()) == kept
    require_ladder(kept.program)
    found = verify(one.plc, kept.program)
    assert found.same
    assert not found.b_has_more


@pytest.mark.parametrize(("code", "page"), [(0x4, 1), (0x4, 7), (0xA, 5), (0x2, 1)])
def test_a_page_in_the_middle_that_is_refused_is_no_plc_that_refuses_its_program(
    code: int, page: int
) -> None:
    bench = Bench(program(400))
    refusing(bench.device, page, code)
    with pytest.raises(PlcRefused, match=f"refused to read program page {page} ") as caught:
        backup(bench.plc)
    assert str(caught.value.hint).startswith("it gave the pages before: ")


def test_a_plc_that_refuses_its_first_page_refuses_its_program() -> None:
    bench = Bench(program(400))
    refusing(bench.device, 0, 0x4)
    with pytest.raises(PlcRefused, match="refused to read program page 0 ") as caught:
        backup(bench.plc)
    assert caught.value.hint == PROGRAM_REFUSED


@pytest.mark.parametrize("code", [0x2, 0xA])
def test_the_very_last_page_may_be_refused_in_any_family(code: int) -> None:
    bench = Bench(program(400))
    refusing(bench.device, 7, code)
    kept = backup(bench.plc)
    assert kept.program.pages == program(400).pages[:7]
    assert kept.passes == 2
    assert verify(bench.plc, kept.program).same


@pytest.mark.parametrize("code", [0x3, 0x4, 0x5])
def test_another_refusal_is_no_end(code: int) -> None:
    bench = Bench(program(400))
    refusing(bench.device, 7, code)
    with pytest.raises(PlcRefused, match=f"page 7 .*error {code:X}"):
        backup(bench.plc)


@pytest.mark.parametrize("first", [0, 1, 6])
def test_less_than_the_header_announces_is_no_program(first: int) -> None:
    bench = Bench(program(400))
    refusing(bench.device, first, 0xA)
    with pytest.raises(PlcRefused, match=f"page {first} "):
        backup(bench.plc)
    fbs = simulated(model="b1-14mc")
    refusing(fbs.device, 100 + first, 0xA)
    with pytest.raises(PlcRefused, match=f"page {100 + first} "):
        backup(fbs.plc)


def test_a_gap_is_no_end() -> None:
    one = simulated(model="fbs-20mc")
    refusing(one.device, 400, 0xA, but=512)
    one.device.pages.append(b"\xff" * 128)
    with pytest.raises(PlcRefused, match="page 400 "):
        backup(one.plc)


def test_the_rest_of_a_gap_is_asked_with_one_request() -> None:
    bench = Bench(program(400))
    refusing(bench.device, 7, 0xA)
    backup(bench.plc, single_pass=True)
    assert bench.tap.count[READ_PAGE] <= 8 + 2


# --- verify and restore ---------------------------------------------------------------------------------


def plan(one: Bench | Simulated, wanted: Program, **options: bool) -> RestorePlan:
    file = backup_of(wanted)
    file.plc["system"] |= one.plc.detailed_status().system.document()
    return plan_restore(one.plc, file, RestoreOptions(**options))


def test_verify_reads_as_many_pages_as_the_file_has_and_says_that_there_are_more() -> None:
    bench = Bench(program(400))
    short = Program(400, program(400).pages[:7])
    found = verify(bench.plc, short)
    assert found.same
    assert found.b_has_more
    assert bench.tap.count[READ_PAGE] == 8
    bench.device.pages[3] = b"\0" * 128
    assert verify(bench.plc, short).page_numbers == [3]


def test_verify_of_a_plc_that_has_fewer_pages_names_them() -> None:
    bench = Bench(program(400))
    refusing(bench.device, 7, 0xA)
    found = verify(bench.plc, program(400))
    assert found.page_numbers == [7]
    assert found.pages[0].b is None


@pytest.mark.parametrize("changed_only", [False, True])
def test_an_fbs_image_is_restored(*, changed_only: bool) -> None:
    one = simulated(model="b1-14mc")
    wanted = Program(8192, tuple(simulated(model="b1-14mc", program_seed=2).device.pages))
    made = plan(one, wanted, changed_only=changed_only)
    assert made.warnings == ()
    result = carry_out(one.plc, made, None)
    assert tuple(one.device.pages) == wanted.pages
    assert result.verified
    assert result.pages_written == (len(made.comparison.pages) if changed_only else SHORT)


def test_pages_that_the_file_has_not_stay_as_they_are() -> None:
    bench = Bench(program(400, seed=1))
    short = Program(400, program(400, seed=2).pages[:7])
    made = plan(bench, short)
    assert made.warnings == ("the PLC has more pages than the file, 7: they are not changed",)
    assert made.present.program == program(400, seed=1)
    carry_out(bench.plc, made, None)
    assert bench.pages == (*short.pages, program(400, seed=1).pages[7])


def test_more_pages_than_the_plc_has_are_refused() -> None:
    bench = Bench(program(400, seed=1))
    refusing(bench.device, 7, 0xA)
    with pytest.raises(DataError, match="expected at most 7 pages, got 8 in the file"):
        plan(bench, program(400, seed=2))


def test_another_family_is_refused_whatever_is_asked_for() -> None:
    facon = simulated(ladder_words=8192)
    fbs = simulated(model="b1-14mc")
    ours, theirs = (Program(8192, tuple(one.device.pages)) for one in (facon, fbs))
    for one, wanted in ((facon, theirs), (fbs, Program(8192, ours.pages[:128]))):
        for any_header in (False, True):
            with pytest.raises(DataError, match=r"of another family of PLC: expected .* as in the PLC"):
                plan(one, wanted, any_header=any_header)


# --- another model --------------------------------------------------------------------------------------


@pytest.mark.parametrize(
    ("key", "value", "said"),
    [
        ("unit_type", {"code": 0, "name": "MA/MU"}, "MA/MU, 28 points, OS 3.1"),
        ("unit_type", {"code": 7, "name": None}, "type 07, 28 points, OS 3.1"),
        ("main_unit_points", {"code": 3, "points": 40}, "MC, 40 points, OS 3.1"),
        ("main_unit_points", {"code": 9, "points": None}, "MC, points code 09, OS 3.1"),
        ("os_version", "3.0", "MC, 28 points, OS 3.0"),
    ],
)
def test_a_program_of_another_model_is_a_warning(key: str, value: object, said: str) -> None:
    bench = Bench(program(400, seed=1))
    file = backup_of(program(400, seed=2))
    file.plc["system"][key] = value
    (warning,) = plan_restore(bench.plc, file, RestoreOptions()).warnings
    assert warning.startswith(
        f"the program was read from another model, {said}, and goes into MC, 28 points, OS 3.1: "
    )


def test_the_same_model_is_none() -> None:
    assert plan(Bench(program(400, seed=1)), program(400, seed=2)).warnings == ()


def test_other_letters_of_the_signature_are_refused_unless_that_is_asked_for() -> None:
    bench = Bench(program(400, seed=1))
    wanted = program(400, seed=2, page0=header(400, b"FM30"))
    with pytest.raises(DataError, match=r"expected FB as in the PLC, got FM in the file; .* or --any-header"):
        plan(bench, wanted)
    assert plan(bench, wanted, any_header=True).pages == tuple(range(8))
    assert plan(Bench(program(400, page0=header(400, b"FB99"))), program(400)).pages == tuple(range(8))
