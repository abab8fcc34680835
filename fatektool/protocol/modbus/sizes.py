"""How long Modbus requests and answers are, and how much one holds: by kind and number of elements alone.

::

    elements         coils or registers      most read, written
    X Y M S T C      1                       2000, 1968
    WX .. DWC        16, 32                  the same, in coils
    R D RT RC        1                       125, 123
    DR DD DRT        2                       the same, in registers
    DRC              2, and 2 between them   31, 1

Between one 32-bit counter and the one two on, as elements count them, lies another: a run of them is read
over those between, and written one at a time.
"""

from __future__ import annotations

from typing import TYPE_CHECKING, Any, Final

from fatektool.errors import UsageError
from fatektool.protocol.commands import (
    ControlDiscrete,
    ReadDiscretes,
    ReadRegisters,
    Request,
    WriteDiscretes,
    WriteRegisters,
)
from fatektool.protocol.elements import KINDS

if TYPE_CHECKING:
    from fatektool.protocol.elements import Element

_MOST: Final = {True: {True: 1968, False: 2000}, False: {True: 123, False: 125}}
"""How many bits or registers, by: of bits, writes."""


def units(symbol: str, count: int) -> int:
    """How many coils or registers so many elements of a kind take, those between them included."""
    kind = KINDS[symbol]
    if of_bits(symbol):
        return kind.bits * count
    if symbol == "DRC":
        return 4 * count - 2
    return kind.words * count


def of_bits(symbol: str) -> bool:
    """True for discretes and words of them."""
    return KINDS[symbol].bits == 1 or "W" in symbol


def most(symbol: str, *, writes: bool) -> int:
    """How many elements of a kind one request holds."""
    limit = _MOST[of_bits(symbol)][writes]
    if symbol == "DRC":
        return 1 if writes else (limit + 2) // 4
    return limit // units(symbol, 1)


def request_size(request: Request[Any]) -> int:
    """Length of the request's PDU."""
    if not request.writes:
        return 5
    count = units_of(request)
    return 5 if count == 1 else 6 + _bytes(request, count)


def answer_size(request: Request[Any]) -> int:
    """Length of the good answer's PDU."""
    return 5 if request.writes else 2 + _bytes(request, units_of(request))


def _bytes(request: Request[Any], count: int) -> int:
    return (count + 7) // 8 if of_bits(first_of(request).symbol) else 2 * count


def units_of(request: Request[Any]) -> int:
    """How many coils or registers a request takes."""
    return units(first_of(request).symbol, count_of(request))


def first_of(request: Request[Any]) -> Element:
    """The first element that a request names.

    Raises:
        UsageError: Modbus has no such request.
    """
    match request:
        case ReadDiscretes(first) | ReadRegisters(first) | WriteDiscretes(first) | WriteRegisters(first):
            return first
        case ControlDiscrete(_, element):
            return element
    raise UsageError(f"Modbus has no such command: {request.command.words} ({request.command:02X})")


def count_of(request: Request[Any]) -> int:
    """How many elements a request names."""
    match request:
        case ReadDiscretes(_, count) | ReadRegisters(_, count):
            return count
        case WriteDiscretes(_, values) | WriteRegisters(_, values):
            return len(values)
    return 1
