"""Reading and writing elements of any kind, all that is asked in the fewest bytes.

An element that the PLC refuses does not lose the others: a request that is refused is taken apart until the
refused element stands alone.
"""

from __future__ import annotations

from dataclasses import dataclass, field
from typing import TYPE_CHECKING, Any, Final

from fatektool.batch import ask_all
from fatektool.errors import PlcRefused, UsageError
from fatektool.jobs.selection import overlapping
from fatektool.planner import Values, plan_reads, plan_writes, turnaround_bytes
from fatektool.protocol.commands import ReadDiscretes, ReadRegisters, Request, WriteDiscretes, WriteRegisters

if TYPE_CHECKING:
    from collections.abc import Iterable, Mapping, Sequence

    from fatektool.client import Plc
    from fatektool.protocol.elements import Element

TYPICAL_TURNAROUND_S: Final = 0.010
"""A PLC answers once a program scan: some milliseconds. The plan hardly depends on it."""


@dataclass(slots=True)
class Reading:
    """What was read.

    Attributes:
        values: raw and unsigned, by element; a discrete is 0 or 1.
        errors: what the PLC said of the elements that it refused.
        requests: how many requests it took.
    """

    values: dict[Element, int] = field(default_factory=dict)
    errors: dict[Element, str] = field(default_factory=dict)
    requests: int = 0


def read_elements(
    plc: Plc, elements: Iterable[Element], *, limits: Mapping[str, int] | None = None
) -> Reading:
    """Read elements of any kind.

    Args:
        plc: the PLC.
        elements: in any order.
        limits: how many of a kind the PLC has, by symbol, where that is known.

    Raises:
        LineError: no answer.
    """
    wanted = list(dict.fromkeys(elements))
    known = Values()
    reading = Reading()
    _read(plc, wanted, known, reading, limits)
    reading.values = {element: known.value(element) for element in wanted if element not in reading.errors}
    return reading


def _turnaround(plc: Plc) -> float:
    return turnaround_bytes(TYPICAL_TURNAROUND_S, plc.link.byte_time_s)


def _read(
    plc: Plc, elements: list[Element], known: Values, reading: Reading, limits: Mapping[str, int] | None
) -> None:
    """Read all, and take apart what is refused."""
    if len(elements) == 1:
        requests: list[Request[Any]] = [_read_alone(elements[0])]
    else:
        requests = plan_reads(elements, plc.link.codec, turnaround=_turnaround(plc), limits=limits)
    reading.requests += len(requests)
    try:
        for request, answer in zip(requests, ask_all(plc.link, requests), strict=True):
            known.take(request, answer)
    except PlcRefused as error:
        if len(elements) == 1:
            reading.errors[elements[0]] = error.message
            return
    else:
        return
    reading.requests += len(requests)
    for request in requests:
        try:
            known.take(request, plc.link.ask(request))
        except PlcRefused:
            continue
    missing = [element for element in elements if element not in known]
    middle = len(missing) // 2
    for part in (missing[:middle], missing[middle:]):
        if part:
            _read(plc, part, known, reading, limits)


def _read_alone(element: Element) -> Request[Any]:
    return ReadDiscretes(element, 1) if element.kind.bits == 1 else ReadRegisters(element, 1)


@dataclass(frozen=True, slots=True)
class NotTaken:
    """A write that did not take.

    Attributes:
        element: which.
        wanted: what was written, raw.
        got: what it holds instead, raw; None if it cannot be read.
        reason: why, as far as that is known.
    """

    element: Element
    wanted: int
    got: int | None
    reason: str


def write_elements(plc: Plc, items: Sequence[tuple[Element, int]]) -> list[NotTaken]:
    """Write elements of any kind, read all back, and tell what did not take.

    Args:
        plc: the PLC.
        items: elements with raw, unsigned values.

    Raises:
        UsageError: two of them share a discrete or register; nothing was sent.
        LineError: no answer.
    """
    both = overlapping(element for element, _ in items)
    if both is not None:
        raise UsageError(f"{both[0]} and {both[1]} overlap: what should be there?")
    refused: dict[Element, str] = {}
    _write(plc, list(items), refused)
    found = read_elements(plc, [element for element, _ in items])
    failed = []
    for element, wanted in items:
        got = found.values.get(element)
        if got != wanted or element in refused:
            reason = refused.get(element) or found.errors.get(element) or _why(plc, element)
            failed.append(NotTaken(element, wanted, got, reason))
    return failed


def _write(plc: Plc, items: list[tuple[Element, int]], refused: dict[Element, str]) -> None:
    if len(items) == 1:
        requests: list[Request[None]] = [_write_alone(*items[0])]
    else:
        requests = plan_writes(items, plc.link.codec, turnaround=_turnaround(plc))
    again = False
    for request in requests:
        try:
            plc.link.ask(request)
        except PlcRefused as error:
            again = True
            if len(items) == 1:
                refused[items[0][0]] = error.message
                return
    if again:  # writing the same value twice does no harm
        middle = len(items) // 2
        _write(plc, items[:middle], refused)
        _write(plc, items[middle:], refused)


def _write_alone(element: Element, value: int) -> Request[None]:
    if element.kind.bits == 1:
        return WriteDiscretes(element, (bool(value),))
    return WriteRegisters(element, (value,))


def _why(plc: Plc, element: Element) -> str:
    """Why a write that was acknowledged did not take."""
    if element.kind.bits == 1:
        try:
            if plc.read_disabled(element, 1)[0]:
                return "it is disabled: 'fatektool discrete enable' gives it back"
        except PlcRefused:
            pass
    if element.symbol.endswith("X"):
        return "an input follows its terminal unless it is disabled"
    return "acknowledged, but it holds something else: read-only, or the program writes it too"
