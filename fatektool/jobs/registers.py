"""Reading elements of any kind, all that is asked in the fewest bytes.

An element that the PLC refuses does not lose the others: a request that is refused is taken apart until the
refused element stands alone. Only of many neighbours that end past what the PLC has, not every one is asked:
see ``_all_refused``.
"""

from __future__ import annotations

import re
from dataclasses import dataclass, field
from itertools import chain
from typing import TYPE_CHECKING, Any, Final

from fatektool.batch import ask_all
from fatektool.errors import PlcRefused
from fatektool.planner import Values, plan_reads, turnaround_bytes
from fatektool.planner.atoms import Atom, atoms_of
from fatektool.protocol.commands import (
    MAX_DISCRETES,
    Command,
    ReadDisabled,
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
    from collections.abc import Iterable, Iterator, Mapping, Sequence

    from fatektool.client import Plc

TYPICAL_TURNAROUND_S: Final = 0.010
"""A PLC answers once a program scan: some milliseconds. The plan hardly depends on it."""

_MANY: Final = 32
_SAMPLES: Final = 5


@dataclass(slots=True)
class Reading:
    """What was read.

    Attributes:
        values: raw and unsigned, by element; a discrete is 0 or 1.
        errors: what the PLC said of the elements that it refused.
        requests: how many requests it took.
        ended: when the last answer was there, on the transport's clock.
    """

    values: dict[Element, int] = field(default_factory=dict)
    errors: dict[Element, str] = field(default_factory=dict)
    requests: int = 0
    ended: float = 0.0


def read_elements(
    plc: Plc, elements: Iterable[Element | Stretch], *, limits: Mapping[str, int] | None = None
) -> Reading:
    """Read elements of any kind.

    Args:
        plc: the PLC.
        elements: in any order, also in stretches, whose elements are named when all is read.
        limits: how many of a kind the PLC has, by symbol, where that is known.

    Raises:
        LineError: no answer.
    """
    wanted = list(dict.fromkeys(elements))
    reader = _Reader(plc, limits)
    reader.read(wanted)
    reading = reader.reading
    reading.ended = plc.link.transport.clock()
    named_one_by_one = _each(wanted)
    errors = reading.errors
    reading.errors = {element: errors[element] for element in named_one_by_one if element in errors}
    value = reader.known.value
    reading.values = {element: value(element) for element in named_one_by_one if element not in errors}
    return reading


def _each(elements: Iterable[Element | Stretch]) -> list[Element]:
    """All elements, those of stretches too, once."""
    parts = (each if isinstance(each, Stretch) else (each,) for each in elements)
    return list(dict.fromkeys(chain.from_iterable(parts)))


class _Reader:
    """Reads, and takes apart what is refused."""

    def __init__(self, plc: Plc, limits: Mapping[str, int] | None) -> None:
        self._plc = plc
        self._limits = limits
        self.known = Values()
        self.reading = Reading()

    def read(self, elements: Sequence[Element | Stretch]) -> None:
        """Read all of these, or know why not."""
        if len(elements) == 1 and isinstance(elements[0], Element):
            self._read_alone(elements[0])
            return
        requests = plan_reads(
            elements, self._plc.link.codec, turnaround=turnaround(self._plc), limits=self._limits
        )
        refused = self._ask(requests)
        if not refused:
            return
        missing = [element for element in sorted(_each(elements)) if element not in self.known]
        for part in by_request(missing, refused):
            self._take_apart(part)

    def _ask(self, requests: Sequence[Request[Any]]) -> list[Request[Any]]:
        """Ask all, and go on behind one that is refused; give those."""
        refused = []
        while requests:
            answered = 0

            def count(number: int) -> None:
                nonlocal answered
                answered = number
                self.reading.requests += 1

            try:
                self._take(requests, ask_all(self._plc.link, requests, count))
            except PlcRefused:  # those before it are asked again: their answers were not proven yet
                refused.append(requests[answered])
                self.reading.requests += 1
                before = requests[:answered]
                requests = requests[answered + 1 :]
                if before:
                    refused += self._ask(before)
            else:
                break
        return refused

    def _take(self, requests: Sequence[Request[Any]], answers: Sequence[Any]) -> None:
        for request, answer in zip(requests, answers, strict=True):
            self.known.take(request, answer)

    def _take_apart(self, elements: list[Element]) -> None:
        """Read elements whose common request was refused."""
        if len(elements) >= _MANY and self._all_refused(elements):
            return
        left = [e for e in elements if e not in self.known and e not in self.reading.errors]
        if len(left) == 1:
            self.read(left)
        elif left:
            self.read(left[: len(left) // 2])
            self.read(left[len(left) // 2 :])

    def _all_refused(self, elements: list[Element]) -> bool:
        """True if many neighbours, refused together, are each refused: past the PLC's end, or in a gap.

        Asking each of R8072 to R9999 would take minutes on a serial line. So five of them are asked alone,
        first, last and between: if each is refused, so are the others.
        """
        if len({element.symbol for element in elements}) > 1:
            return False
        last = len(elements) - 1
        samples = [elements[last * place // (_SAMPLES - 1)] for place in range(_SAMPLES)]
        for sample in (samples[-1], *samples[:-1]):
            self._read_alone(sample)
            if sample not in self.reading.errors:
                return False
        said = self.reading.errors[samples[0]]
        for element in elements:
            self.reading.errors.setdefault(element, re.sub(rf"\b{samples[0]}\b", str(element), said))
        return True

    def _read_alone(self, element: Element) -> None:
        one = element.kind.bits == 1
        request: Request[Any] = ReadDiscretes(element, 1) if one else ReadRegisters(element, 1)
        link = self._plc.link
        try:
            self.reading.requests += 1
            try:
                self._take([request], ask_all(link, [request]))
            except PlcRefused:
                if not link.counters.trouble:
                    raise
                link.fence(request)  # on a bad line it may have been the answer to an earlier request
                self._take([request], ask_all(link, [request]))
        except PlcRefused as error:
            self.reading.errors[element] = error.message


def turnaround(plc: Plc) -> float:
    """A PLC's typical turnaround, in bytes of its line."""
    return turnaround_bytes(TYPICAL_TURNAROUND_S, plc.link.byte_time_s)


def _parts(request: Request[Any]) -> Iterator[Element]:
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
        for part in _parts(request):
            owner |= dict.fromkeys(atoms_of(part), number)
    groups: dict[int, list[Element]] = {}
    for element in elements:
        number = min(owner.get(atom, len(requests)) for atom in atoms_of(element))
        groups.setdefault(number, []).append(element)
    return [groups[number] for number in sorted(groups)]


def read_disabled(plc: Plc, elements: Iterable[Element]) -> tuple[dict[Element, bool], dict[Element, str]]:
    """Which discretes are disabled, and what the PLC said of those that it refused.

    Nothing is known of any where the protocol has no command for it.

    Args:
        plc: the PLC.
        elements: discretes of one bit.
    """
    flags: dict[Element, bool] = {}
    errors: dict[Element, str] = {}
    if Command.READ_DISABLED not in plc.link.codec.commands:
        return flags, errors
    todo = _runs(elements)
    try:
        requests = [ReadDisabled(first, count) for first, count in todo]
        for (first, _), bits in zip(todo, ask_all(plc.link, requests), strict=True):
            flags |= {first.after(place): bit for place, bit in enumerate(bits)}
    except PlcRefused:
        while todo:
            first, count = todo.pop()
            try:
                (bits,) = ask_all(plc.link, [ReadDisabled(first, count)])
            except PlcRefused as error:
                if count == 1:
                    errors[first] = error.message
                else:
                    half = count // 2
                    todo += [(first, half), (first.after(half), count - half)]
            else:
                flags |= {first.after(place): bit for place, bit in enumerate(bits)}
    return flags, errors


def _runs(elements: Iterable[Element]) -> list[tuple[Element, int]]:
    """Neighbours together, as many as one request asks for."""
    runs: list[tuple[Element, int]] = []
    for element in sorted(set(elements)):
        if runs:
            first, count = runs[-1]
            near = (element.symbol, element.address) == (first.symbol, first.address + count)
            if near and count < MAX_DISCRETES:
                runs[-1] = (first, count + 1)
                continue
        runs.append((element, 1))
    return runs


def named(names: Iterable[str], most: int = 5) -> str:
    """Some names for a message: the first few, and how many more there are."""
    listed = list(names)
    more = f" and {len(listed) - most} more" if len(listed) > most else ""
    return ", ".join(listed[:most]) + more
