from __future__ import annotations

import re
from dataclasses import replace

import pytest

from fatektool.errors import DataError, LineError, PlcRefused
from fatektool.jobs.programs.backup import backup
from fatektool.jobs.programs.reading import MOST_PASSES
from fatektool.jobs.programs.verify import verify
from fatektool.jobs.status import read_status
from fatektool.program.archive import Backup
from fatektool.simulator.faults import PROBABILITY_KINDS
from tests.program.samples import changed, header, program
from tests.rigs import DETAILED_STATUS, READ_PAGE, WRITE_PAGE, Bench, Seen, framed

PAGES = 8


def test_a_backup_is_read_twice() -> None:
    bench = Bench(program(400))
    told: list[tuple[str, int, int]] = []
    found = backup(bench.plc, progress=lambda *step: told.append(step))
    assert found.program == program(400)
    assert found.passes == 2
    assert bench.tap.count[READ_PAGE] == 2 * PAGES
    assert bench.tap.count[DETAILED_STATUS] == 2
    assert told == [
        ("reading", before + done, 2 * PAGES) for before in (0, PAGES) for done in range(PAGES + 1)
    ]
    assert found.plc["system"]["ladder_words"] == 400
    assert (found.source.target, found.source.station, found.source.protocol) == ("bench", 1, "facon")
    assert re.fullmatch(r"\d{4}-\d\d-\d\dT\d\d:\d\d:\d\dZ", found.created)
    assert Backup.parse(found.to_bytes()) == found


def test_a_single_pass() -> None:
    bench = Bench(program(400))
    found = backup(bench.plc, single_pass=True)
    assert found.program == program(400)
    assert found.passes == 1
    assert bench.tap.count[READ_PAGE] == PAGES
    assert bench.tap.count[DETAILED_STATUS] == 1


def test_a_running_plc_is_backed_up_and_goes_on_running() -> None:
    bench = Bench(program(400))
    bench.device.running = True
    assert backup(bench.plc).plc["status"]["running"] is True
    assert bench.device.running
    assert WRITE_PAGE not in bench.tap.count


@pytest.mark.parametrize("single_pass", [False, True])
def test_a_header_that_does_not_hold(*, single_pass: bool) -> None:
    image = program(400, page0=header(500, b"XB30"))
    bench = Bench(image)
    with pytest.raises(
        DataError, match=r"invalid header of the program .page 0.: byte 0: .*--any-header"
    ) as caught:
        backup(bench.plc, single_pass=single_pass)
    assert caught.value.details["faults"][1].startswith("bytes 4 and 5: expected the ladder size 400")
    assert bench.tap.count[READ_PAGE] == PAGES  # no second pass for it
    found = backup(bench.plc, single_pass=single_pass, any_header=True)
    assert found.program == image
    header_said = found.header_document
    assert (header_said["valid"], header_said["signature"], header_said["ladder_words"]) == (
        False,
        "XB30",
        500,
    )


def test_a_plc_that_keeps_its_program_to_itself() -> None:
    bench = Bench(program(400), program_commands=False)
    with pytest.raises(PlcRefused, match=r"read program page 0 .4F.: error 4, .*project file") as caught:
        backup(bench.plc)
    assert caught.value.exit_code == 4


def test_a_plc_without_ladder_memory() -> None:
    bench = Bench(program(400))

    def forge(seen: Seen, answer: bytes) -> bytes:
        if seen.command != DETAILED_STATUS:
            return answer
        # error character, status byte, unit, points, version, and then the ladder size
        return framed(answer[1:6] + answer[6:14] + b"0000" + answer[18:-3])

    bench.tap.forge = forge
    with pytest.raises(DataError, match=r"has a ladder size of 0 words.*fatektool status"):
        backup(bench.plc)


@pytest.mark.parametrize("page", [1, 3, 7])
def test_two_passes_over_a_clean_line_that_differ(page: int) -> None:
    """Somebody loads a program meanwhile."""
    bench = Bench(program(400))

    def load(seen: Seen) -> None:
        if (seen.command, seen.number) == (READ_PAGE, PAGES + 1):
            bench.device.pages[page] = bytes(128)

    bench.tap.before = load
    with pytest.raises(
        DataError, match=f"without line errors read different programs: page {page}; "
    ) as caught:
        backup(bench.plc)
    assert "nobody loads a program" in str(caught.value)
    assert bench.tap.count[READ_PAGE] == 2 * PAGES


def test_the_ladder_size_changes_between_two_passes() -> None:
    """The PLC is exchanged meanwhile."""
    bench = Bench(program(400))

    def exchange(seen: Seen) -> None:
        if (seen.command, seen.number) == (DETAILED_STATUS, 2):
            bench.device.model = replace(bench.device.model, ladder_words=500)
            bench.device.pages = list(program(500).pages)

    bench.tap.before = exchange
    with pytest.raises(DataError, match=r"detailed status \(53\) changed: ladder_words 400, then 500; "):
        backup(bench.plc)


def test_another_part_of_the_system_changes_between_two_passes() -> None:
    bench = Bench(program(400))

    def exchange(seen: Seen) -> None:
        if (seen.command, seen.number) == (DETAILED_STATUS, 2):
            bench.device.model = replace(bench.device.model, timers=7, os_version=0x32)

    bench.tap.before = exchange
    with pytest.raises(DataError, match=r"changed: os_version 3.1, then 3.2, timers 256, then 7; "):
        backup(bench.plc)


def test_a_flag_that_changes_between_two_passes_is_no_other_plc() -> None:
    bench = Bench(program(400))

    def stop(seen: Seen) -> None:
        bench.device.running = seen.passes < 2

    bench.tap.before = stop
    assert backup(bench.plc).passes == 2


def forged(seen: Seen, answer: bytes, *, page: int, digit: int, noise: bytes = b"") -> bytes:
    """The answer to this page with another last digit and a right checksum; noise before page 4."""
    if (seen.command, seen.page) == (READ_PAGE, page):
        return framed(answer[1:-4] + b"%X" % (digit % 16))
    return noise + answer if (seen.command, seen.page) == (READ_PAGE, 4) else answer


NOISE = b"\x7f\x7f"


def test_an_error_that_slipped_through_the_checksum_of_a_noisy_line_costs_a_pass() -> None:
    bench = Bench(program(400))
    true = bench.pages[6][-1] & 15

    def forge(seen: Seen, answer: bytes) -> bytes:
        return forged(seen, answer, page=6, digit=true + (seen.passes == 1), noise=NOISE)

    bench.tap.forge = forge
    found = backup(bench.plc)
    assert found.program == program(400)
    assert found.passes == 3


def test_the_same_on_a_clean_line_is_no_error_of_the_line() -> None:
    bench = Bench(program(400))
    true = bench.pages[6][-1] & 15
    bench.tap.forge = lambda seen, answer: forged(seen, answer, page=6, digit=true + (seen.passes == 1))
    with pytest.raises(DataError, match=r"without line errors.*page 6;"):
        backup(bench.plc)


def test_a_line_too_bad_for_any_two_passes_to_agree() -> None:
    bench = Bench(program(400))
    bench.tap.forge = lambda seen, answer: forged(seen, answer, page=7, digit=seen.passes, noise=NOISE)
    with pytest.raises(LineError, match=f"no two of {MOST_PASSES} passes read the same") as caught:
        backup(bench.plc)
    assert caught.value.exit_code == 3
    assert "check shield and termination" in str(caught.value)


@pytest.mark.parametrize(
    "fault",
    [f"{kind}=0.08" for kind in PROBABILITY_KINDS if kind not in {"echo", "lying-write"}] + ["echo=1"],
)
def test_no_fault_of_the_line_gets_into_a_backup(fault: str) -> None:
    for seed in range(4):
        bench = Bench(program(400), faults=(fault,), seed=seed, retries=12)
        assert backup(bench.plc).program == program(400)


# --- verify and status ----------------------------------------------------------------------------------


def test_verify_the_same_program() -> None:
    bench = Bench(program(400))
    found = verify(bench.plc, program(400))
    assert found.same
    assert bench.tap.count[READ_PAGE] == PAGES


def test_verify_names_what_differs_after_a_second_look() -> None:
    bench = Bench(changed(program(400), 2, 5))
    told: list[str] = []
    found = verify(bench.plc, program(400), progress=lambda phase, _done, _total: told.append(phase))
    assert found.page_numbers == [2, 5]
    assert found.word_count == 2
    assert bench.tap.count[READ_PAGE] == PAGES + 2
    assert told[-1] == "reading again"


def test_verify_takes_no_error_of_the_line_for_a_change() -> None:
    bench = Bench(program(400))
    true = bench.pages[6][-1] & 15

    def forge(seen: Seen, answer: bytes) -> bytes:
        return forged(seen, answer, page=6, digit=true + (seen.number <= PAGES))

    bench.tap.forge = forge
    assert verify(bench.plc, program(400)).same


def test_verify_another_ladder_size_reads_no_page() -> None:
    bench = Bench(program(400))
    found = verify(bench.plc, program(500))
    assert not found.same
    assert (found.a_ladder_words, found.b_ladder_words) == (500, 400)
    assert READ_PAGE not in bench.tap.count


def test_status() -> None:
    bench = Bench(program(400))
    bench.device.battery_low = True
    report = read_status(bench.plc)
    assert report.flags.battery_low
    assert report.system is not None
    assert report.system.ladder_words == 400
    assert read_status(bench.plc, brief=True).system is None
    assert bench.tap.count[DETAILED_STATUS] == 1
