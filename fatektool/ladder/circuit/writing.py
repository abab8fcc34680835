"""A circuit -> its instructions: the place of a part decides its form."""

from __future__ import annotations

from typing import TYPE_CHECKING

from fatektool.ladder.circuit.nodes import Block, Box, Circuit, Leaf, Line, Parallel, Part, Series
from fatektool.ladder.circuit.roles import PLACES, Role, placed, role_of

if TYPE_CHECKING:
    from collections.abc import Iterator, Sequence

    from fatektool.ladder.instruction import Instruction


def instructions_of(circuit: Circuit) -> tuple[Instruction, ...]:
    """The instructions of a circuit.

    The form of a contact follows from its place: ORG at the beginning of the network, LD at that of a line or
    block, AND in series, OR as a branch.
    """
    written = [each for line in circuit.lines for each in _line(line)]
    if written and role_of(written[0]) is Role.LD:
        written[0] = placed(written[0], Role.ORG)
    return tuple(written)


def _line(line: Line) -> Iterator[Instruction]:
    return _row(line.parts, Role.LD)


def _row(parts: Sequence[Part], first: Role) -> Iterator[Instruction]:
    for number, part in enumerate(parts):
        yield from _part(part, Role.AND if number else first)


def _part(part: Part, place: Role) -> Iterator[Instruction]:
    match part:
        case Leaf(_, instruction):
            yield placed(instruction, place) if part.role in PLACES else instruction
        case Series(parts):
            yield from _row(parts, place)
        case Parallel(branches):
            for number, branch in enumerate(branches):
                yield from _part(branch, Role.OR if number else place)
        case Block(body, join):
            yield from _part(body, Role.LD)
            yield join.instruction
        case Box(function, inputs, outputs):
            for line in inputs:
                yield from _line(line)
            yield function.instruction
            for line in outputs:
                yield from _line(line)
