"""Reading the data of a PLC: registers, relays, current values, and which discretes are disabled.

What ought to be constant (kept without power, settings) is read a second time and compared, as this file may
be its only copy: an error on the line that fits the 8-bit checksum would be written into a PLC years later.
An element whose readings differ is read a third time, and is *moving* unless the line had errors and the last
two readings agree. What is lost without power changes while the PLC runs, so that a second reading proves
nothing: it is read once. Which discretes are disabled is read twice.
"""

from __future__ import annotations

from itertools import chain, groupby
from typing import TYPE_CHECKING, Final, NamedTuple

from fatektool.callbacks import ignore
from fatektool.errors import DataError, NoAnswer, PlcRefused
from fatektool.files.times import utc
from fatektool.jobs.elements.disabled import read_disabled
from fatektool.jobs.elements.extent import limits
from fatektool.jobs.elements.reads import read_elements
from fatektool.jobs.elements.spans import spans_of
from fatektool.jobs.programs.reading import line_trouble
from fatektool.program.data.part import DataPart
from fatektool.program.data.uses import CONSTANT, SYMBOLS, Use, UseSpan, uses_of
from fatektool.protocol.commands import ReadRegisters
from fatektool.protocol.elements import KINDS, Element, Stretch

if TYPE_CHECKING:
    from collections.abc import Container, Iterable, Iterator, Mapping

    from fatektool.client import Plc
    from fatektool.jobs.progress import Progress
    from fatektool.protocol.status import DetailedStatus, System

_CHUNK: Final = 1024
"""Elements between two steps of the bar: sixteen full requests for registers."""
ALL_USES: Final = frozenset(Use)


class Reading(NamedTuple):
    """Values that were read once.

    Attributes:
        values: raw, by element.
        errors: why there is none.
    """

    values: dict[Element, int]
    errors: dict[Element, str]


def read_data(plc: Plc, status: DetailedStatus, progress: Progress = ignore) -> DataPart:
    """Read all data that the PLC has.

    Args:
        plc: the PLC; it may run.
        status: its answer to 53.
        progress: called as it goes on.

    Raises:
        LineError: no answer.
        DataError: which discretes are disabled changes while it is read.
    """
    time = utc()
    counts = data_counts(plc, status.system)
    trouble = line_trouble(plc)
    first = read_values(plc, counts, progress, phase="reading data")
    again = read_values(plc, counts, progress, phase="reading data, pass 2", uses=CONSTANT)
    noisy = line_trouble(plc) != trouble
    values = _Tables(counts)
    values.put(first.values)
    doubtful = [each for each, value in again.values.items() if values.of(each) != value]
    third = read_elements(plc, doubtful).values if doubtful else {}
    moving = [each for each in doubtful if not (noisy and third.get(each) == again.values[each])]
    values.put(again.values)
    values.put(third)
    disabled = _read_disabled_twice(plc, status.system)
    return DataPart(
        time,
        status.flags.running,
        {symbol: tuple(table) for symbol, table in values.tables.items()},
        {str(each): on for each, on in disabled.items()},
        tuple(spans_of(moving)),
        _errors_in_spans(each for each in first.errors.items() if values.of(each[0]) is None),
    )


class _Tables:
    """Values by address, a table for each kind; None for an element without one.

    Elements are not looked up in dictionaries here: there are tens of thousands of them.
    """

    def __init__(self, counts: Mapping[str, int]) -> None:
        self.tables: dict[str, list[int | None]] = {
            symbol: [None] * count for symbol, count in counts.items()
        }

    def put(self, values: Mapping[Element, int]) -> None:
        for element, value in values.items():
            self.tables[element.symbol][element.address] = value

    def of(self, element: Element) -> int | None:
        return self.tables[element.symbol][element.address]


def data_counts(plc: Plc, system: System) -> dict[str, int]:
    """How many elements of each kind there are: by 53, file registers by asking for them.

    Raises:
        LineError: no answer.
    """
    has = limits(system) | {"F": _file_registers(plc)}
    return {symbol: min(has[symbol], KINDS[symbol].last + 1) for symbol in SYMBOLS}


def _file_registers(plc: Plc) -> int:
    """How many file registers F the PLC has, of which 53 says nothing: the first address that is refused.

    A PLC that does not know the kind may be silent instead of refusing it. That is believed if it answers 53
    in between: silence because of the line would make a file without registers that the PLC has.
    """

    def there(address: int) -> bool:
        try:
            plc.link.ask(ReadRegisters(Element("F", address), 1))
        except PlcRefused:
            return False
        return True

    try:
        has_any = there(0)
    except NoAnswer:
        plc.detailed_status()
        try:
            has_any = there(0)
        except NoAnswer:
            plc.detailed_status()
            return 0
    if not has_any:
        return 0
    low, high = 0, KINDS["F"].last + 1
    while high - low > 1:
        middle = (low + high) // 2
        low, high = (middle, high) if there(middle) else (low, middle)
    return high


def read_values(
    plc: Plc,
    counts: Mapping[str, int],
    progress: Progress = ignore,
    *,
    phase: str,
    uses: Container[Use] = ALL_USES,
) -> Reading:
    """Read all elements of some uses once, in the fewest bytes.

    Args:
        plc: the PLC.
        counts: how many there are of each kind.
        progress: called as it goes on.
        phase: what the progress calls it.
        uses: which elements.

    Raises:
        LineError: no answer.
    """
    stretches = [each for symbol in SYMBOLS for each in _stretches(symbol, counts[symbol], uses)]
    total = sum(each.count for each in stretches)
    found = Reading({}, {})
    progress(phase, 0, total)
    for done, chunk in _chunks(stretches):
        reading = read_elements(plc, chunk, limits=counts)
        found.values.update(reading.values)
        found.errors.update(reading.errors)
        progress(phase, done, total)
    return found


def _stretches(symbol: str, count: int, uses: Container[Use]) -> Iterator[Stretch]:
    """The elements of a kind that have such a use, neighbours together."""
    for wanted, group in groupby(uses_of(symbol, count), lambda span: span.use in uses):
        spans = [*group]
        whole = UseSpan(spans[0].first, spans[-1].last, spans[0].use)
        for first in range(whole.first, whole.last + 1, _CHUNK) if wanted else ():
            yield Stretch(Element(symbol, first), min(_CHUNK, whole.last + 1 - first))


def _chunks(stretches: Iterable[Stretch]) -> Iterator[tuple[int, list[Stretch]]]:
    """Stretches for one step each, and how many elements there are up to its end."""
    done, chunk, size = 0, [], 0
    for stretch in stretches:
        chunk.append(stretch)
        done, size = done + stretch.count, size + stretch.count
        if size >= _CHUNK:
            yield done, chunk
            chunk, size = [], 0
    if chunk:
        yield done, chunk


def read_held(plc: Plc, system: System) -> dict[Element, bool]:
    """The disabled discretes, True for on; once. A kind that is refused has none.

    Raises:
        LineError: no answer.
    """
    has = limits(system)
    kinds = (Stretch(Element(symbol, 0), has[symbol]) for symbol in "XYMSTC" if has[symbol])
    wanted = [*chain.from_iterable(kinds)]
    flags, _ = read_disabled(plc, wanted)
    disabled = [element for element in wanted if flags.get(element)]
    on = read_elements(plc, disabled).values if disabled else {}
    return {element: bool(on[element]) for element in disabled if element in on}


def _read_disabled_twice(plc: Plc, system: System) -> dict[Element, bool]:
    first = read_held(plc, system)
    for _ in range(3):
        again = read_held(plc, system)
        if again == first:
            return again
        first = again
    raise DataError(
        "which discretes are disabled changed while it was read: expected two readings in a row that agree",
        hint="is somebody forcing discretes, or does the line have errors? run it again",
    )


def _errors_in_spans(errors: Iterable[tuple[Element, str]]) -> dict[str, str]:
    found: dict[str, str] = {}
    for text, group in groupby(sorted(errors), lambda each: each[1]):
        found |= dict.fromkeys(spans_of(element for element, _ in group), text)
    return found
