"""Why a signal is on or off."""

from __future__ import annotations

from random import Random
from typing import TYPE_CHECKING

import pytest
from hypothesis import given
from hypothesis import strategies as st

from fatektool.ladder.circuit.writing import instructions_of
from fatektool.ladder.power.causes import MOST_WAYS, Cause, causes_of
from tests.ladder.circuits import circuits, coded, network
from tests.ladder.power.test_flow import carried, circuit, elements_of, random_states

if TYPE_CHECKING:
    from fatektool.ladder.circuit.nodes import Circuit


def ways(cause: Cause) -> list[list[str]]:
    return [[each.leaf.instruction.text.split(" ", 1)[1] for each in way] for way in cause.ways]


def last(text: str, **states: int) -> Cause:
    (*_, reached) = causes_of(circuit(network(*text.split(", "))), states.get).reached.values()
    return reached[-1]


SELF_HOLDING = "ORG X1, OR Y0, AND NOT X0, OUT Y0"
BLOCKS = "ORG M0, LD T200, AND NOT T201, AND M3, LD NOT T204, AND T203, ORLD, LD T206, ORLD, ANDLD, OUT Y2"
TIMES = {"T200": 0, "T201": 1, "M3": 1, "T204": 1, "T203": 0, "T206": 0}


@pytest.mark.parametrize(
    ("text", "elements", "state", "expected"),
    [
        ("ORG X0, AND M421, OUT Y4", {"X0": 1, "M421": 0}, False, [["M421"]]),
        ("ORG X0, AND M421, OUT Y4", {"X0": 0, "M421": 0}, False, [["X0", "M421"]]),
        ("ORG X0, AND M421, OUT Y4", {"X0": 1, "M421": 1}, True, [["X0", "M421"]]),
        ("ORG X0, AND M421, OUT Y4", {"X0": 1}, None, [["M421"]]),
        ("ORG X0, AND M421, OUT Y4", {"X0": 0}, False, [["X0", "M421"]]),
        (SELF_HOLDING, {"X1": 0, "Y0": 0, "X0": 0}, False, [["X1"], ["Y0"]]),
        (SELF_HOLDING, {"X1": 0, "Y0": 0, "X0": 1}, False, [["X1", "NOT X0"], ["Y0", "NOT X0"]]),
        (SELF_HOLDING, {"X1": 1, "Y0": 1, "X0": 0}, True, [["X1", "NOT X0"]]),
        (BLOCKS, {"M0": 1, **TIMES}, False, [["T206"], ["T200", "NOT T201"], ["NOT T204", "T203"]]),
        (BLOCKS, {"M0": 1, **TIMES, "T206": 1}, True, [["M0", "T206"]]),
        ("ORG X0, OR M0, AND X0, OUT Y0", {"X0": 0, "M0": 0}, False, [["X0"]]),
        ("ORG OPEN, OUT Y0", {}, False, []),
    ],
)
def test_the_ways_to_a_coil(
    text: str, elements: dict[str, int], state: bool | None, expected: list[list[str]]
) -> None:
    found = last(text, **elements)
    assert (found.state, ways(found)) == (state, expected)


def test_what_is_before_an_edge_or_what_turns_round() -> None:
    found = last("ORG M0, TU, SET(P) M6", M0=0)
    assert ways(found) == [["M0"]]
    (((edge,),), state) = (last("ORG M0, TU, SET(P) M6", M0=1).ways, last("ORG M0, INV, OUT Y0", M0=1))
    assert (edge.leaf.instruction.text.removeprefix("~"), edge.conducts, edge.carried) == ("TU", None, True)
    ((turned,),) = state.ways
    assert (state.state, turned.conducts, turned.carried) == (False, False, True)


def test_an_output_names_its_function() -> None:
    (((output,),),) = [last("ORG X1, T30 .01 R8, FO 0, OUT M0", X1=1, T30=0).ways]
    assert output.function is not None
    assert (output.function.instruction.text, output.conducts) == ("T30 .01 R8", False)


@given(circuits(), st.integers(0, 1 << 32))
def test_causes_and_power_agree(made: Circuit, seed: int) -> None:
    """The same states; and what is named does what it is named for."""
    random = Random(seed)  # noqa: S311
    for given_ in coded(instructions_of(made)):
        found = circuit(given_)
        states = random_states(found, random)
        power, causes = carried(found, states.get), causes_of(found, states.get).reached
        assert power == {number: tuple(each.state for each in inputs) for number, inputs in causes.items()}
        for inputs in causes.values():
            for cause in inputs:
                named = [each.conducts for way in cause.ways for each in way]
                assert len(cause.ways) <= MOST_WAYS
                assert set(named) <= ({True} if cause.state else {False, None})
                assert len(cause.ways) == 1 or not cause.state


@given(circuits(), st.integers(0, 1 << 32))
def test_a_way_that_is_closed_turns_its_coil_on(made: Circuit, seed: int) -> None:
    """Close the contacts of a way, and power goes through, unless another contact of theirs opens."""
    random = Random(seed)  # noqa: S311
    for given_ in coded(instructions_of(made)):
        found = circuit(given_)
        states = {each.name: random.randrange(2) for each in elements_of(found) if each.bits == 1}
        names = [leaf.element for leaf in found.leaves if leaf.element is not None]
        for number, inputs in causes_of(found, states.get).reached.items():
            for place, cause in enumerate(inputs):
                for way in cause.ways if cause.state is False else ():
                    if any(each.leaf.element is None or names.count(each.leaf.element) > 1 for each in way):
                        continue
                    if any(each.leaf.edge or each.function for each in way):
                        continue
                    closed = {each.leaf.element or "": int(not each.leaf.is_inverted) for each in way}
                    assert carried(found, (states | closed).get)[number][place] is True
