"""Networks as circuits: what the vendor's program printed, what is made at random, and what is no circuit."""

from __future__ import annotations

from random import Random
from typing import TYPE_CHECKING

import pytest
from hypothesis import given
from hypothesis import strategies as st

from fatektool.ladder.circuit.nodes import Circuit, Leaf
from fatektool.ladder.circuit.reading import DEEPEST, LARGEST, NoCircuit, circuit_of
from fatektool.ladder.circuit.roles import PLACES, Role, role_of
from fatektool.ladder.circuit.writing import instructions_of
from fatektool.ladder.networks import Code, Network
from fatektool.simulator.program.fbs_code import random_code
from tests.ladder.circuits import WORDS, circuits, coded, network, one
from tests.ladder.meaning import by_circuit, by_stack
from tests.ladder.shapes import shape
from tests.ladder.test_words import PROGRAMS
from tests.ladder.vectors import PRINTED, READ
from tests.rows import each

if TYPE_CHECKING:
    from fatektool.ladder.networks import Network
    from tests.ladder.vectors import Vector

SERVO = "FUN 140 HSPSO Ps:1 SR:R1300 WR:R1500"
PRINTED_NETWORKS = {
    "ORG OPEN": "OPEN",
    "ORG X0, OUTS M1": "X0 [OUTS M1]",
    "ORG X1, OR Y0, AND NOT X0, OUT Y0": "(X1|Y0) !X0 [Y0]",
    "ORG SHORT, LD X4, OR M1050, ANDLD, OUTS M507": "SHORT &(X4|M1050) [OUTS M507]",
    "ORG X3, AND M25, AND M80, AND SHORT, OUTR M25, OUTS M82, RST( ) T10, FUN 08 MOV S:0 D:R1501": (
        "X3 M25 M80 SHORT [OUTR M25] [OUTS M82] [RST( ) T10] { > FUN 08 MOV S:0 D:R1501 > }"
    ),
    "ORG M21, LD OPEN, LD OPEN, FUN 140 HSPSO Ps:0 SR:R1100 WR:R1144, FO 0, OUTS M1992, FO 1, OUTS M501,"
    " FO 2, OUTR M21": (
        "M21 {OPEN; OPEN > FUN 140 HSPSO Ps:0 SR:R1100 WR:R1144 >"
        " FO 0 [OUTS M1992]; FO 1 [OUTS M501]; FO 2 [OUTR M21]}"
    ),
    f"ORG S10, LD S3, OUT TR 0, AND OPEN, LD TR 0, {SERVO}, FO 0, OUT M460": (
        f"S10 {{S3 OUT TR 0 OPEN; LD TR 0 > {SERVO} > FO 0 [M460]}}"
    ),
    "ORG M1993, AND SHORT, OUT TR 0, OUTR M25, FUN 15 (+1) D100, LD TR 0, T8 .01 R1411": (
        "M1993 SHORT OUT TR 0 [OUTR M25] { > FUN 15 (+1) D100 > } / LD TR 0 { > T8 .01 R1411 > }"
    ),
    "ORG X1, AND TD X1, OUT Y0": "X1 vX1 [Y0]",
    "ORG M0, TU, SET(P) M6": "M0 TU [SET(P) M6]",
    "ORG M0, LD X1, C0 100, FO 0, OUT Y0": "M0 {X1 > C0 100 > FO 0 [Y0]}",
    "ORG X0, OUT Y0, OUT NOT M2": "X0 [Y0] [OUT NOT M2]",
    "ORGF 174 >= Sa:C1 Sb:R1400, AND M22, OUTS M233": "174 >= Sa:C1 Sb:R1400 M22 [OUTS M233]",
    "ORG M0, LD T200, AND NOT T201, AND M3, LD NOT T204, AND T203, ORLD, LD T206, ORLD, ANDLD, OUT Y2": (
        "M0 &(<T200 !T201 M3>|<!T204 T203>|T206) [Y2]"
    ),
    "STP S20, OUT Y0, AND X0, TO S20": "STP S20 [Y0] X0 [TO S20]",
    "FUN 65 LBL INIT": "{ > FUN 65 LBL INIT > }",
    "ORG M0, END": "M0 { > END > }",
    "FUN 65 LBL STAT, FUN 68 RTS, END": "{ > FUN 65 LBL STAT > } / { > FUN 68 RTS > } / { > END > }",
}
"""Of real programs, or of the kinds of networks that they have, and the circuits that they are."""

REASONS = {
    "AND X0, OUT Y0": "there is no contact before AND X0: a network begins with ORG",
    "LD X1, OUT Y0": "there is no contact before LD X1: a network begins with ORG",
    "ORG X0, ANDLD, OUT Y0": "ANDLD joins two blocks, but there is only one",
    "ORG X0, LD X1, OUT Y0": "before OUT Y0 1 block is not connected",
    "ORG X0, LD X1, LD X4, FUN 68 RTS": "before FUN 68 RTS 3 blocks are not connected",
    "ORG X0, LD X1": "at its end 1 block is not connected",
    "ORG X0, OUT Y0, OR Y0": "OR Y0 is after a coil or function",
    "ORG X0, LD TR 0, OUT Y0": "there is no OUT TR before LD TR 0",
    "ORG X0, FO 0, OUT Y0": "FO 0 is not after its function",
    "ORG X0, C0 100": "C0 100 has 2 inputs, and 1 line leads to it",
    "ORG X0, LD X1, FUN 15 (+1) C0": "FUN 15 (+1) C0 has 1 input, and 2 lines lead to it",
    "ORG X0, FUN 15 (+1) C0, OUT Y0": "the state of the line from FUN 15 (+1) C0 to OUT Y0 is not known",
    "ORG X0, FUN 08 MOV S:0 D:R1501, OUT Y0, FO 0": "FO 0 is not after its function",
    "ORG X0, FUN 15 (+1) C0, FO 0, OR Y0": "OR Y0 is after an output of a function",
}


def named(text: str) -> Network:
    return network(*text.split(", "))


@each("text", PRINTED_NETWORKS)
def test_a_network_is_this_circuit(text: str) -> None:
    given_ = named(text)
    found = circuit_of(given_)
    assert isinstance(found, Circuit), found
    assert shape(found) == PRINTED_NETWORKS[text]
    assert instructions_of(found) == given_.instructions


@each("text", REASONS)
def test_what_is_no_circuit_says_why(text: str) -> None:
    given_ = named(text)
    found = circuit_of(given_)
    assert isinstance(found, NoCircuit), found
    assert found.reason == REASONS[text]
    assert given_.first <= found.number < given_.first + len(given_.instructions)


@pytest.mark.parametrize(
    ("words", "reason", "number"),
    [
        ((0x0040, 0x1AF5), "?? 1AF5 is not known, and its number of words is not known either", 1),
        ((0x0040, 0x00C1, 0xE6CF), "the function of OUT SHORT is not known", 2),
        ((0x0040, 0x0084, 0x00C1), "the function of AND TR 0 is not known", 1),
        ((0x0040, 0x00E0, 0xE68F), "the function of AND TU SHORT is not known", 1),
        (
            (0x0040, *[0x3FF4] * 30),
            f"??{' 3FF4' * 7}... is not known, and its number of words is not known either",
            1,
        ),
    ],
)
def test_words_that_are_not_known_say_so(words: tuple[int, ...], reason: str, number: int) -> None:
    (given_,) = Code.of(words).networks
    assert circuit_of(given_) == NoCircuit(reason, number)


def network_with(vector: Vector) -> Network:
    """An instruction in a network that has what it needs."""
    before = {
        Role.AND: ["ORG X0"],
        Role.OR: ["ORG X0"],
        Role.LD: ["ORG X0"],
        Role.LINE: ["ORG X0"],
        Role.AND_BLOCK: ["ORG X0", "LD X1"],
        Role.OR_BLOCK: ["ORG X0", "LD X1"],
        Role.STORE: ["ORG X0"],
        Role.RECALL: ["ORG X0", "OUT TR 0", "OUT Y0"],
        Role.OUTPUT: ["ORG X0", "LD OPEN", "LD OPEN", SERVO],
        Role.COIL: ["ORG X0"],
        Role.FUNCTION: ["ORG X0"],
    }
    instruction = one(*vector.words)
    role = role_of(instruction)
    first = before.get(role, [])
    if role is Role.FUNCTION and vector.text.startswith(("C", "FUN 140", "FUN 07", "FUN 151")):
        first = ["ORG X0", *["LD X1"] * (1 if vector.text.startswith("C") else 2)]
    behind = {Role.LD: ["ORLD", "OUT Y0"]}.get(role, ["OUT Y0"] if role not in _LAST else [])
    words = [word for text in first for word in WORDS[text]]
    words += [*vector.words, *(word for text in behind for word in WORDS[text])]
    (given_,) = Code.of(words).networks
    return given_


@each("vector", [*PRINTED, *READ], ids=lambda vector: vector.text)
def test_every_vector_is_part_of_a_circuit(vector: Vector) -> None:
    """Each instruction that is known."""
    given_ = network_with(vector)
    found = circuit_of(given_)
    assert isinstance(found, Circuit), found
    assert instructions_of(found) == given_.instructions


_LAST = {Role.COIL, Role.FUNCTION, Role.ALONE, Role.END}


def is_whole(given_: Network, found: Circuit) -> bool:
    """True if the circuit has each instruction once, and they come back from it."""
    places = [(number, instruction) for number, _, instruction in given_.places]
    return (
        places == [(leaf.number, leaf.instruction) for leaf in found.leaves]
        and instructions_of(found) == given_.instructions
    )


@pytest.mark.parametrize("seed", range(5))
def test_every_network_of_the_simulators_programs_is_a_circuit(seed: int) -> None:
    networks = Code.of(random_code(Random(seed), 3000)).networks  # noqa: S311  # a fixed seed
    assert len(networks) > 300
    for given_ in networks:
        found = circuit_of(given_)
        assert isinstance(found, Circuit), (found, [each.text for each in given_.instructions])
        assert is_whole(given_, found)


@given(circuits())
def test_a_circuit_comes_back_from_its_words(circuit: Circuit) -> None:
    (given_,) = coded(instructions_of(circuit))
    found = circuit_of(given_)
    assert isinstance(found, Circuit), found
    assert shape(found) == shape(circuit)
    assert is_whole(given_, found)


@given(circuits(), st.integers(0))
def test_a_circuit_does_what_its_instructions_do(circuit: Circuit, states: int) -> None:
    (given_,) = coded(instructions_of(circuit))
    found = circuit_of(given_)
    assert isinstance(found, Circuit)

    def state(leaf: Leaf) -> bool:
        return bool(states >> leaf.number & 1)

    leaves = [Leaf(number, instruction) for number, _, instruction in given_.places]
    assert by_circuit(found, state) == by_stack(leaves, state)


@given(PROGRAMS)
def test_any_words_are_circuits_or_have_a_reason(words: tuple[int, ...]) -> None:
    for given_ in Code.of(words).networks:
        found = circuit_of(given_)
        if isinstance(found, Circuit):
            assert is_whole(given_, found)
        else:
            assert found.reason.isprintable()
            assert given_.first <= found.number < given_.first + len(given_.instructions)


@pytest.mark.parametrize(
    "texts",
    [
        ["ORG X0", *["LD X1"] * 9000, *["ORLD"] * 9000, "OUT Y0"],
        ["ORG X0", *["AND X0", "OR Y0"] * 9000, "OUT Y0"],
        ["ORG X0", *["AND X0"] * 18000, "OUT Y0"],
        ["ORG X0", *["OR Y0"] * 18000, "OUT Y0"],
        ["ORG X0", *["FUN 15 (+1) C0", "FO 0"] * 6000, "OUT Y0"],
        ["ORG X0", *["OUT TR 0", "LD TR 0", "ORLD"] * 6000, "OUT Y0"],
        ["ORG X0", *["LD X1", "AND X0"] * 60, *["ORLD", "AND X0"] * 60, "OUT Y0"],
        ["ORG X0", *["AND X0", "OR Y0"] * 120, "OUT Y0"],
        ["ORG X0", *["FUN 15 (+1) C0", "FO 0"] * 120, "OUT Y0"],
    ],
    ids=[
        "loads",
        "steps",
        "row",
        "branches",
        "functions",
        "stores",
        "fewer loads",
        "deep",
        "fewer functions",
    ],
)
def test_a_whole_memory_of_one_network(texts: list[str]) -> None:
    """However deep: a circuit that is whole, or the reason."""
    given_ = network(*texts)
    found = circuit_of(given_)
    if isinstance(found, Circuit):
        assert is_whole(given_, found)
    else:
        assert str(DEEPEST) in found.reason or str(LARGEST) in found.reason


def test_a_contact_has_a_form_at_each_place() -> None:
    for text in ("ORG X0", "ORG NOT X0", "ORG TU M300", "ORGF 174 >= Sa:C1 Sb:R1400"):
        leaf = Leaf(0, one(*WORDS[text]))
        assert leaf.role is Role.ORG
        assert leaf.role in PLACES
