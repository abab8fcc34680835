"""Many requests of one kind: an answer that came twice shifts nothing."""

from __future__ import annotations

import itertools
import random
from typing import TYPE_CHECKING

import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from fatektool.errors import LineError, NoAnswer, PlcRefused
from fatektool.exchange.batch import read_all
from fatektool.exchange.link import Link
from fatektool.protocol.commands import ReadPage, ReadRegisters
from fatektool.protocol.elements import Element
from fatektool.protocol.fatek.facon.codec import FACON
from fatektool.simulator.build import build_simulation
from fatektool.transport.base import LineSettings
from fatektool.transport.memory import MemoryTransport
from tests.exchange.peer import (
    SILENCE,
    Pieces,
    Rules,
    ask_page,
    fences,
    frame,
    linked,
    page_answer,
    read_registers,
    register,
)
from tests.night import examples

if TYPE_CHECKING:
    from collections.abc import Callable, Sequence


def pages(*values: int) -> list[bytes]:
    return [bytes([value]) * 128 for value in values]


class Shifting:
    """A line that is one or more answers behind: what it has still to say comes right after a request.

    Args:
        program: the pages.
        spoil: from the number of pages asked before and the answer to what is said, a piece a request.
    """

    def __init__(self, program: Sequence[bytes], spoil: Callable[[int, bytes], list[bytes]]) -> None:
        self._answers = {ask_page(number): page_answer(page) for number, page in enumerate(program)}
        self._spoil = spoil
        self._pages_asked = 0
        self._to_say: list[bytes] = []
        self.heard: list[bytes] = []

    def receive(self, data: bytes, now: float) -> Pieces:
        self.heard.append(data)
        answer = self._answers.get(data)
        if answer is not None:
            self._to_say += self._spoil(self._pages_asked, answer)
            self._pages_asked += 1
            said = [self._to_say.pop(0)] if self._to_say else []
        else:  # a fence, or the question whether the line echoes: all is said, in order
            said = [*self._to_say, frame("4001540" + "0") if data[3:5] == b"40" else data]
            self._to_say = []
        return [(now + 0.01, piece) for piece in said if piece]


def read(peer: object, count: int) -> list[bytes]:
    return read_all(linked(peer), [ReadPage(page) for page in range(count)])  # type: ignore[arg-type]


def test_a_clean_line_costs_one_loopback() -> None:
    program = pages(1, 2, 3, 4)
    peer = Shifting(program, lambda _, answer: [answer])
    told: list[int] = []
    link = linked(peer)
    assert read_all(link, [ReadPage(page) for page in range(4)], told.append) == program
    assert told == [1, 2, 3, 4]
    assert fences(peer.heard) == 1
    assert len(peer.heard) == 5
    assert link.counters.trouble == 0


def test_nothing_asked_is_nothing_answered() -> None:
    assert read(Rules(), 0) == []


@pytest.mark.parametrize("twice", range(6))
def test_an_answer_that_comes_twice_behind_the_next_request(twice: int) -> None:
    program = pages(1, 2, 3, 4, 5, 6)
    peer = Shifting(program, lambda at, answer: [answer] * (1 + (at == twice)))
    assert read(peer, 6) == program


@pytest.mark.parametrize("twice", list(itertools.combinations(range(6), 2)))
def test_two_answers_that_come_twice(twice: tuple[int, int]) -> None:
    program = pages(1, 2, 2, 1, 5, 5)
    peer = Shifting(program, lambda at, answer: [answer] * (1 + (at in twice)))
    assert read(peer, 6) == program


DAMAGE: dict[str, Callable[[bytes], bytes]] = {
    "flipped": lambda answer: answer[:40] + b"?" + answer[41:],
    "cut": lambda answer: answer[:40],
    "without-an-end": lambda answer: answer[:-1],
    "another-station": lambda answer: frame(answer[3:-3].decode(), station=9),
    "one-byte": lambda answer: answer[:1],
}


@pytest.mark.parametrize("damage", sorted(DAMAGE))
@pytest.mark.parametrize(
    "program",
    [
        pages(1, 2, 3, 4, 5, 6, 7),
        pages(1, 2, 3, 3, 3, 3, 3),
        pages(1, 2, 2, 3, 3, 3, 4),
        pages(1, 1, 2, 2, 1, 1, 2),
    ],
    ids=["distinct", "run-at-the-end", "runs", "two-values"],
)
def test_a_shift_that_ends_with_a_damaged_answer(program: list[bytes], damage: str) -> None:
    # A second copy shifts all that follow, until an answer comes to grief: then none is too many.
    hurt_answer = DAMAGE[damage]
    for twice, hurt in itertools.combinations(range(7), 2):

        def spoil(at: int, answer: bytes, twice: int = twice, hurt: int = hurt) -> list[bytes]:
            if at == twice:
                return [answer, answer]
            return [hurt_answer(answer)] if at == hurt else [answer]

        assert read(Shifting(program, spoil), 7) == program, (twice, hurt)


def test_a_second_copy_and_a_lost_answer_leave_no_trace() -> None:
    # What the docstring of the batch says that it cannot see; a second pass differs.
    program = pages(1, 2, 3, 4)

    def spoil(at: int, answer: bytes) -> list[bytes]:
        return [answer, answer] if at == 0 else [] if at == 2 else [answer]

    assert read(Shifting(program, spoil), 4) == pages(1, 1, 2, 4)


@pytest.mark.parametrize("late", range(4))
def test_a_late_answer_behind_the_fence(late: int) -> None:
    """Only a medium that changes the order can do that: the late answer overtakes the second one."""
    program = pages(1, 2, 3, 4)
    answers = {ask_page(number): page_answer(page) for number, page in enumerate(program)}
    held: list[bytes] = []

    def rule(number: int) -> Callable[[int], Pieces]:
        def answer(asked: int) -> Pieces:
            own = answers[ask_page(number)]
            if number == late and not asked:
                held.append(own)
                return SILENCE
            if held:
                first = held.pop(0)
                held.append(own)
                return [(0.01, first)]
            return [(0.01, own)]

        return answer

    class Reordering(Rules):
        def receive(self, data: bytes, now: float) -> Pieces:
            pieces = super().receive(data, now)
            if data[3:5] == b"4E" and held and self.heard.count(ask_page(late)) > 1:
                pieces = [*[(now, stray) for stray in held], *pieces]
                held.clear()
            return pieces

    peer = Reordering({ask_page(number): rule(number) for number in range(4)})
    assert read(peer, 4) == program


@pytest.mark.parametrize("refuses", [False, True])
def test_a_plc_without_loopback_serves_a_clean_batch(refuses: bool) -> None:
    program = pages(1, 2, 3)
    answers: dict[bytes, bytes | Callable[[int], Pieces]] = {
        ask_page(number): page_answer(page) for number, page in enumerate(program)
    }
    if refuses:
        answers |= {frame(f"4EN{number}"): frame("4E4") for number in range(20)}
    notes: list[str] = []
    link = linked(Rules(answers, loopback=False), notes=notes)
    for _ in range(2):
        assert read_all(link, [ReadPage(page) for page in range(3)]) == program
    assert len(notes) == 2
    assert "not answer the loopback" in notes[0]


def test_a_plc_without_loopback_and_a_doubt_is_no_proof() -> None:
    answer = page_answer(bytes(128))
    link = linked(Rules({ask_page(0): lambda _: [(0.01, answer), (0.02, answer)]}, loopback=False))
    with pytest.raises(NoAnswer):
        read_all(link, [ReadPage(0), ReadPage(0)])


def test_a_refused_page_is_told() -> None:
    peer = Rules({ask_page(0): page_answer(bytes(128)), ask_page(1): frame("4FA")})
    with pytest.raises(PlcRefused):
        read(peer, 3)


def test_registers_are_kept_apart_too() -> None:
    requests = [ReadRegisters(Element.parse(f"R{place}"), 1) for place in range(3)]
    copies = {0: 2, 1: 1, 2: 1}
    to_say: list[bytes] = []

    class Behind:
        def receive(self, data: bytes, now: float) -> Pieces:
            for place in range(3):
                if data == read_registers(place):
                    to_say.extend([register(place)] * copies[place])
                    copies[place] = 1
                    return [(now + 0.01, to_say.pop(0))]
            said = [*to_say, frame("40015400") if data[3:5] == b"40" else data]
            to_say.clear()
            return [(now + 0.01, piece) for piece in said]

    assert read_all(linked(Behind()), requests) == [(0,), (1,), (2,)]


# --- the simulator's faults -------------------------------------------------------------------------

KINDS = ["drop", "flip", "truncate", "noise", "duplicate", "late", "slow", "wrong-station", "echo"]
PAGES = 12


def a_program(kind: str) -> list[bytes]:
    generator = random.Random(kind)  # noqa: S311
    header = b"FB00" + (64 * (PAGES - 1)).to_bytes(2, "big") + b"\xff" * 122
    values = {
        "distinct": range(1, PAGES),
        "mostly-empty": [min(place, 4) for place in range(1, PAGES)],
        "two-values": [generator.choice((1, 2)) for _ in range(1, PAGES)],
    }[kind]
    return [header, *pages(*values)]


PROGRAMS = {kind: a_program(kind) for kind in ("distinct", "mostly-empty", "two-values")}


def read_simulated(
    program: list[bytes], faults: list[str], seed: int, baud: float | None
) -> list[bytes] | None:
    """The program as a batch reads it; None if the line was too bad."""
    simulation = build_simulation(program=program, faults=faults, seed=seed, baud=baud)
    numbers = itertools.count()
    link = Link(
        MemoryTransport(simulation.line()),
        FACON,
        1,
        LineSettings(),
        nonces=lambda: b"%08X" % next(numbers),
    )
    try:
        return read_all(link, [ReadPage(page) for page in range(PAGES)])
    except LineError:
        return None


@pytest.mark.parametrize("echo", [[], ["echo=1"]], ids=["", "echo"])
@pytest.mark.parametrize("kind", KINDS)
@settings(max_examples=examples(60), deadline=None)
@given(
    probability=st.sampled_from([0.02, 0.1, 0.3, 1.0]),
    seed=st.integers(0, 1 << 32),
    baud=st.sampled_from([None, 9600]),
    program=st.sampled_from(sorted(PROGRAMS)),
)
def test_one_kind_of_fault_never_makes_a_wrong_page(  # noqa: PLR0917  # hypothesis names them
    kind: str, echo: list[str], probability: float, seed: int, baud: float | None, program: str
) -> None:
    faults = [f"{kind}={probability}"] if kind != "echo" or not echo else []
    got = read_simulated(PROGRAMS[program], faults + echo, seed, baud)
    assert got in (None, PROGRAMS[program])


@pytest.mark.parametrize("kind", KINDS)
def test_a_slightly_bad_line_still_gives_the_program(kind: str) -> None:
    probability = 1 if kind == "echo" else 0.02
    program = PROGRAMS["distinct"]
    for baud in (None, 9600):
        results = [read_simulated(program, [f"{kind}={probability}"], seed, baud) for seed in range(10)]
        assert results.count(program) == 10


@pytest.mark.parametrize("other", ["flip", "truncate", "noise", "late", "slow", "wrong-station"])
@settings(max_examples=examples(50), deadline=None, derandomize=True)
@given(seed=st.integers(0, 1 << 32), program=st.sampled_from(["distinct", "mostly-empty"]))
def test_second_copies_and_a_rare_fault_never_make_a_wrong_page(other: str, seed: int, program: str) -> None:
    got = read_simulated(PROGRAMS[program], ["duplicate=0.05", f"{other}=0.05"], seed, 9600)
    assert got in (None, PROGRAMS[program])
