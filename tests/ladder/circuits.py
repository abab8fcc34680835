"""Circuits made at random, of more kinds than the vendor's program makes; networks from texts."""

from __future__ import annotations

from typing import TYPE_CHECKING

from hypothesis import strategies as st

from fatektool.ladder.circuit.nodes import Block, Box, Circuit, Leaf, Line, Node, Parallel, Part, Series
from fatektool.ladder.decode import decode, encode
from fatektool.ladder.networks import Code
from tests.ladder.vectors import PRINTED, READ

if TYPE_CHECKING:
    from fatektool.ladder.instruction import Instruction
    from fatektool.ladder.networks import Network

WORDS = {vector.text: vector.words for vector in (*READ, *PRINTED)}
"""The words of every text that a vector has, and of a few more."""
WORDS |= {"OUT TR 1": (0x01C4,), "LD TR 1": (0x0164,), "AND NOT M3": (0x1398,), "LD X0": (0x0060,)}
WORDS |= {"AND X2": (0x0280,), "OR X2": (0x02A0,)}


def words_of(*texts: str) -> tuple[int, ...]:
    """Code from instructions that vectors have."""
    return tuple(word for text in texts for word in WORDS[text])


def network(*texts: str) -> Network:
    """One network from instructions that vectors have."""
    (found,) = Code.of(words_of(*texts)).networks
    return found


def one(*words: int) -> Instruction:
    (found,) = decode(words)
    return found


def _leaf(*words: int) -> Leaf:
    return Leaf(0, one(*words))


ANDLD, ORLD = _leaf(0x00E2), _leaf(0x23E4)
TR = range(4)


def _at(operation: int, bit: int) -> int:
    return (bit & 0xFF) << 8 | operation << 4 | bit >> 8


BITS = st.sampled_from([0x000, 0x003, 0x104, 0x21E, 0x300, 0x428, 0x810, 0x9B5])


def _of_bits(operation: int) -> st.SearchStrategy[Leaf]:
    return BITS.map(lambda bit: _leaf(_at(operation, bit)))


CONTACTS = _of_bits(4) | _of_bits(5)
EDGES = st.builds(lambda operation, bit: _leaf(0x00E0, _at(operation, bit)), st.sampled_from([4, 5]), BITS)
WIRES = st.sampled_from([_leaf(0xE28F), _leaf(0xE68F), _leaf(0xE79F)])
COMPARISONS = st.sampled_from([_leaf(0x7FF4, 0x2500, 0x9005, 0x0C0A), _leaf(0x7FF6, 0x2300, 0x140A, 0x1500)])
OF_THE_LINE = st.sampled_from([_leaf(0x00EA), _leaf(0x00E8), _leaf(0x00EC)])
STATES = st.sampled_from([_leaf(0x82FC, 0x2B04), _leaf(0xC4FC, 0x2904), _leaf(0xC4FD, 0x9005)])
COILS = STATES | _of_bits(0) | _of_bits(1) | _of_bits(12) | _of_bits(13)
MOVE, TIMER = _leaf(0xACF5, 0x0000, 0xBA15), _leaf(0x80FD, 0x0A00, 0x9003)
PULSES = _leaf(0x1AF5, 0x2814, 0xB815)
SINGLES = CONTACTS | EDGES | WIRES | COMPARISONS


@st.composite
def nodes(draw: st.DrawFn, depth: int = 3) -> Node:
    """What conducts: a leaf, or more."""
    kind = draw(st.integers(0, 2)) if depth else 0
    if kind == 0:
        return draw(SINGLES)
    more = draw(st.lists(SINGLES | OF_THE_LINE | blocks(depth - 1, ANDLD), min_size=1, max_size=3))
    if kind == 1:
        first = draw(nodes(depth - 1))
        return Series((*(first.parts if isinstance(first, Series) else (first,)), *more))
    first = draw(nodes(depth - 1))
    others = draw(st.lists(SINGLES | blocks(depth - 1, ORLD), min_size=1, max_size=3))
    return Parallel((*(first.branches if isinstance(first, Parallel) else (first,)), *others))


def blocks(depth: int, join: Leaf) -> st.SearchStrategy[Node]:
    """What is joined as a block."""
    return st.builds(Block, nodes(depth), st.just(join))


@st.composite
def rows(draw: st.DrawFn, head: Leaf | None = None) -> tuple[Part, ...]:
    """Parts of a line that conduct, from its head on."""
    if head is not None:
        return (head, *draw(st.lists(SINGLES | blocks(1, ANDLD), max_size=2)))
    node = draw(nodes())
    return node.parts if isinstance(node, Series) else (node,)


@st.composite
def circuits(draw: st.DrawFn) -> Circuit:
    """A network's lines: coils on the way, branches that are stored and taken up, functions."""
    lines: list[Line] = []
    stored: list[int] = []
    for number in range(draw(st.integers(1, 3))):
        recalled = draw(st.sampled_from(stored)) if stored and number else None
        head = None if recalled is None else _leaf(_at(6, 0x400 + recalled))
        parts = list(draw(rows(head)))
        if draw(st.booleans()):
            stored.append(draw(st.sampled_from(TR)))
            parts += [_leaf(_at(12, 0x400 + stored[-1])), *draw(st.lists(SINGLES, max_size=2))]
        if draw(st.booleans()):
            parts += [draw(COILS), *draw(st.lists(SINGLES, max_size=1))]
        hung = draw(st.lists(COILS | st.just(Box(MOVE)), max_size=2))
        last = draw(COILS | _timers() | _pulses(stored))
        if isinstance(last, Box) and last.inputs:  # its first input is a line of its own
            hung += draw(st.lists(SINGLES, min_size=1, max_size=2))
        lines.append(Line((*parts, *hung, last)))
    return Circuit(tuple(lines))


def _output(number: int) -> Leaf:
    return _leaf(0xFC6F + (number << 8))


def _timers() -> st.SearchStrategy[Box]:
    coils = st.lists(COILS, min_size=1, max_size=2)
    used = coils.map(lambda found: (Line((_output(0), *found)),))
    return st.builds(lambda lines: Box(TIMER, (), lines), st.just(()) | used)


@st.composite
def _pulses(draw: st.DrawFn, stored: list[int]) -> Box:
    """A function with three inputs, and any of its outputs."""
    inputs = []
    for _ in range(2):
        head = draw(st.sampled_from([None, *stored]))
        parts = draw(rows(None if head is None else _leaf(_at(6, 0x400 + head))))
        inputs.append(Line(parts))
    outputs = [
        Line((_output(number), *draw(st.lists(SINGLES, max_size=2)), draw(COILS)))
        for number in sorted(draw(st.sets(st.integers(0, 2))))
    ]
    return Box(PULSES, tuple(inputs), tuple(outputs))


def coded(circuit_instructions: tuple[Instruction, ...]) -> tuple[Network, ...]:
    """The networks that instructions are, once they have been words."""
    return Code.of(encode(circuit_instructions)).networks
