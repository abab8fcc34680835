"""The structure of a program's code: instructions in networks, networks in units.

A program has a main unit and a sub unit, each a sequence of networks; the numbers run through both, from 0. A
network begins with a contact that begins a line (ORG, ORGF), a label, or a step (STP, FROM, STPEND); the
first of a unit with any instruction.
"""

from __future__ import annotations

from dataclasses import dataclass
from functools import cached_property
from typing import TYPE_CHECKING

from fatektool.ladder.decode import decode

if TYPE_CHECKING:
    from collections.abc import Iterator, Sequence

    from fatektool.ladder.instruction import Instruction


@dataclass(frozen=True)
class Network:
    """A network.

    Attributes:
        number: from 0, through the whole program.
        first: the number of its first instruction, from 0, through the whole program.
        word: the place of its first word in the code, from 0, the end mark between two units not counted.
        place: the place of its first word in the image.
        unit: 0 for the main unit, 1 for the sub unit.
        instructions: of the network.
    """

    number: int
    first: int
    word: int
    place: int
    unit: int
    instructions: tuple[Instruction, ...]

    @property
    def name(self) -> str:
        """``N0000``."""
        return f"N{self.number:04}"

    @property
    def addresses(self) -> range:
        """Its byte addresses in the image, as in a project."""
        return range(2 * self.place, 2 * (self.place + len(self.words)))

    @cached_property
    def words(self) -> tuple[int, ...]:
        """Its words in order."""
        return tuple(word for instruction in self.instructions for word in instruction.words)

    @property
    def places(self) -> Iterator[tuple[int, int, Instruction]]:
        """Each instruction with its number and the place of its first word."""
        word = self.word
        for number, instruction in enumerate(self.instructions, self.first):
            yield number, word, instruction
            word += len(instruction.words)


@dataclass(frozen=True)
class Code:
    """A program's code; it is decoded when needed.

    Attributes:
        units: the words of the main unit, and those of the sub unit.
        places: the beginning of each in the image, in words.
    """

    units: tuple[tuple[int, ...], ...]
    places: tuple[int, ...]

    @classmethod
    def of(cls, *units: Sequence[int], places: Sequence[int] = (0, 0)) -> Code:
        """Code from words."""
        return cls(tuple(map(tuple, units)), tuple(places))

    @cached_property
    def networks(self) -> tuple[Network, ...]:
        """All networks, of the main unit, then of the sub unit."""
        return tuple(_networks(self.units, self.places))

    @property
    def instructions(self) -> tuple[Instruction, ...]:
        """All instructions in order."""
        return tuple(instruction for network in self.networks for instruction in network.instructions)

    @cached_property
    def words(self) -> tuple[int, ...]:
        """All words in order, without the end mark between the units."""
        return tuple(word for unit in self.units for word in unit)

    @property
    def unknown_words(self) -> int:
        """The number of unknown words."""
        return sum(len(found.words) for found in self.instructions if not found.known)


def _networks(units: Sequence[Sequence[int]], places: Sequence[int]) -> Iterator[Network]:
    number = first = word = 0
    for unit, (words, place) in enumerate(zip(units, places, strict=False)):
        begin = word
        for group in _groups(words):
            done = Network(number, first, word, place + word - begin, unit, group)
            yield done
            number, first, word = number + 1, first + len(group), word + len(done.words)


def _groups(words: Sequence[int]) -> Iterator[tuple[Instruction, ...]]:
    group: list[Instruction] = []
    for instruction in decode(words):
        if group and instruction.form.begins:
            yield tuple(group)
            group = []
        group.append(instruction)
    if group:
        yield tuple(group)
