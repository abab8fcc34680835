"""Reading elements of any kind, in the fewest bytes.

If the PLC refuses one element, the others are read all the same. When a request for several is refused, the
PLC is asked how many it has (53). Of neighbours past that only the first is asked for; if it is refused, the
others are not asked for. All other elements that were refused together are divided: see ``division.py``.
"""

from __future__ import annotations

from dataclasses import dataclass, field
from itertools import chain, islice
from typing import TYPE_CHECKING, Any, Final

from fatektool.callbacks import ignore
from fatektool.errors import PlcRefused
from fatektool.exchange.batch import proven, read_all, read_until_refused
from fatektool.jobs.elements.division import Division, Refusals
from fatektool.jobs.elements.extent import ask_limits, excluded, extent_of, neighbours
from fatektool.planner import Values, planned_reads, turnaround_bytes
from fatektool.planner.atoms import Atom, atoms_of
from fatektool.protocol.commands import (
    ReadDiscretes,
    ReadMixed,
    ReadRegisters,
    Request,
    WriteDiscretes,
    WriteMixed,
    WriteRegisters,
)
from fatektool.protocol.elements import Element, Stretch

if TYPE_CHECKING:
    from collections.abc import Callable, Iterable, Iterator, Mapping, Sequence

    from fatektool.client import Plc
    from fatektool.jobs.progress import Progress

TYPICAL_TURNAROUND_S: Final = 0.010
"""A PLC answers once a program scan: some milliseconds. The plan hardly depends on it."""


@dataclass(slots=True)
class ElementReading:
    """What was read.

    Attributes:
        values: raw and unsigned, by element; a discrete is 0 or 1.
        errors: for each element without a value: the PLC's error, or why it was not asked for.
        not_asked: those of them that were not asked.
        requests: how many requests it took.
        ended: when the last answer was received, on the transport's clock.
    """

    values: dict[Element, int] = field(default_factory=dict)
    errors: dict[Element, str] = field(default_factory=dict)
    not_asked: set[Element] = field(default_factory=set)
    requests: int = 0
    ended: float = 0.0


def read_elements(
    plc: Plc,
    elements: Iterable[Element | Stretch],
    *,
    limits: Mapping[str, int] | None = None,
    progress: Progress = ignore,
) -> ElementReading:
    """Read elements of any kind.

    Args:
        plc: the PLC.
        elements: in any order, also in stretches, whose elements are named when all is read.
        limits: how many of a kind the PLC has, by symbol; None if it has not been asked.
        progress: called after each answer, with the number of elements.

    Raises:
        LineError: no answer.
    """
    wanted = list(dict.fromkeys(elements))
    count = _Count(wanted, progress)
    reader = _Reader(plc, limits, count)
    reader.read(wanted)
    count.end()
    ended = plc.link.transport.clock()
    answered = named_one_by_one = _each(wanted)
    errors = reader.refusals.errors
    if errors:
        answered = [element for element in named_one_by_one if element not in errors]
        errors = {element: errors[element] for element in named_one_by_one if element in errors}
    value = reader.known.value
    return ElementReading(
        {element: value(element) for element in answered},
        errors,
        reader.refusals.not_asked,
        reader.requests,
        ended,
    )


def _each(elements: Iterable[Element | Stretch]) -> list[Element]:
    """All elements, those of stretches too, once."""
    parts = (each if isinstance(each, Stretch) else (each,) for each in elements)
    return list(dict.fromkeys(chain.from_iterable(parts)))


class _Count:
    """How many elements are read, for the progress.

    Their atoms are counted, as a request may read 16 relays as a word. It may also read more than was asked
    for, and what is refused is read again in parts: so no more are counted than there are.
    """

    def __init__(self, wanted: Sequence[Element | Stretch], progress: Progress) -> None:
        counted = () if progress is ignore else wanted
        counts = [(each.first, each.count) if isinstance(each, Stretch) else (each, 1) for each in counted]
        self._total = sum(count for _, count in counts)
        self._atoms = sum(count * len(atoms_of(first)) for first, count in counts)
        self._progress = progress
        self._done = 0

    def answers_of(self, requests: Sequence[Request[Any]]) -> Callable[[int], None] | None:
        """Called with the number of answers to these requests; None if nobody wants to know."""
        if self._progress is ignore:
            return None
        counted = 0

        def take(answers: int) -> None:
            nonlocal counted
            self._done += sum(map(_size, requests[counted:answers]))
            counted = max(counted, answers)
            self._progress("reading", min(self._done, self._atoms) * self._total // self._atoms, self._total)

        return take

    def end(self) -> None:
        """All is read, or refused."""
        self._progress("reading", self._total, self._total)


def _size(request: Request[Any]) -> int:
    """How many atoms a read asks for."""
    match request:
        case ReadMixed(elements):
            return sum(len(atoms_of(element)) for element in elements)
        case ReadDiscretes(first, count) | ReadRegisters(first, count):
            return count * len(atoms_of(first))
    return 0


class _Reader:
    """Reads, and finds the elements that are refused."""

    def __init__(self, plc: Plc, limits: Mapping[str, int] | None, count: _Count) -> None:
        self._plc = plc
        self._count = count
        self._limits = limits
        self._answers: list[tuple[Request[Any], Any]] = []
        self._fenced = False
        self.known = Values()
        self.refusals = Refusals()
        self.requests = 0

    def read(self, elements: Sequence[Element | Stretch]) -> None:
        """Read all of these, or find out why not."""
        requests = self._plan(elements)
        refused, unasked = self._ask(requests, stop=self._limits is None)
        if not refused:
            return
        wanted = sorted(_each(elements))
        missing = self._missing(wanted)
        if self._limits is None and len(missing) > 1:
            self._limits = ask_limits(self._plc)
            self.requests += 1
            inside = self._leave_out_excluded(missing, wanted)
            if unasked or len(inside) < len(missing):
                refused, _ = self._ask(self._plan(inside))
                missing = self._missing(inside)

        def divide(division: Division) -> None:
            for part in by_request(missing, refused):
                division.divide(part)

        if missing:
            self._search(wanted, divide)

    def _leave_out_excluded(self, missing: Sequence[Element], wanted: Sequence[Element]) -> list[Element]:
        """Ask the first of neighbours that the PLC says it does not have; give what is still to be read."""
        has = self._limits or {}
        outside = [element for element in missing if excluded(element, has)]
        if not outside:
            return list(missing)

        def ask_first(division: Division) -> None:
            for first, *others in neighbours(outside):
                if division.refuses(first):
                    says = f"the PLC has {extent_of(first, has)} by its status (53)"
                    self.refusals.leave_out(others, f"{first} is refused, and {says}")

        self._search(wanted, ask_first)  # what is not refused shows that the PLC has more than it says
        return [element for element in missing if element not in self.refusals.errors]

    def _search(self, wanted: Sequence[Element], work: Callable[[Division], None]) -> None:
        """Ask one thing after the other, each by what was answered before, and have it proven."""
        answers, errors, left_out = self._answers, self.refusals.errors, self.refusals.not_asked

        def search() -> None:
            self.known, self._answers = Values(), []
            for request, answer in answers:
                self._take(request, answer)
            self.refusals = Refusals(dict(errors), set(left_out))
            work(Division(wanted, self._ask_together, self._ask_alone, self.refusals))

        def again() -> None:
            self._fenced = True
            search()
            self._fenced = False

        proven(self._plc.link, search, again)

    def _take(self, request: Request[Any], answer: Any) -> None:
        self._answers.append((request, answer))
        self.known.take(request, answer)

    def _plan(self, elements: Sequence[Element | Stretch]) -> Iterator[Request[Any]]:
        codec = self._plc.link.codec
        return planned_reads(elements, codec, turnaround=turnaround(self._plc), limits=self._limits)

    def _missing(self, elements: Iterable[Element]) -> list[Element]:
        return [element for element in elements if element not in self.known]

    def _ask(
        self, plan: Iterator[Request[Any]], *, stop: bool = False
    ) -> tuple[list[Request[Any]], list[Request[Any]]]:
        """Ask all, or to the first that is refused; give those that are refused, and the rest.

        The plan goes on while the line is busy.
        """
        refused: list[Request[Any]] = []
        requests: list[Request[Any]] = []  # those of the plan that are known and not asked yet

        def more() -> bool:
            known = len(requests)
            requests.extend(islice(plan, 1))
            return len(requests) > known

        while not (stop and refused) and (requests or more()):
            if self._fenced:
                self._plc.link.fence(requests[0])
                answers, refusal = read_until_refused(self._plc.link, requests[:1])
            else:
                answers, refusal = read_until_refused(
                    self._plc.link, requests, self._count.answers_of(requests), more=more
                )
            for request, answer in zip(requests, answers, strict=False):
                self._take(request, answer)
            if refusal is not None:
                refused.append(requests[len(answers)])
            done = len(answers) + (refusal is not None)
            self.requests += done
            del requests[:done]
        return refused, [*requests, *plan]

    def _ask_together(self, elements: Sequence[Element]) -> list[Element]:
        refused, _ = self._ask(self._plan(elements))
        return self._missing(elements) if refused else []

    def _ask_alone(self, element: Element) -> str | None:
        one = element.kind.bits == 1
        request: Request[Any] = ReadDiscretes(element, 1) if one else ReadRegisters(element, 1)
        self.requests += 1
        if self._fenced:
            self._plc.link.fence(request)
        try:
            (answer,) = read_all(self._plc.link, [request])
        except PlcRefused as error:
            return error.message
        self._take(request, answer)
        return None


def turnaround(plc: Plc) -> float:
    """A PLC's typical turnaround, in bytes of its line."""
    return turnaround_bytes(TYPICAL_TURNAROUND_S, plc.link.byte_time_s)


def parts_of(request: Request[Any]) -> Iterator[Element]:
    """The elements that a request reads or writes."""
    match request:
        case ReadMixed(elements):
            yield from elements
        case WriteMixed(items):
            yield from (element for element, _ in items)
        case ReadDiscretes(first, count) | ReadRegisters(first, count):
            yield from (first.after(place) for place in range(count))
        case WriteDiscretes(first, values) | WriteRegisters(first, values):
            yield from (first.after(place) for place in range(len(values)))


def by_request(elements: Sequence[Element], requests: Sequence[Request[Any]]) -> list[list[Element]]:
    """Elements by the request that they are in; what is in none comes last."""
    owner: dict[Atom, int] = {}
    for number, request in enumerate(requests):
        for part in parts_of(request):
            owner |= dict.fromkeys(atoms_of(part), number)
    groups: dict[int, list[Element]] = {}
    for element in elements:
        number = min(owner.get(atom, len(requests)) for atom in atoms_of(element))
        groups.setdefault(number, []).append(element)
    return [groups[number] for number in sorted(groups)]


def named(names: Iterable[str], most: int = 5) -> str:
    """Some names for a message: the first few, and how many more there are."""
    listed = list(names)
    more = f" and {len(listed) - most} more" if len(listed) > most else ""
    return ", ".join(listed[:most]) + more
