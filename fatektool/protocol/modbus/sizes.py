"""Lengths and limits of Modbus requests and answers, by kind and number of elements.

::

    elements         coils or registers      most read, written
    X Y M S T C      1                       2000, 1968
    WX .. DWC        16, 32                  the same, in coils
    R D RT RC        1                       125, 123
    DR DD DRT        2                       the same, in registers
    DRC              2, and 2 between them   31, 1

Between a 32-bit counter and the next but one, which is the next element, is another counter: a run is read
with those between, and written one at a time.
"""

from __future__ import annotations

from typing import TYPE_CHECKING, Any, Final

from fatektool.errors import UsageError
from fatektool.protocol.commands import Command
from fatektool.protocol.elements import KINDS
from fatektool.protocol.modbus import pdu as modbus_pdu
from fatektool.protocol.modbus.pdu import EXCEPTION, FUNCTION_WORDS, READS

if TYPE_CHECKING:
    from collections.abc import Callable

    from fatektool.protocol.commands import (
        ControlDiscrete,
        ReadDiscretes,
        ReadRegisters,
        Request,
        WriteDiscretes,
        WriteRegisters,
    )
    from fatektool.protocol.elements import Element

_MOST: Final = {True: {True: 1968, False: 2000}, False: {True: 123, False: 125}}
"""The most bits or registers, by: of bits, writes."""

TELLING: Final = 6
"""The bytes of a PDU that show its length."""

_LAST_EXCEPTION: Final = 0x0B
_MOST_READ: Final = 250
_MOST_WRITTEN: Final = 246


def units(symbol: str, count: int) -> int:
    """The coils or registers of a number of elements of a kind, including those between."""
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
    """The most elements of a kind in one request."""
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
    """Length of a valid answer's PDU."""
    return 5 if request.writes else 2 + _bytes(request, units_of(request))


def _bytes(request: Request[Any], count: int) -> int:
    return (count + 7) // 8 if of_bits(first_of(request).symbol) else 2 * count


def units_of(request: Request[Any]) -> int:
    """The number of coils or registers of a request."""
    return units(first_of(request).symbol, count_of(request))


def first_of(request: Request[Any]) -> Element:
    """The first element of a request.

    Raises:
        UsageError: Modbus has no such request.
    """
    return _run_of(request)[0]


def count_of(request: Request[Any]) -> int:
    """The number of elements of a request."""
    return _run_of(request)[1]


def _run_of(request: Request[Any]) -> tuple[Element, int]:
    run = _RUNS.get(request.command)
    if run is None:
        raise UsageError(f"Modbus has no such command: {request.command.words} ({request.command:02X})")
    return run(request)


def _read_run(request: ReadDiscretes | ReadRegisters) -> tuple[Element, int]:
    return request.first, request.count


def _written_run(request: WriteDiscretes | WriteRegisters) -> tuple[Element, int]:
    return request.first, len(request.values)


def _one(request: ControlDiscrete) -> tuple[Element, int]:
    return request.element, 1


_RUNS: Final[dict[Command, Callable[[Any], tuple[Element, int]]]] = {
    Command.CONTROL_DISCRETE: _one,
    Command.READ_DISCRETES: _read_run,
    Command.WRITE_DISCRETES: _written_run,
    Command.READ_REGISTERS: _read_run,
    Command.WRITE_REGISTERS: _written_run,
}
"""The requests that Modbus has, each with its first element and their number."""

COMMANDS: Final = frozenset(_RUNS)


def pdu_sizes(  # noqa: PLR0911  # a way out a form
    buffer: bytearray, at: int, end: int
) -> tuple[int, ...] | None:
    """The possible lengths of the PDU that begins here; None if not known yet.

    Args:
        buffer: the bytes.
        at: where its function is.
        end: the end of the bytes needed for the length.
    """
    head = buffer[at:end]
    if not head:
        return None
    function = head[0]
    if function & EXCEPTION:
        known = function & ~EXCEPTION in FUNCTION_WORDS
        if len(head) > 1:
            known = known and 1 <= head[1] <= _LAST_EXCEPTION
        return (2,) if known else ()
    if function not in FUNCTION_WORDS:
        return ()
    if function in {modbus_pdu.WRITE_COIL, modbus_pdu.WRITE_REGISTER}:
        return (5,)
    if len(head) < 2:
        return None
    if function in READS:
        even = function in {modbus_pdu.READ_COILS, modbus_pdu.READ_DISCRETE_INPUTS} or head[1] % 2 == 0
        answer = (2 + head[1],) if 1 <= head[1] <= _MOST_READ and even else ()
        return tuple(sorted({5, *answer}))
    if len(head) < 6:
        return None
    return (5, 6 + head[5]) if 1 <= head[5] <= _MOST_WRITTEN else (5,)
