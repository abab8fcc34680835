"""A plan says what its circuit says, and its characters join what the plan joins."""

from __future__ import annotations

from itertools import pairwise
from random import Random
from typing import TYPE_CHECKING

import pytest
from hypothesis import assume, given
from hypothesis import strategies as st

from fatektool.ladder.circuit.nodes import Circuit, Leaf
from fatektool.ladder.circuit.reading import circuit_of
from fatektool.ladder.circuit.roles import Role
from fatektool.ladder.circuit.writing import instructions_of
from fatektool.ladder.drawing.layout import aligned, plan_of
from fatektool.ladder.drawing.plan import RAIL, Net, Plan
from fatektool.ladder.drawing.text.bands import cuts_of
from fatektool.ladder.drawing.text.cells import Writer
from fatektool.ladder.drawing.text.letters import Letters
from fatektool.ladder.drawing.text.pen import Pen
from fatektool.ladder.drawing.text.sheet import Sheet
from fatektool.ladder.networks import Code
from tests.ladder.circuits import WORDS, circuits, coded
from tests.ladder.drawing.wiring import RAIL_END, by_characters, by_plan
from tests.ladder.meaning import by_circuit
from tests.ladder.vectors import PRINTED, READ

if TYPE_CHECKING:
    from collections.abc import Callable

    from tests.ladder.drawing.wiring import Terminal


def numbered(circuit: Circuit) -> Circuit:
    """The same with a number for each instruction."""
    (network,) = coded(instructions_of(circuit))
    found = circuit_of(network)
    assert isinstance(found, Circuit)
    return found


CIRCUITS = circuits().map(numbered)


@given(CIRCUITS)
def test_each_instruction_that_shows_stands_in_the_plan_once(circuit: Circuit) -> None:
    plan = plan_of(circuit)
    there = [cell.leaf.number for cell in plan.cells] + [box.leaf.number for box in plan.boxes]
    assert len(there) == len(set(there))
    hidden = {Role.AND_BLOCK, Role.OR_BLOCK, Role.OUTPUT, Role.MARK, Role.STORE, Role.RECALL}
    must = {leaf.number for leaf in circuit.leaves if leaf.role not in hidden and not leaf.is_wire}
    gaps = {leaf.number for leaf in circuit.leaves if leaf.is_gap}
    assert must - gaps <= set(there)


@given(CIRCUITS)
def test_nothing_stands_on_anything_else(circuit: Circuit) -> None:
    for plan in (plan_of(circuit), aligned(plan_of(circuit))):
        places = [(cell.row, cell.column) for cell in plan.cells]
        places += [(wire.row, column) for wire in plan.wires for column in range(wire.first, wire.end)]
        places += [(row, box.column) for box in plan.boxes for row in range(box.row, box.row + box.rows)]
        assert len(places) == len(set(places))


@given(CIRCUITS)
def test_what_is_joined_is_what_carries_the_same(circuit: Circuit) -> None:
    """Wires that meet have one net; a branch of wire makes one of what is before it and behind it."""
    assume(not any(leaf.is_wire for leaf in circuit.leaves))
    for plan in (plan_of(circuit), aligned(plan_of(circuit))):
        carried = nets_of(plan)
        for joined in by_plan(plan):
            assert len({carried[terminal] for terminal in joined if terminal in carried}) <= 1


def nets_of(plan: Plan) -> dict[Terminal, Net]:
    """What the plan says that each place carries."""
    found: dict[Terminal, Net] = {RAIL_END: RAIL}
    for cell in plan.cells:
        found[cell.leaf.number, "left"] = cell.net
    for box in plan.boxes:
        for side, pins in (("input", box.inputs), ("output", box.outputs)):
            for pin in pins:
                if pin.net is not None:
                    found[box.leaf.number, f"{side} {pin.number} {pin.row}"] = pin.net
    return found


@given(CIRCUITS, st.integers(0))
def test_a_plan_does_what_its_circuit_does(circuit: Circuit, states: int) -> None:
    """By its nets alone: a leaf carries on what leads to it, if it conducts."""
    assume(all(not leaf.instruction.text.endswith("INV") for leaf in circuit.leaves))

    def state(leaf: Leaf) -> bool:
        return leaf.is_wire or (bool(states >> leaf.number & 1) and not leaf.is_gap)

    reached, _ = carried_by_nets(circuit, plan_of(circuit), state)
    assert reached == by_circuit(circuit, state)


def carried_by_nets(
    circuit: Circuit, plan: Plan, state: Callable[[Leaf], bool]
) -> tuple[list[tuple[int, tuple[bool, ...]]], dict[int, bool]]:
    """What each coil and function gets, and what goes on behind each leaf."""
    cells = {cell.leaf.number: cell for cell in plan.cells}
    boxes = {box.leaf.number: box for box in plan.boxes}
    carried: dict[int, bool] = {}
    stores: dict[int, bool] = {}
    found = []

    def power_of(net: Net | None) -> bool:
        return net is not None and (net == RAIL or any(carried[number] for number in net))

    for leaf in circuit.leaves:
        if leaf.number in boxes:
            pins = boxes[leaf.number].inputs
            found.append((leaf.number, tuple(power_of(pin.net) for pin in pins)))
        elif leaf.role is Role.OUTPUT:
            carried[leaf.number] = state(leaf)
        elif leaf.number in cells:
            power = power_of(cells[leaf.number].net)
            if leaf.role is Role.COIL:
                found.append((leaf.number, (power,)))
            elif leaf.role is Role.STORE:
                stores[leaf.store] = power
            elif leaf.role is Role.RECALL:
                power = power and stores[leaf.store]
            else:
                power = power and state(leaf)
            carried[leaf.number] = power
    return found, carried


@given(CIRCUITS, st.integers(40, 300))
def test_the_characters_join_what_the_plan_joins(circuit: Circuit, columns: int) -> None:
    plan = plan_of(circuit)
    for each in (plan, aligned(plan)):
        sheet = Sheet(each, Writer(Pen(Letters()), {}, 60))
        cuts = list(pairwise(cuts_of(each, sheet.widths, columns)))
        assert by_characters(sheet, cuts) == by_plan(each)


PIECES = [vector.words for vector in (*PRINTED, *READ) if vector.words[0] & 0xF0 not in {0x40, 0x50}]
OFTEN = ("LD X0", "LD TR 0", "OUT TR 0", "LD TR 1", "OUT TR 1", "FO 0", "ORLD", "ANDLD", "OUT Y0")


@pytest.mark.parametrize("seed", range(4))
def test_whatever_the_instructions_are_they_come_back_and_the_drawing_joins_what_they_join(seed: int) -> None:
    """Rows of any instructions: most break a rule, and some are networks that nobody thinks of."""
    random = Random(seed)  # noqa: S311  # a fixed seed
    pieces = [*PIECES, *[WORDS[text] for text in OFTEN] * (len(PIECES) // len(OFTEN))]
    drawn = 0
    while drawn < 100:
        words = [0x0040, *(word for _ in range(random.randrange(1, 25)) for word in random.choice(pieces))]
        for network in Code.of(words).networks:
            circuit = circuit_of(network)
            if not isinstance(circuit, Circuit):
                continue
            drawn += 1
            assert instructions_of(circuit) == network.instructions
            for plan in (plan_of(circuit), aligned(plan_of(circuit))):
                sheet = Sheet(plan, Writer(Pen(Letters()), {}, 60))
                cuts = list(pairwise(cuts_of(plan, sheet.widths, 60)))
                assert by_characters(sheet, cuts) == by_plan(plan)
