"""What carries, against a small interpreter of the instructions, over random circuits and states."""

from __future__ import annotations

from random import Random
from typing import TYPE_CHECKING

import pytest
from hypothesis import given
from hypothesis import strategies as st

from fatektool.ladder.circuit.nodes import Circuit
from fatektool.ladder.circuit.reading import circuit_of
from fatektool.ladder.circuit.writing import instructions_of
from fatektool.ladder.networks import Code
from fatektool.ladder.power.flow import power_of
from fatektool.ladder.power.logic import both, either, opposite
from fatektool.ladder.power.values import Shown, number_of, shown_of
from tests.ladder.circuits import circuits, coded, network, words_of
from tests.ladder.power.networks import Interpreter

if TYPE_CHECKING:
    from collections.abc import Callable, Mapping

    from fatektool.ladder.networks import Network

GUESSES = 12
UNKNOWABLE = ("TU", "TD", "FO", "?")
BLOCKS = {"ANDLD", "ORLD"}


def circuit(given_: Network) -> Circuit:
    found = circuit_of(given_)
    assert isinstance(found, Circuit), found
    return found


def elements_of(circuits_: Circuit) -> list[Shown]:
    return sorted({shown for leaf in circuits_.leaves for shown in shown_of(leaf)})


def random_states(found: Circuit, random: Random) -> dict[str, int]:
    near = [0, 1, 2, 99, 0x7FFF, 0x8000, 0xFFFF]
    return {
        each.name: random.randrange(2) if each.bits == 1 else random.choice(near)
        for each in elements_of(found)
    }


def carried(found: Circuit, read: Callable[[str], int | None]) -> dict[int, tuple[bool | None, ...]]:
    return power_of(found, read).reached


@given(circuits(), st.integers(0, 1 << 32))
def test_what_reaches_coils_and_functions(made: Circuit, seed: int) -> None:
    """Whatever edges and outputs may be, no claim is wrong; and where there are none, all is known.

    INV and TD in a block may act on the block's own signal or on the whole line's: no claim is wrong.
    """
    random = Random(seed)  # noqa: S311
    for given_ in coded(instructions_of(made)):
        found = circuit(given_)
        states = random_states(found, random)
        claims = carried(found, states.__getitem__)
        for each in range(GUESSES):
            interpreter = Interpreter(states, lambda: random.random() < 0.5, by_line=each % 2 == 1)
            scanned = interpreter.run(given_.instructions, given_.first)
            assert scanned.keys() == claims.keys()
            for number, inputs in scanned.items():
                both_ways = zip(claims[number], inputs, strict=True)
                assert all(claim in {None, is_on} for claim, is_on in both_ways)
        words = {word for each in given_.instructions for word in each.text.split(" ")}
        if not words & set(UNKNOWABLE) and not ("INV" in words and words & BLOCKS):
            assert None not in {state for inputs in claims.values() for state in inputs}


@given(circuits(), st.integers(0, 1 << 32), st.floats(0, 1))
def test_elements_that_are_not_known(made: Circuit, seed: int, share: float) -> None:
    """With some states missing, what is still claimed is what all of them would give."""
    random = Random(seed)  # noqa: S311
    for given_ in coded(instructions_of(made)):
        found = circuit(given_)
        states = random_states(found, random)
        known: Mapping[str, int] = {name: raw for name, raw in states.items() if random.random() < share}
        whole, part = carried(found, states.get), carried(found, known.get)
        for number, inputs in part.items():
            assert all(claim in {None, full} for claim, full in zip(inputs, whole[number], strict=True))


def reached(text: str, **states: int) -> tuple[bool | None, ...]:
    """What reaches the last coil or function of a network."""
    (*_, last) = carried(circuit(network(*text.split(", "))), states.get).values()
    return last


@pytest.mark.parametrize(
    ("text", "elements", "expected"),
    [
        ("ORG X0, OUT Y0", {"X0": 1}, (True,)),
        ("ORG NOT X0, OUT Y0", {"X0": 1}, (False,)),
        ("ORG X0, OUT Y0", {}, (None,)),
        ("ORG OPEN, OUT Y0", {}, (False,)),
        ("ORG X0, AND SHORT, OUT Y0", {"X0": 1}, (True,)),
        ("ORG X0, AND M421, OUT Y0", {"M421": 0}, (False,)),
        ("ORG X0, OR S2, OUT Y0", {"S2": 1}, (True,)),
        ("ORG TU M300, OUT Y0", {"M300": 1}, (None,)),
        ("ORG TU M300, OUT Y0", {"M300": 0}, (False,)),
        ("ORG X1, AND TD X1, OUT Y0", {"X1": 1}, (False,)),
        ("ORG M0, TU, SET(P) M6", {"M0": 0}, (False,)),
        ("ORG M0, TU, SET(P) M6", {"M0": 1}, (None,)),
        ("ORG M0, INV, OUT Y0", {"M0": 0}, (True,)),
        # INV in a block turns the block round, or all of the line: the same where the line carries up to it.
        ("ORG X0, LD X1, INV, ANDLD, OUT Y0", {"X0": 0, "X1": 0}, (None,)),
        ("ORG X0, LD X1, INV, AND X2, ANDLD, OUT Y0", {"X0": 0, "X1": 0, "X2": 0}, (False,)),
        ("ORG X0, LD X1, INV, AND X2, ANDLD, OUT Y0", {"X0": 0, "X1": 0, "X2": 1}, (None,)),
        ("ORG X0, LD X1, INV, OR X2, ANDLD, OUT Y0", {"X0": 0, "X1": 1, "X2": 1}, (None,)),
        ("ORG X0, LD X1, INV, LD X2, ANDLD, ANDLD, OUT Y0", {"X0": 0, "X1": 1, "X2": 1}, (None,)),
        ("ORG X0, LD X1, LD X2, INV, ORLD, ANDLD, OUT Y0", {"X0": 0, "X1": 1, "X2": 1}, (None,)),
        ("ORG X0, LD X1, TD, ANDLD, OUT Y0", {"X0": 0, "X1": 1}, (None,)),
        ("ORG X0, LD X1, TU, ANDLD, OUT Y0", {"X0": 0, "X1": 1}, (False,)),
        ("ORG X0, LD X1, INV, ANDLD, OUT Y0", {"X0": 1, "X1": 1}, (False,)),
        ("ORG X0, LD X1, INV, ANDLD, OUT Y0", {"X0": 1, "X1": 0}, (True,)),
        ("ORG X1, T30 .01 R8, FO 0, OUT M0", {"X1": 1, "T30": 1}, (True,)),
        ("ORG X1, T30 .01 R8, FO 0, OUT M0", {"X1": 1}, (None,)),
        ("ORG M0, LD X1, C0 100", {"M0": 1, "X1": 0}, (True, False)),
        ("ORG X0, ANDF 171 > Sa:R6 Sb:0, OUT Y0", {"X0": 1, "R6": 1}, (True,)),
        ("ORG X0, ANDF 171 > Sa:R6 Sb:0, OUT Y0", {"X0": 1, "R6": 0xFFFF}, (False,)),
        ("ORG X0, ANDF 171 > Sa:R6 Sb:0, OUT Y0", {"X0": 1}, (None,)),
        ("STP S20, OUT Y0, AND X0, TO S20", {"S20": 1, "X0": 0}, (False,)),
        ("ORG M0, OUT TR 1, OUT Y0, LD TR 1, AND X0, OUT Y0", {"M0": 1, "X0": 1}, (True,)),
    ],
)
def test_a_network(text: str, elements: dict[str, int], expected: tuple[bool | None, ...]) -> None:
    assert reached(text, **elements) == expected


@pytest.mark.parametrize(
    ("code", "sign", "holds"),
    [
        (0x21, "=", (False, True, False)),
        (0x22, ">", (False, False, True)),
        (0x23, "<", (True, False, False)),
        (0x24, "<>", (True, False, True)),
        (0x25, ">=", (False, True, True)),
        (0x26, "=<", (True, True, False)),
    ],
)
def test_a_comparison_of_numbers_below_at_and_above(code: int, sign: str, holds: tuple[bool, ...]) -> None:
    """Signed: what is below 0 is below 7."""
    words = (*words_of("ORG X0"), 0x7FF6, code << 8, 0x0C0A, 0x0700, *words_of("OUT Y0"))
    (given_,) = Code.of(words).networks
    assert f" {sign} " in given_.instructions[1].text
    found = circuit(given_)
    for below, holds_ in zip(((0, 0xFFFF), (7,), (8, 0x7FFF)), holds, strict=True):
        for raw in below:
            (state,) = [*carried(found, {"X0": 1, "R6": raw}.get).values()][-1]
            assert state is holds_, (sign, raw)


def test_what_is_shown_of_an_instruction() -> None:
    shown = {
        "AND TU M310": [Shown("M310", 1)],
        "T30 .01 R8": [Shown("R8", 16), Shown("RT30", 16), Shown("T30", 1)],
        "FUN 08 MOV S:C0 D:R100": [Shown("RC0", 16), Shown("R100", 16)],
        "RST( ) C0": [Shown("C0", 1), Shown("RC0", 16)],
        "SET( ) S3": [Shown("S3", 1)],
    }
    for text, expected in shown.items():
        leaf = next(leaf for leaf in circuit(network("ORG X0", text)).leaves if leaf.instruction.text == text)
        assert list(shown_of(leaf)) == expected
    assert number_of(0xFFFF, Shown("R0", 16)) == -1
    assert number_of(0x447A0000, Shown("DR0", 32, is_float=True)) == 1000.0
    assert number_of(0x80000000, Shown("DR0", 32)) == -(1 << 31)


@pytest.mark.parametrize("one", [True, False, None])
@pytest.mark.parametrize("other", [True, False, None])
def test_three_values(one: bool | None, other: bool | None) -> None:
    """A result is known if, and only if, all that it may be are the same."""

    def may_be(state: bool | None) -> set[bool]:
        return {True, False} if state is None else {state}

    for found, results in (
        (both(one, other), {a and b for a in may_be(one) for b in may_be(other)}),
        (either([one, other]), {a or b for a in may_be(one) for b in may_be(other)}),
        (opposite(one), {not a for a in may_be(one)}),
    ):
        assert may_be(found) == results
