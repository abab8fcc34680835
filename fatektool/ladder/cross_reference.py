"""The instructions that read and write each element, and unusual findings.

The memory of an element counts, not only its name: a read of WM0 is a read of M5, a write of DR10 is a write
of R11, a timer's contact and its value are one element. A table (SR, WR, QU) begins at the register in the
instruction, with unknown length: no register after it is reported as unread or unwritten, and none that may
be used by a pointer.
"""

from __future__ import annotations

from bisect import bisect_right
from collections import defaultdict
from dataclasses import dataclass, field
from enum import StrEnum
from typing import TYPE_CHECKING, Final, NamedTuple

from fatektool.ladder.addresses import Area, Span, spans_of

if TYPE_CHECKING:
    from collections.abc import Iterable, Iterator

    from fatektool.ladder.networks import Code


class FindingKind(StrEnum):
    """The kinds of findings about an element."""

    DOUBLE_COIL = "double-coil"
    NEVER_READ = "never-read"
    NEVER_WRITTEN = "never-written"


class InstructionPlace(NamedTuple):
    """An instruction: its network's number and its own, both through the whole program."""

    network: int
    instruction: int


@dataclass
class Uses:
    """The instructions that read and write an element.

    Attributes:
        reads: instructions that depend on it.
        writes: instructions that may change it.
    """

    reads: list[InstructionPlace] = field(default_factory=list)
    writes: list[InstructionPlace] = field(default_factory=list)


class XrefFinding(NamedTuple):
    """A finding.

    Attributes:
        kind: of the finding.
        element: the element.
        where: the instructions that show it.
    """

    kind: FindingKind
    element: str
    where: tuple[InstructionPlace, ...]


class _Access(NamedTuple):
    place: InstructionPlace
    element: str
    spans: tuple[Span, ...]
    reads: bool
    writes: bool
    goes_on: bool
    coil: bool


_FROM_OUTSIDE: Final = "X"  # the machine writes them
_TO_OUTSIDE: Final = "Y"  # the machine reads them
_NOWHERE: Final = 1 << 16
_SYSTEM_RELAYS: Final = Span(Area.BITS, spans_of("M1912")[0].first, spans_of("M2001")[0].end)
_SYSTEM_REGISTERS: Final = Span(Area.BYTES, spans_of("R3840")[0].first, spans_of("R4167")[0].end)


class CrossReference:
    """The elements of a program, and the instructions that use them.

    Args:
        code: the program.
    """

    def __init__(self, code: Code) -> None:
        self._accesses = list(_accesses(code))
        self._spans: dict[str, set[Span]] = defaultdict(set)  # all that is meant by a name, 32 bits or 16
        for access in self._accesses:
            self._spans[access.element].update(access.spans)
        self._index: dict[Area, list[tuple[int, int, _Access]]] = defaultdict(list)
        for access in self._accesses:
            for span in access.spans:
                self._index[span.area].append((span.first, span.end, access))
        for entries in self._index.values():
            entries.sort(key=lambda entry: entry[:2])
        self._longest = {
            area: max(end - first for first, end, _ in entries) for area, entries in self._index.items()
        }
        self._firsts = {area: [first for first, _, _ in entries] for area, entries in self._index.items()}
        self._indexed = _indexed_symbols(code)

    @property
    def elements(self) -> list[str]:
        """The elements in the program, by kind and number."""
        return sorted({access.element for access in self._accesses}, key=_order)

    def uses(self, element: str) -> Uses:
        """The instructions that read and write an element, by its own name or another."""
        return self._uses(spans_of(element))

    def _uses(self, spans: Iterable[Span]) -> Uses:
        found = Uses()
        for access in sorted(self._touching(spans), key=lambda access: access.place):
            if access.reads:
                found.reads.append(access.place)
            if access.writes:
                found.writes.append(access.place)
        return found

    def findings(self) -> list[XrefFinding]:
        """The findings: elements with two coils, without reads or without writes."""
        found = [*self._double_coils()]
        read_on, written_on = self._tables(reads=True), self._tables(reads=False)
        for element in self.elements:
            symbol, number = _order(element)
            if symbol in self._indexed or _is_system(spans_of(element)):
                continue
            uses = self._uses(self._spans[element])
            if not uses.reads and _TO_OUTSIDE not in symbol and number < read_on.get(symbol, _NOWHERE):
                found.append(XrefFinding(FindingKind.NEVER_READ, element, tuple(uses.writes)))
            if not uses.writes and _FROM_OUTSIDE not in symbol and number < written_on.get(symbol, _NOWHERE):
                found.append(XrefFinding(FindingKind.NEVER_WRITTEN, element, tuple(uses.reads)))
        return sorted(
            found, key=lambda finding: (list(FindingKind).index(finding.kind), _order(finding.element))
        )

    def _double_coils(self) -> Iterator[XrefFinding]:
        coils: dict[str, list[InstructionPlace]] = defaultdict(list)
        for access in self._accesses:
            if access.coil:
                coils[access.element].append(access.place)
        for element, places in coils.items():
            if len(places) > 1:
                yield XrefFinding(FindingKind.DOUBLE_COIL, element, tuple(places))

    def _touching(self, spans: Iterable[Span]) -> set[_Access]:
        found = set()
        for span in spans:
            entries = self._index.get(span.area, [])
            if not entries:
                continue
            end = bisect_right(self._firsts[span.area], span.end - 1)
            for place in range(end - 1, -1, -1):
                first, last, access = entries[place]
                if first + self._longest[span.area] <= span.first:
                    break
                if last > span.first:
                    found.add(access)
        return found

    def _tables(self, *, reads: bool) -> dict[str, int]:
        """The beginning of the first table of each kind of element that is read, or written."""
        starts: dict[str, int] = {}
        for access in self._accesses:
            if access.goes_on and (access.reads if reads else access.writes):
                symbol, number = _order(access.element)
                starts[symbol] = min(number, starts.get(symbol, number))
        return starts


def _is_system(spans: Iterable[Span]) -> bool:
    """True for relays and registers that the PLC itself reads or writes."""
    return any(span.meets(_SYSTEM_RELAYS) or span.meets(_SYSTEM_REGISTERS) for span in spans)


def _indexed_symbols(code: Code) -> set[str]:
    """The kinds of registers that an operand with a pointer may be: ``R0V``, ``D0[P2+P0]?``."""
    texts = (operand.text for instruction in code.instructions for operand in instruction.operands)
    return {text[0] for text in texts if text.startswith(("R", "D")) and (text.endswith("V") or "[" in text)}


def _accesses(code: Code) -> Iterator[_Access]:
    for network in code.networks:
        for number, _, instruction in network.places:
            place = InstructionPlace(network.number, number)
            coil = instruction.form.text.startswith("OUT ")
            for access in instruction.accesses:
                yield _Access(place, *access, coil=coil)


def _order(element: str) -> tuple[str, int]:
    symbol = element.rstrip("0123456789")
    return symbol, int(element[len(symbol) :])
