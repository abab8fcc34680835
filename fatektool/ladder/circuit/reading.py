"""A network's instructions -> its circuit, with the stack of blocks.

::

    ORG LD LD TR FO    begin a block on top of the stack         AND OR TU    continue the one on top
    ANDLD ORLD         join the two on top
    OUT SET ..         are on the line, which is then complete: the next block begins another line
    a function         uses all blocks of the stack, one line for each of its inputs

Total: any instructions result in a circuit, or in the reason why there is none. If a rule is broken, there is
no circuit; docs/programs.md has the rules and their sources.
"""

from __future__ import annotations

from dataclasses import dataclass, field
from typing import TYPE_CHECKING, Final, TypeAlias

from fatektool.counts import counted
from fatektool.ladder.circuit.nodes import Block, Box, Circuit, Leaf, Line, Node, Parallel, Series
from fatektool.ladder.circuit.pins import pins_of
from fatektool.ladder.circuit.roles import Role

if TYPE_CHECKING:
    from collections.abc import Callable

    from fatektool.ladder.networks import Network

DEEPEST: Final = 100
"""The most levels of blocks in a circuit; the vendor's software has networks of 16 rows."""
LARGEST: Final = 500
"""The most instructions; the vendor's software has networks of 16 rows and 22 columns."""


@dataclass(frozen=True, slots=True)
class NoCircuit:
    """The reason why a network cannot be drawn.

    Attributes:
        reason: a sentence without a full stop.
        number: the instruction with the error.
    """

    reason: str
    number: int


class _Unclear(Exception):
    """The instructions are not a circuit."""


@dataclass(slots=True)
class _Draft:
    """An incomplete block or line.

    Attributes:
        parts: the parts so far.
        lines: the list for the complete line.
        depth: the levels in it.
        hung: it has a coil or box.
        done: complete: the next instruction may begin another line.
        after: the function at the end of the line, if the state of the line after it is not known.
        level: the number of nested boxes.
    """

    parts: list[_DraftPart]
    lines: list[_Draft]
    depth: int = 1
    hung: bool = False
    done: bool = False
    after: Leaf | None = None
    level: int = 0

    def node(self) -> Node:
        """The parts so far, as one."""
        nodes = [part for part in self.parts if not isinstance(part, _DraftBox)]
        return nodes[0] if len(nodes) == 1 else Series(tuple(nodes))

    def line(self) -> Line:
        """The complete line."""
        return Line(tuple(part.box() if isinstance(part, _DraftBox) else part for part in self.parts))


@dataclass(slots=True)
class _DraftBox:
    """A box whose inputs are still being read."""

    function: Leaf
    inputs: list[_Draft]
    level: int = 0
    outputs: list[_Draft] = field(default_factory=list)

    def box(self) -> Box:
        return Box(
            self.function,
            tuple(each.line() for each in self.inputs),
            tuple(each.line() for each in self.outputs),
        )


_DraftPart: TypeAlias = Node | _DraftBox


def circuit_of(network: Network) -> Circuit | NoCircuit:
    """The circuit of a network, or the reason why there is none."""
    reader = _Reader()
    number = network.first
    if len(network.instructions) > LARGEST:
        return NoCircuit(f"it has more than {LARGEST} instructions", number)
    try:
        for number, _, instruction in network.places:
            reader.take(Leaf(number, instruction))
        return reader.end()
    except _Unclear as why:
        return NoCircuit(str(why), number)


class _Reader:
    """The stack, and the complete lines."""

    def __init__(self) -> None:
        self._stack: list[_Draft] = []
        self._lines: list[_Draft] = []
        self._box: _DraftBox | None = None  # the function whose outputs may follow
        self._stores: dict[int, _Draft] = {}
        self._take: dict[Role, Callable[[Leaf], None]] = {
            Role.ORG: self._begin,
            Role.LD: self._begin,
            Role.STEP: self._begin,
            Role.AND: self._go_on,
            Role.LINE: self._go_on,
            Role.OR: self._or,
            Role.AND_BLOCK: self._and_block,
            Role.OR_BLOCK: self._or_block,
            Role.STORE: self._store,
            Role.RECALL: self._recall,
            Role.OUTPUT: self._output,
            Role.COIL: self._coil,
            Role.FUNCTION: self._function,
            Role.ALONE: self._alone,
            Role.END: self._end,
            Role.MARK: self._mark,
        }

    def take(self, leaf: Leaf) -> None:
        """The next instruction."""
        take = self._take.get(leaf.role)
        if take is None:
            if leaf.role is Role.UNKNOWN:
                raise _Unclear(f"{_text(leaf)} is not known, and its number of words is not known either")
            raise _Unclear(f"the function of {_text(leaf)} is not known")
        take(leaf)

    def end(self) -> Circuit:
        """The circuit, after the last instruction."""
        if len(self._stack) > 1:
            raise _Unclear(f"at its end {_blocks(len(self._stack) - 1)} not connected")
        if self._stack:
            self._flush()
        return Circuit(tuple(draft.line() for draft in self._lines))

    def _begin(self, leaf: Leaf, lines: list[_Draft] | None = None) -> None:
        if self._stack and self._stack[-1].done:
            self._flush()
        if leaf.role is Role.LD and not self._stack and not self._lines:
            raise _nothing_before(leaf)
        if not self._stack and lines is None:
            self._box = None
        self._stack.append(_Draft([leaf], self._lines if lines is None else lines))

    def _flush(self) -> None:
        """Move the line from the stack to the complete lines."""
        draft = self._stack.pop()
        draft.lines.append(draft)

    def _top(self, leaf: Leaf) -> _Draft:
        if not self._stack:
            raise _nothing_before(leaf)
        top = self._stack[-1]
        if top.after is not None:
            raise _Unclear(f"the state of the line from {_text(top.after)} to {_text(leaf)} is not known")
        if self._box is not None and self._stack[0].lines is not self._box.outputs:
            self._box = None  # the line goes on after it
        return top

    def _go_on(self, leaf: Leaf) -> None:
        top = self._top(leaf)
        top.parts.append(leaf)
        top.done = False

    def _or(self, leaf: Leaf) -> None:
        top = self._top(leaf)
        self._parallel(top, leaf, leaf, 1)

    def _parallel(self, draft: _Draft, branch: Node, join: Leaf, depth: int) -> None:
        """Connect a branch in parallel to the whole block so far."""
        head = draft.parts[0]
        if draft.hung or (isinstance(head, Leaf) and head.role is Role.OUTPUT):
            before = "an output of a function" if not draft.hung else "a coil or function"
            raise _Unclear(f"{_text(join)} is after {before}")
        node = draft.node()
        if isinstance(node, Parallel):
            draft.parts = [Parallel((*node.branches, branch))]
            depth += 1
        else:
            draft.parts = [Parallel((node, branch))]
            draft.depth += 1
        self._deepen(draft, depth)

    def _deepen(self, draft: _Draft, depth: int) -> None:
        draft.depth = max(draft.depth, depth)
        if draft.depth > DEEPEST:
            raise _Unclear(f"it is more than {DEEPEST} blocks deep")

    def _blocks(self, join: Leaf) -> tuple[_Draft, Block]:
        """The two on top of the stack, the second as a block."""
        if len(self._stack) < 2:
            raise _Unclear(f"{_text(join)} joins two blocks, but there is only one")
        last = self._stack.pop()
        if last.hung:
            raise _Unclear(f"{_text(join)} is after a coil or function")
        return self._stack[-1], Block(last.node(), join)

    def _and_block(self, join: Leaf) -> None:
        depth = self._stack[-1].depth + 1 if self._stack else 0
        draft, block = self._blocks(join)
        draft.parts.append(block)
        self._deepen(draft, depth)

    def _or_block(self, join: Leaf) -> None:
        depth = self._stack[-1].depth + 1 if self._stack else 0
        draft, block = self._blocks(join)
        self._parallel(draft, block, join, depth)

    def _store(self, leaf: Leaf) -> None:
        top = self._top(leaf)
        top.parts.append(leaf)
        self._stores[leaf.store] = top

    def _recall(self, leaf: Leaf) -> None:
        stored = self._stores.get(leaf.store)
        if stored is None:
            raise _Unclear(f"there is no OUT TR before {_text(leaf)}")
        inside = self._box is not None and stored.lines is self._box.outputs
        self._begin(leaf, stored.lines if inside else None)

    def _output(self, leaf: Leaf) -> None:
        if self._box is None or not (self._stack and self._stack[-1].done):
            raise _Unclear(f"{_text(leaf)} is not after its function")
        level = self._box.level + 1
        self._begin(leaf, self._box.outputs)
        self._stack[-1].level = level
        if level > DEEPEST:
            raise _Unclear(f"more than {DEEPEST} functions are connected in sequence")

    def _coil(self, leaf: Leaf) -> None:
        top = self._top(leaf)
        if len(self._stack) > 1:
            raise _Unclear(f"before {_text(leaf)} {_blocks(len(self._stack) - 1)} not connected")
        top.parts.append(leaf)
        top.hung = top.done = True

    def _function(self, leaf: Leaf) -> None:
        self._top(leaf)
        pins = pins_of(leaf.instruction.form)
        count = len(self._stack)
        if pins is not None and len(pins.inputs) != count:
            has = counted(len(pins.inputs), "input")
            raise _Unclear(f"{_text(leaf)} has {has}, and {_lines(count)} to it")
        first, *more = self._stack
        self._box = _DraftBox(leaf, more, first.level)
        for draft in more:
            draft.lines = self._box.inputs
        first.parts.append(self._box)
        first.hung = first.done = True
        first.after = None if pins is not None and not pins.outputs and not more else leaf
        self._stack = [first]

    def _alone(self, leaf: Leaf) -> None:
        if self._stack and not self._stack[-1].done:
            raise _Unclear(f"before {_text(leaf)} {_blocks(len(self._stack))} not connected")
        if self._stack:
            self._flush()
        self._box = None
        self._lines.append(_Draft([_DraftBox(leaf, [])], self._lines, hung=True, done=True))

    def _end(self, leaf: Leaf) -> None:
        """The end of the program: conditional, if a line leads to it."""
        (self._function if self._stack and not self._stack[-1].done else self._alone)(leaf)

    def _mark(self, leaf: Leaf) -> None:
        if self._box is not None and self._stack and self._stack[0].lines is not self._box.outputs:
            self._box.outputs.append(_Draft([leaf], self._box.outputs))
        elif self._stack:
            self._stack[-1].parts.append(leaf)
        else:
            self._lines.append(_Draft([leaf], self._lines, done=True))


def _nothing_before(leaf: Leaf) -> _Unclear:
    return _Unclear(f"there is no contact before {_text(leaf)}: a network begins with ORG")


def _text(leaf: Leaf) -> str:
    """An instruction for a reason; if it is long, its beginning."""
    text = leaf.instruction.text.removeprefix("~")
    return text if len(text) <= 40 else f"{text[:37]}..."


def _blocks(count: int) -> str:
    return counted(count, "block is", "blocks are")


def _lines(count: int) -> str:
    return counted(count, "line leads", "lines lead")
