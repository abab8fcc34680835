"""Two programs' code: the networks that differ, and in them the instructions."""

from __future__ import annotations

from dataclasses import dataclass
from enum import StrEnum
from itertools import zip_longest
from typing import TYPE_CHECKING, Final, NamedTuple

from fatektool.ladder.alignment import align

if TYPE_CHECKING:
    from collections.abc import Iterable, Iterator, Sequence

    from fatektool.ladder.instruction import Instruction
    from fatektool.ladder.networks import Code, Network

_MOST_PAIRS: Final = 100_000


class Change(StrEnum):
    """The change of a network."""

    ADDED = "added"
    REMOVED = "removed"
    CHANGED = "changed"


class DiffLine(NamedTuple):
    """A line of a unified diff of instructions.

    Attributes:
        sign: ``-``, ``+`` or a space.
        text: the instruction.
        elements: those in the instruction.
    """

    sign: str
    text: str
    elements: tuple[str, ...]

    def __str__(self) -> str:
        return f"{self.sign}{self.text}"


@dataclass(frozen=True, slots=True)
class NetworkChange:
    """A network that differs.

    Attributes:
        a: the network of the first program; None if it was added.
        b: that of the second; None if it was removed.
        diff: the instructions, as in a unified diff.
    """

    a: Network | None
    b: Network | None
    diff: tuple[DiffLine, ...]

    @property
    def lines(self) -> tuple[str, ...]:
        """The instructions, each after ``-``, ``+`` or a space."""
        return tuple(map(str, self.diff))

    @property
    def change(self) -> Change:
        """The kind of change."""
        if self.a is None:
            return Change.ADDED
        return Change.REMOVED if self.b is None else Change.CHANGED

    @property
    def removed(self) -> frozenset[int]:
        """The numbers of the first program's instructions that the second does not have."""
        return self._numbers(self.a)

    @property
    def added(self) -> frozenset[int]:
        """The numbers of the second program's instructions that the first does not have."""
        return self._numbers(self.b)

    def _numbers(self, network: Network | None) -> frozenset[int]:
        if network is None:
            return frozenset()
        if self.a is None or self.b is None:
            return frozenset(number for number, _, _ in network.places)
        places: set[int] = set()
        for block in align(*([each.words for each in side.instructions] for side in (self.a, self.b))):
            if not block.equal:
                here = (block.a_first, block.a_end) if network is self.a else (block.b_first, block.b_end)
                places.update(range(*here))
        return frozenset(network.first + place for place in places)

    @property
    def name(self) -> str:
        """Its present or previous number: ``N0009``."""
        network = self.b or self.a
        assert network is not None  # noqa: S101  # one of the two is there
        return network.name


def compare_code(a: Code, b: Code) -> tuple[NetworkChange, ...]:
    """The networks that differ, in the order of the programs; empty for the same code."""
    if a.units == b.units:
        return ()
    found: list[NetworkChange] = []
    keys = [[(network.unit, network.words) for network in code.networks] for code in (a, b)]
    for block in align(*keys):
        if not block.equal:
            old, new = a.networks[block.a_first : block.a_end], b.networks[block.b_first : block.b_end]
            found += (_change(*pair) for pair in _pairs(old, new))
    return tuple(found)


def summary(changes: Sequence[NetworkChange], most: int = 6) -> str:
    """The networks as a short text: ``N0009 changed, N0031 added``."""
    parts = [f"{change.name} {change.change}" for change in changes[:most]]
    more = len(changes) - most
    return ", ".join([*parts, f"{more} networks more"] if more > 0 else parts)


def instruction_line(found: Instruction) -> str:
    """An instruction as a line of a comparison; drawing that has no text is shown by its words."""
    return found.text or f"(drawing {' '.join(f'{word:04X}' for word in found.words)})"


def _pairs(old: Sequence[Network], new: Sequence[Network]) -> Iterator[tuple[Network | None, Network | None]]:
    """The pairs of old and new networks, in order: those with the most in common."""
    if len(old) * len(new) > _MOST_PAIRS:
        yield from _in_order(old, new)
        return
    # The best row of pairs ends without the last old one, without the last new one, or with both as a pair.
    best = [[0.0] * (len(new) + 1) for _ in range(len(old) + 1)]
    looks = [_Looks.of(network) for network in new]
    alike = [[here.likeness(there) for there in looks] for here in map(_Looks.of, old)]
    for i in range(1, len(old) + 1):
        for j in range(1, len(new) + 1):
            paired = best[i - 1][j - 1] + alike[i - 1][j - 1] if alike[i - 1][j - 1] else 0.0
            best[i][j] = max(best[i - 1][j], best[i][j - 1], paired)
    row: list[tuple[Network | None, Network | None]] = []
    i, j = len(old), len(new)
    while i or j:
        if i and j and alike[i - 1][j - 1] and best[i][j] == best[i - 1][j - 1] + alike[i - 1][j - 1]:
            i, j = i - 1, j - 1
            row.append((old[i], new[j]))
        elif j and (not i or best[i][j] == best[i][j - 1]):
            j -= 1
            row.append((None, new[j]))
        else:
            i -= 1
            row.append((old[i], None))
    yield from reversed(row)


def _in_order(
    old: Sequence[Network], new: Sequence[Network]
) -> Iterator[tuple[Network | None, Network | None]]:
    """Pairs in order, if there are too many for a comparison of each with each."""
    for here, there in zip_longest(old, new):
        if here is None or there is None:
            yield here, there
        elif here.unit != there.unit:
            yield here, None
            yield None, there
        elif here.words != there.words:
            yield here, there


class _Looks(NamedTuple):
    """The properties by which a network is recognised."""

    unit: int
    instructions: frozenset[tuple[int, ...]]
    elements: frozenset[str]

    @classmethod
    def of(cls, network: Network) -> _Looks:
        found = network.instructions
        return cls(
            network.unit,
            frozenset(each.words for each in found),
            frozenset(element for each in found for element in each.elements),
        )

    def likeness(self, other: _Looks) -> float:
        """How much the two have in common, 0 to 1; 0 if they are not versions of one network."""
        if self.unit != other.unit:
            return 0.0
        share = len(self.instructions & other.instructions)
        about = len(self.elements & other.elements)
        if not share and not about:
            return 0.0
        most = max(len(self.instructions), len(other.instructions))
        return share / most / 2 + about / max(len(self.elements), len(other.elements), 1) / 2


def _change(a: Network | None, b: Network | None) -> NetworkChange:
    if a is None or b is None:
        sign = "-" if b is None else "+"
        network = a or b
        assert network is not None  # noqa: S101  # pairs have one at least
        return NetworkChange(a, b, tuple(_lines(sign, network.instructions)))
    return NetworkChange(a, b, tuple(_changed_lines(a.instructions, b.instructions)))


def _changed_lines(a: Sequence[Instruction], b: Sequence[Instruction]) -> Iterator[DiffLine]:
    for block in align([found.words for found in a], [found.words for found in b]):
        old, new = a[block.a_first : block.a_end], b[block.b_first : block.b_end]
        if block.equal:
            yield from _lines(" ", new)
        elif [found.text for found in old] == [found.text for found in new]:  # drawn in another way
            yield from _lines("-", old, words=True)
            yield from _lines("+", new, words=True)
        else:
            yield from _lines("-", old)
            yield from _lines("+", new)


def _lines(sign: str, instructions: Iterable[Instruction], *, words: bool = False) -> Iterator[DiffLine]:
    for found in instructions:
        shown = f" ({' '.join(f'{word:04X}' for word in found.words)})" if words and found.text else ""
        yield DiffLine(sign, f"{instruction_line(found)}{shown}", found.elements)
