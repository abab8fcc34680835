"""The parts of a circuit.

::

    Circuit   lines, in the order of their instructions
    Line      parts from left to right: conducting parts, and outputs connected to the line
    Series    parts in series             Parallel   parts in parallel
    Block     a part with its own LD, and the ANDLD or ORLD that joins it with the part before it
    Leaf      one instruction: a contact, a comparison, a wire, a coil ..
    Box       a function: its further input lines, and its output lines

``ORG X0, OR Y4, AND NOT M421, OUT Y4`` is ``Line(Parallel(X0, Y4), M421, Y4)``: the coil is a part of the
line, and the parts after it continue from the same point.

A line conducts from left to right. A line with a contact at its beginning begins at the rail, one with ``LD
TR n`` at ``OUT TR n`` in another line, one with ``FO n`` at an output of its box, one with STP or FROM at a
step. In a block, ``LD TR n`` is a contact with the stored state.

Every leaf has the number of its instruction, which is unique in the program. Data of an instruction (the
state of its element, a change) are stored separately, by that number.
"""

from __future__ import annotations

from dataclasses import dataclass
from typing import TYPE_CHECKING, TypeAlias

from fatektool.ladder.addresses import DRAWING, OUTPUTS, STORES, bit_name
from fatektool.ladder.circuit.roles import Role, role_of

if TYPE_CHECKING:
    from collections.abc import Iterator

    from fatektool.ladder.instruction import Instruction


@dataclass(frozen=True, slots=True)
class Leaf:
    """One instruction.

    Attributes:
        number: of the instruction, through the whole program.
        instruction: the instruction.
    """

    number: int
    instruction: Instruction

    @property
    def role(self) -> Role:
        """Its role in the circuit."""
        return role_of(self.instruction)

    @property
    def is_wire(self) -> bool:
        """True for SHORT: it always conducts."""
        return self._is_drawing and not self.is_inverted

    @property
    def is_gap(self) -> bool:
        """True for OPEN: it never conducts."""
        return self._is_drawing and self.is_inverted

    @property
    def is_inverted(self) -> bool:
        """True for NOT."""
        return " NOT " in self.instruction.form.text

    @property
    def edge(self) -> str:
        """``TU`` or ``TD`` for a contact that conducts for a scan; else empty."""
        words = self.instruction.form.text.split()
        return words[1] if len(words) > 2 and words[1] in {"TU", "TD"} else ""

    @property
    def element(self) -> str | None:
        """The element of a contact or coil; None if it has none."""
        bit = self.instruction.bit
        name = None if bit is None else bit_name(bit)
        return None if name is None else name.element

    @property
    def store(self) -> int:
        """The n of ``TR n``."""
        bit = self.instruction.bit
        assert bit is not None  # noqa: S101  # asked of such leaves alone
        return bit - STORES.start

    @property
    def output(self) -> int:
        """The n of ``FO n``."""
        bit = self.instruction.bit
        assert bit is not None  # noqa: S101  # asked of such leaves alone
        return bit - OUTPUTS.start

    @property
    def _is_drawing(self) -> bool:
        return self.instruction.bit is not None and self.instruction.bit in DRAWING


@dataclass(frozen=True, slots=True)
class Series:
    """Parts in series: it conducts if all do. After the first there are only leaves and blocks."""

    parts: tuple[Node, ...]


@dataclass(frozen=True, slots=True)
class Parallel:
    """Branches in parallel: it conducts if one does. After the first there are only leaves and blocks."""

    branches: tuple[Node, ...]


@dataclass(frozen=True, slots=True)
class Block:
    """A part with its own LD, which is joined with the part before it.

    Attributes:
        body: the part.
        join: the ANDLD or ORLD.
    """

    body: Node
    join: Leaf


@dataclass(frozen=True, slots=True)
class Box:
    """A function.

    Attributes:
        function: its instruction.
        inputs: its input lines after the first.
        outputs: the lines from its outputs, and their branches.
    """

    function: Leaf
    inputs: tuple[Line, ...] = ()
    outputs: tuple[Line, ...] = ()


Node: TypeAlias = Leaf | Series | Parallel | Block
Part: TypeAlias = Node | Box


@dataclass(frozen=True, slots=True)
class Line:
    """A line, from its beginning to its end."""

    parts: tuple[Part, ...]

    @property
    def head(self) -> Leaf | None:
        """Its first instruction, if it is not in a parallel part; else None."""
        first = self.parts[0]
        if isinstance(first, Box):
            return first.function
        return first if isinstance(first, Leaf) else None


@dataclass(frozen=True, slots=True)
class Circuit:
    """A network's lines."""

    lines: tuple[Line, ...]

    @property
    def leaves(self) -> Iterator[Leaf]:
        """Its instructions, in the order of the code."""
        for line in self.lines:
            yield from leaves_of(line)


def leaves_of(part: Part | Line) -> Iterator[Leaf]:
    """The instructions of a part or a line, in the order of the code."""
    match part:
        case Leaf():
            yield part
        case Series(parts) | Line(parts) | Parallel(parts):
            for each in parts:
                yield from leaves_of(each)
        case Block(body, join):
            yield from leaves_of(body)
            yield join
        case Box(function, inputs, outputs):
            for line in inputs:
                yield from leaves_of(line)
            yield function
            for line in outputs:
                yield from leaves_of(line)
