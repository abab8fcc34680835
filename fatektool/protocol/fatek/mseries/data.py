"""The data field of each M-series command, request and answer, both ways (M-series paper, section 2.5).

One row of ``_FIELDS`` a command. An answer begins with the error byte, 00 for none; any other stands alone.
Only 4E has none: it answers the very data it was sent. There is no program command: 4F and 50 are FACON's.

53 is listed without a layout. Its answer is taken for FACON's where it has 64 bytes, and marked as assumed;
of any other length it is kept raw.
"""

from __future__ import annotations

from typing import TYPE_CHECKING, Any, Final, NamedTuple, TypeVar, cast

from fatektool.errors import FrameError, PlcRefused, UsageError
from fatektool.protocol.commands import (
    BRIEF_BYTES,
    DETAILED_BYTES,
    Command,
    Control,
    ControlDiscrete,
    Loopback,
    ReadBriefStatus,
    ReadDetailedStatus,
    ReadDisabled,
    ReadDiscretes,
    ReadMixed,
    ReadRegisters,
    Request,
    RunStop,
    WriteDiscretes,
    WriteMixed,
    WriteRegisters,
    require_run_limit,
)
from fatektool.protocol.fatek.mseries.bytes import (
    VALUE_BYTES,
    count_byte,
    element_bytes,
    nothing_after,
    take_bits,
    take_count,
    take_element,
    take_run,
    take_value,
    take_values,
    take_words,
    value_bytes,
    words_bytes,
)
from fatektool.protocol.fatek.mseries.errors import NEXT, meaning_of
from fatektool.protocol.plc_errors import asked
from fatektool.protocol.status import BriefStatus, DetailedStatus, RawStatus

if TYPE_CHECKING:
    from collections.abc import Callable

    from fatektool.protocol.elements import Element

A = TypeVar("A")

_NO_ERROR: Final = b"\x00"


# --- requests -------------------------------------------------------------------------------------


def _parse_empty(make: Callable[[], Request[Any]]) -> Callable[[bytes], Request[Any]]:
    def parse(data: bytes) -> Request[Any]:
        nothing_after(data)
        return make()

    return parse


def _parse_read_run(
    make: Callable[[Element, int], Request[Any]], *, zero_is_256: bool
) -> Callable[[bytes], Request[Any]]:
    def parse(data: bytes) -> Request[Any]:
        element, count, rest = take_run(data, zero_is_256=zero_is_256)
        nothing_after(rest)
        return make(element, count)

    return parse


def _parse_run_stop(data: bytes) -> RunStop:
    if data not in {b"\0", b"\1"}:
        raise FrameError("expected 01 (run) or 00 (stop)", raw=data)
    return RunStop(data == b"\1")


def _parse_control(data: bytes) -> ControlDiscrete:
    if not data or data[0] not in set(Control):
        raise FrameError("expected 01 disable, 02 enable, 03 set or 04 reset", raw=data)
    element, at = take_element(data, 1)
    nothing_after(data[at:])
    return ControlDiscrete(Control(data[0]), element)


def _parse_write_discretes(data: bytes) -> WriteDiscretes:
    element, count, rest = take_run(data, zero_is_256=True)
    if len(rest) != count:
        raise FrameError(f"expected {count} values, got {len(rest)}", raw=rest)
    return WriteDiscretes(element, take_bits(rest))


def _parse_write_registers(data: bytes) -> WriteRegisters:
    element, count, rest = take_run(data, zero_is_256=False)
    values = take_words(rest, element.kind.bits)
    if len(values) != count:
        raise FrameError(f"expected {count} values, got {len(values)}", raw=rest)
    return WriteRegisters(element, values)


def _parse_read_mixed(data: bytes) -> ReadMixed:
    elements = []
    at = 1
    for _ in range(take_count(data)):
        element, at = take_element(data, at)
        elements.append(element)
    nothing_after(data[at:])
    return ReadMixed(tuple(elements))


def _parse_write_mixed(data: bytes) -> WriteMixed:
    items = []
    at = 1
    for _ in range(take_count(data)):
        element, at = take_element(data, at)
        end = at + VALUE_BYTES[element.kind.bits]
        if end > len(data):
            raise FrameError(f"the value of {element} is cut off", raw=data)
        items.append((element, take_value(element, data[at:end])))
        at = end
    nothing_after(data[at:])
    return WriteMixed(tuple(items))


# --- the table ------------------------------------------------------------------------------------


class _Fields(NamedTuple):
    """How one command is written. ``size`` counts an answer's bytes after the error byte."""

    request: Callable[[Any], bytes]
    parse_request: Callable[[bytes], Request[Any]]
    size: Callable[[Any], int]
    parse_answer: Callable[[Any, bytes], Any]
    answer: Callable[[Any, Any], bytes]


def _acknowledged(request: Callable[[Any], bytes], parse_request: Callable[[bytes], Request[Any]]) -> _Fields:
    return _Fields(request, parse_request, lambda _: 0, lambda _r, _d: None, lambda _r, _a: b"")


def _read_bits(make: Callable[[Element, int], Request[Any]]) -> _Fields:
    return _Fields(
        lambda r: count_byte(r.count) + element_bytes(r.first),
        _parse_read_run(make, zero_is_256=True),
        lambda r: int(r.count),
        lambda _, data: take_bits(data),
        lambda _, values: bytes(values),
    )


def _detailed(data: bytes) -> DetailedStatus | RawStatus:
    if len(data) == DETAILED_BYTES:
        return DetailedStatus.parse(data, assumed=True)
    return RawStatus(data)


_FIELDS: Final[dict[int, _Fields]] = {
    Command.BRIEF_STATUS: _Fields(
        lambda _: b"",
        _parse_empty(ReadBriefStatus),
        lambda _: BRIEF_BYTES,
        lambda _, data: BriefStatus.parse(data, m_series=True),
        lambda _, answer: answer.to_bytes(),
    ),
    Command.RUN_STOP: _acknowledged(lambda r: bytes([r.run]), _parse_run_stop),
    Command.CONTROL_DISCRETE: _acknowledged(
        lambda r: bytes([r.control]) + element_bytes(r.element), _parse_control
    ),
    Command.READ_DISABLED: _read_bits(ReadDisabled),
    Command.READ_DISCRETES: _read_bits(ReadDiscretes),
    Command.WRITE_DISCRETES: _acknowledged(
        lambda r: count_byte(len(r.values)) + element_bytes(r.first) + bytes(r.values),
        _parse_write_discretes,
    ),
    Command.READ_REGISTERS: _Fields(
        lambda r: count_byte(r.count) + element_bytes(r.first),
        _parse_read_run(ReadRegisters, zero_is_256=False),
        lambda r: r.count * VALUE_BYTES[r.first.kind.bits],
        lambda r, data: take_words(data, r.first.kind.bits),
        lambda r, values: words_bytes(values, r.first.kind.bits),
    ),
    Command.WRITE_REGISTERS: _acknowledged(
        lambda r: (
            count_byte(len(r.values)) + element_bytes(r.first) + words_bytes(r.values, r.first.kind.bits)
        ),
        _parse_write_registers,
    ),
    Command.READ_MIXED: _Fields(
        lambda r: count_byte(len(r.elements)) + b"".join(map(element_bytes, r.elements)),
        _parse_read_mixed,
        lambda r: sum(VALUE_BYTES[element.kind.bits] for element in r.elements),
        lambda r, data: take_values(r.elements, data),
        lambda r, values: b"".join(map(value_bytes, r.elements, values)),
    ),
    Command.WRITE_MIXED: _acknowledged(
        lambda r: (
            count_byte(len(r.items)) + b"".join(element_bytes(e) + value_bytes(e, v) for e, v in r.items)
        ),
        _parse_write_mixed,
    ),
    Command.LOOPBACK: _Fields(
        lambda r: bytes(r.data),
        Loopback,
        lambda r: len(r.data) - 1,  # no error byte
        lambda _, data: data,
        lambda _, data: bytes(data),
    ),
    Command.DETAILED_STATUS: _Fields(
        lambda _: b"",
        _parse_empty(ReadDetailedStatus),
        lambda _: DETAILED_BYTES,
        lambda _, data: _detailed(data),
        lambda _, answer: answer.raw,
    ),
}

COMMANDS: Final = frozenset(Command(code) for code in _FIELDS)


# --- the four ways --------------------------------------------------------------------------------


def request_data(request: Request[A]) -> bytes:
    """The data field of a request of one of ``COMMANDS``.

    Raises:
        UsageError: a run that is too long, or an element that would be taken for another.
    """
    require_run_limit(request)
    return _FIELDS[request.command].request(request)


def parse_request(command: int, data: bytes) -> Request[object]:
    """The request that a data field holds.

    Raises:
        FrameError: an unknown command, or data that no request of it has.
    """
    fields = _FIELDS.get(command)
    if fields is None:
        raise FrameError(f"command {command:02X} is not in the M-series paper", raw=data)
    try:
        request = fields.parse_request(data)
        require_run_limit(request)
    except UsageError as error:
        raise FrameError(error.message, raw=data) from error
    return request


def answer_size(request: Request[A]) -> int:
    """How many data bytes the good answer to a request has, error byte included; of 53 the likely number."""
    return 1 + _FIELDS[request.command].size(request)


def parse_answer(request: Request[A], data: bytes) -> A:
    """What an answer's data field says to this request.

    Raises:
        PlcRefused: an error code.
        FrameError: no answer to this request, by length or content.
    """
    command = request.command
    fields = _FIELDS[command]
    size = 1 + fields.size(request)
    one_byte_loopback = command == Command.LOOPBACK and size == 1
    if len(data) == 1 and data != _NO_ERROR and not one_byte_loopback:
        code = data[0]
        raise PlcRefused(
            f"the PLC refused to {asked(request)} ({command:02X}): error {code:X}, {meaning_of(code)}",
            code=code,
            command=command,
            hint=NEXT.get(code),
        )
    if command == Command.LOOPBACK:
        return cast("A", data)
    if len(data) != size and (command != Command.DETAILED_STATUS or not data):
        raise FrameError(
            f"answer to {asked(request)}: expected {size} bytes of data, got {len(data)}", raw=data
        )
    if not data.startswith(_NO_ERROR):
        raise FrameError(f"expected the error byte 00 before the data, got {data[0]:02X}", raw=data)
    return cast("A", fields.parse_answer(request, data[1:]))


def answer_data(request: Request[A], answer: A) -> bytes:
    """The data field of the answer to a request, error byte included but for 4E."""
    data = _FIELDS[request.command].answer(request, answer)
    return data if request.command == Command.LOOPBACK else _NO_ERROR + data
