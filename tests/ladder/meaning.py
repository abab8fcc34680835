"""What a network does to its coils, worked out twice: by a stack from its instructions, and from its circuit.

Both take the state of each element, and that of each edge, comparison and function's output, as given by one
function of the instruction. So they agree if, and only if, the circuit joins what the instructions join.
"""

from __future__ import annotations

from typing import TYPE_CHECKING

from fatektool.ladder.circuit.nodes import Block, Box, Circuit, Leaf, Line, Parallel, Part, Series
from fatektool.ladder.circuit.roles import PLACES, Role

if TYPE_CHECKING:
    from collections.abc import Callable, Sequence


def by_stack(leaves: Sequence[Leaf], state: Callable[[Leaf], bool]) -> list[tuple[int, tuple[bool, ...]]]:
    """What each coil and function gets, in the order of the code."""
    stack: list[bool] = []
    done = False
    stores: dict[int, bool] = {}
    found = []
    for leaf in leaves:
        role = leaf.role
        if role in {Role.ORG, Role.LD, Role.RECALL, Role.OUTPUT, Role.STEP}:
            if done:
                stack.clear()
            stack.append(stores[leaf.store] if role is Role.RECALL else state(leaf))
            done = False
        elif role is Role.AND:
            stack[-1] &= state(leaf)
            done = False
        elif role is Role.OR:
            stack[-1] |= state(leaf)
        elif role is Role.LINE:
            stack[-1] = _of_the_line(leaf, stack[-1], state)
            done = False
        elif role in {Role.AND_BLOCK, Role.OR_BLOCK}:
            last = stack.pop()
            stack[-1] = stack[-1] and last if role is Role.AND_BLOCK else stack[-1] or last
        elif role is Role.STORE:
            stores[leaf.store] = stack[-1]
        elif role in {Role.COIL, Role.FUNCTION}:
            found.append((leaf.number, tuple(stack)))
            del stack[1:]
            done = True
    return found


def by_circuit(circuit: Circuit, state: Callable[[Leaf], bool]) -> list[tuple[int, tuple[bool, ...]]]:
    """The same from the circuit."""
    run = _Run(state)
    for line in circuit.lines:
        run.line(line)
    return run.found


class _Run:
    def __init__(self, state: Callable[[Leaf], bool]) -> None:
        self.state = state
        self.found: list[tuple[int, tuple[bool, ...]]] = []
        self.stores: dict[int, bool] = {}

    def line(self, line: Line) -> bool:
        return self.row(line.parts, power=True)

    def row(self, parts: Sequence[Part], *, power: bool) -> bool:
        for part in parts:
            power = self.part(part, power=power)
        return power

    def part(self, part: Part, *, power: bool) -> bool:
        match part:
            case Box(function, inputs, outputs):
                self.found.append((function.number, (power, *map(self.line, inputs))))
                for each in outputs:
                    self.line(each)
                return power
            case Series(parts):
                return self.row(parts, power=power)
            case Parallel(branches):
                carried = [self.part(each, power=power) for each in branches]  # stores may be in each
                return any(carried)
            case Block(body):
                return self.part(body, power=True) and power
        return self.leaf(part, power)

    def leaf(self, leaf: Leaf, power: bool) -> bool:
        if leaf.role is Role.COIL:
            self.found.append((leaf.number, (power,)))
        elif leaf.role is Role.STORE:
            self.stores[leaf.store] = power
        elif leaf.role is Role.RECALL:
            return self.stores[leaf.store] and power
        elif leaf.role is Role.LINE:
            return _of_the_line(leaf, power, self.state)
        elif leaf.role in PLACES or leaf.role in {Role.OUTPUT, Role.STEP}:
            return power and self.state(leaf)
        return power


def _of_the_line(leaf: Leaf, power: bool, state: Callable[[Leaf], bool]) -> bool:
    """INV turns it round; an edge is a matter of the scan before, which the state decides."""
    return not power if leaf.instruction.text.endswith("INV") else power and state(leaf)
