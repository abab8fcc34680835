"""Circuits drawn with what a PLC has: exact drawings, and what holds of every drawing."""

from __future__ import annotations

from random import Random
from typing import TYPE_CHECKING

import pytest
from hypothesis import given
from hypothesis import strategies as st

from fatektool.ladder.circuit.nodes import Circuit, Leaf
from fatektool.ladder.circuit.reading import circuit_of
from fatektool.ladder.circuit.roles import Role
from fatektool.ladder.drawing.layout import plan_of
from fatektool.ladder.drawing.text.draw import draw
from fatektool.ladder.drawing.text.letters import Letters, width_of
from fatektool.ladder.drawing.text.live import LivePen, live_rows
from fatektool.ladder.drawing.text.pen import Pen
from fatektool.ladder.drawing.text.states import LiveStates
from fatektool.ladder.networks import Code
from fatektool.ladder.power.flow import Power
from fatektool.program.image import Program
from fatektool.project.program_file import ProgramFile
from fatektool.simulator.models import MODELS
from fatektool.simulator.program.demonstration import program_of
from tests.ladder.circuits import network
from tests.ladder.drawing.test_layout import CIRCUITS, carried_by_nets
from tests.ladder.power.test_flow import random_states
from tests.ladder.test_circuit import network_with
from tests.ladder.vectors import PRINTED, READ
from tests.night import night
from tests.rows import each

if TYPE_CHECKING:
    from collections.abc import Iterable, Mapping

    from fatektool.ladder.networks import Network
    from fatektool.ladder.power.logic import State
    from tests.ladder.vectors import Vector


WAYS = ((60, "utf-8"), (80, "ascii"), (200, "utf-8"))
"""Widths, and encodings of the terminal."""


def text_of(circuit: Circuit, states: Mapping[str, int], columns: int = 80, encoding: str = "utf-8") -> str:
    pen = LivePen(Letters(encoding))
    rows = live_rows(circuit, {}, columns, pen, LiveStates(circuit, states.get))
    return "\n".join("".join(strip.text for strip in row) for row in rows)


def found_in(given_: Network) -> Circuit:
    circuit = circuit_of(given_)
    assert isinstance(circuit, Circuit), circuit
    return circuit


@pytest.mark.parametrize(
    ("text", "has", "expected"),
    [
        ("ORG X0, AND NOT M3, OUT Y0", {"X0": 1, "M3": 0, "Y0": 1}, "┣━━┫ ┣━━━━━┫/┣━━━━━(●)"),
        ("ORG X0, AND NOT M3, OUT Y0", {"X0": 1, "M3": 1, "Y0": 0}, "┣━━┫ ┣━━━━━┤/├─────( )"),
        ("ORG X0, AND NOT M3, OUT Y0", {"X0": 0, "M3": 0, "Y0": 0}, "┣━━┤ ├─────┫/┣─────( )"),
        ("ORG X0, AND NOT M3, OUT Y0", {"X0": 1}, "┣━━┫ ┣━━━━━┤/├┄┄┄┄┄( )"),
        ("ORG X0, AND NOT M3, OUT Y0", {}, "┣━━┤ ├┄┄┄┄┄┤/├┄┄┄┄┄( )"),
        ("ORG TU M300, OUT Y0", {"M300": 1, "Y0": 0}, "┣━━┤↑├┄┄┄┄┄( )"),
        ("ORG TU M300, OUT Y0", {"M300": 0, "Y0": 0}, "┣━━┤↑├─────( )"),
        ("ORG X0, LD X1, INV, ANDLD, OUT Y0", {"X0": 0, "X1": 0, "Y0": 0}, "┣━━┤ ├─────┤ ├─────/┄┄┄┄┄( )"),
    ],
)
def test_a_line_looks_like_this(text: str, has: dict[str, int], expected: str) -> None:
    lines = text_of(found_in(network(*text.split(", "))), has).splitlines()
    assert expected in lines


@given(CIRCUITS, st.integers(0, 1 << 32), st.floats(0, 1))
def test_wires_carry_what_leads_to_them(circuit: Circuit, seed: int, share: float) -> None:
    """By the plan's nets alone: no wire is drawn as one that carries, or does not, and is the other."""
    random = Random(seed)  # noqa: S311
    states = random_states(circuit, random)
    known = {name: raw for name, raw in states.items() if random.random() < share}
    shown, power = LiveStates(circuit, known.get), Power(states.get)
    guesses: dict[int, bool] = {}

    def state(leaf: Leaf) -> bool:
        found: State = None
        if leaf.role not in {Role.LINE, Role.OUTPUT}:
            found = power.contact(leaf)
        return guesses.setdefault(leaf.number, random.random() < 0.5) if found is None else found

    if any(leaf.role in {Role.LINE, Role.OUTPUT} or leaf.edge for leaf in circuit.leaves):
        return
    _, carried = carried_by_nets(circuit, plan_of(circuit), state)
    claims = {number: shown.of_net((number,)) for number in carried}
    assert all(claim in {None, carried[number]} for number, claim in claims.items())
    if share == 1:
        assert claims == carried


def drawn_with_anything(given_: Network, seed: int, ways: Iterable[tuple[int, str]] = WAYS) -> None:
    """In widths and both kinds of characters, without states and with them."""
    circuit = found_in(given_)
    states = random_states(circuit, Random(seed))  # noqa: S311
    for columns, encoding in ways:
        lines = [*draw(circuit, {}, columns, Pen(Letters(encoding)))]
        lines += text_of(circuit, states, columns, encoding).splitlines()
        assert max(map(width_of, lines)) <= columns
        "".join(lines).encode(encoding)


def test_every_network_of_the_prints_is_drawn() -> None:
    """But for those of which the prints at hand have a part only, in which OR stands behind a coil."""
    networks = Code.of(tuple(word for vector in PRINTED for word in vector.words)).networks
    whole = [each_ for each_ in networks if isinstance(circuit_of(each_), Circuit)]
    assert len(whole) > 60
    for seed, given_ in enumerate(whole):
        drawn_with_anything(given_, seed)


@pytest.mark.parametrize("ways", [1, night(len(WAYS))])
@each(("number", "vector"), list(enumerate([*PRINTED, *READ])), ids=lambda row: row[1].text)
def test_every_vector_is_drawn(number: int, vector: Vector, ways: int) -> None:
    """By day each in the way whose turn it is."""
    first = number % len(WAYS)
    drawn_with_anything(network_with(vector), 1, (WAYS * 2)[first : first + ways])


@pytest.mark.parametrize("most", [25, night(100)])
@pytest.mark.parametrize("model", [name for name, model in MODELS.items() if model.has_fbs_image])
def test_every_network_of_the_simulators_programs_is_drawn(model: str, most: int) -> None:
    pages = program_of(MODELS[model])
    networks = ProgramFile(model, Program(64 * (len(pages) - 1), tuple(pages))).networks[:most]
    assert len(networks) > 20
    for seed, given_ in enumerate(networks):
        drawn_with_anything(given_, seed)
