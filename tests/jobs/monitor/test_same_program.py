"""Is the PLC's program the file's? As far as the PLC gives it out."""

from __future__ import annotations

import pytest

from fatektool.errors import NoAnswer
from fatektool.jobs.monitor.same_program import Sameness, SameProgram
from tests.cli.programs.monitor.plant import IMAGE, NETWORKS
from tests.jobs.monitor.bench import Monitored
from tests.ladder.circuits import words_of
from tests.project.files import program_of
from tests.project.images import image_of

ALL = [1, 2, 4]
"""The header's pages with length and checksum of the code, and the one page of code."""


def compared(bench: Monitored) -> SameProgram:
    found = SameProgram(bench.plc, bench.file)
    found.compare(found.missing(each.network for each in bench.networks))
    return found


@pytest.mark.parametrize("swapped", [False, True])
def test_the_same(swapped: bool) -> None:
    found = compared(Monitored(program=program_of(IMAGE, swapped=swapped)))
    assert (found.sameness, found.pages, found.has_sums, found.is_certain) == (Sameness.SAME, ALL, True, True)


def test_another() -> None:
    networks = ["ORG X0, AND X3, OUT Y4" if "Y4" in each else each for each in NETWORKS]
    other = image_of(list(words_of(*", ".join(networks).split(", "))))
    bench = Monitored(program=program_of(other))
    found = compared(bench)
    assert (found.sameness, found.different, found.is_certain) == (Sameness.DIFFERENT, [1, 4], False)
    pages = [int(body[2:6], 16) for body in bench.wire.bodies() if body[:2] == b"4F"]
    assert [pages.count(page) for page in ALL] == [2, 1, 2]  # what seems to differ is read twice


@pytest.mark.parametrize("swapped", [False, True])
@pytest.mark.parametrize(
    ("word", "differs"), [(101, True), (131, True), (134, True), (135, True), (132, False)]
)
def test_length_and_checksum_of_the_code_are_compared(word: int, differs: bool, swapped: bool) -> None:
    """Of the header these alone: 132, the free words, follows from them."""
    bench = Monitored(program=program_of(IMAGE, swapped=swapped))
    page, place = divmod(2 * word, 128)
    data = bytearray(bench.device.pages[page])
    data[place] ^= 1
    bench.device.pages[page] = bytes(data)
    assert compared(bench).different == ([page] if differs else [])


def test_it_gives_out_a_part() -> None:
    """Up to a page: what is the same is said, and that the rest could not be compared."""
    bench = Monitored()
    bench.device.pages = bench.device.pages[:4]
    found = compared(bench)
    assert (found.sameness, found.pages, found.is_certain) == (Sameness.SAME, [1, 2], False)
    assert (found.reason or "").startswith("the PLC refuses page 4 of its program (4F): ")
    assert found.missing(each.network for each in bench.networks) == []  # it is not asked again


def test_it_refuses_all() -> None:
    found = compared(Monitored(program_commands=False))
    assert (found.sameness, found.pages, found.is_certain) == (Sameness.UNKNOWN, [], False)
    assert (found.reason or "").startswith("the PLC refuses page 1 of its program (4F): ")


def test_it_is_silent_to_4f_and_answers_all_else() -> None:
    bench = Monitored([1])
    bench.wire.silent_to = lambda frame: frame[3:5] == b"4F"
    found = bench.monitor.read()
    program = bench.monitor.program
    assert (program.sameness, program.is_certain) == (Sameness.UNKNOWN, False)
    assert (program.reason or "").startswith("the PLC does not answer the request for page 1 of its program")
    assert found.values == {"X0": 0, "M421": 0, "Y4": 0}
    bench.wire.bodies()
    bench.monitor.read()
    assert not [body for body in bench.wire.bodies() if body[:2] == b"4F"]


def test_no_plc_at_all_is_no_comparison() -> None:
    bench = Monitored([1])
    bench.wire.silent_to = lambda _: True
    with pytest.raises(NoAnswer):
        bench.monitor.read()
    bench.wire.silent_to = lambda _: False
    bench.monitor.read()
    assert bench.monitor.program.is_certain


def test_a_protocol_without_a_program() -> None:
    bench = Monitored([1], protocol="modbus-rtu")
    bench.monitor.read()
    assert bench.monitor.program.reason == "modbus-rtu has no command that reads a program"
