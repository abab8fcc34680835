"""The data field of each command of FACON and the M-series, request and answer, in both directions.

One row for each command, with a ``Notation``. FACON paper, section 4.2; M-series paper, section 2.5. The rows
in which the two differ, status and program, are in ``facon/data`` and ``mseries/data``.
"""

from __future__ import annotations

from typing import TYPE_CHECKING, Any, Final, NamedTuple

from fatektool.errors import FrameError, UsageError
from fatektool.protocol.commands import (
    MAX_DISCRETES,
    MAX_READ_WORDS,
    Command,
    Control,
    ControlDiscrete,
    Loopback,
    ReadDisabled,
    ReadDiscretes,
    ReadMixed,
    ReadRegisters,
    Request,
    RunStop,
    WriteDiscretes,
    WriteMixed,
    WriteRegisters,
)

if TYPE_CHECKING:
    from collections.abc import Callable

    from fatektool.protocol.elements import Element, ElementKind
    from fatektool.protocol.fatek.notation import Notation


class CommandRow(NamedTuple):
    """The format of one command. Sizes are bytes on the wire.

    Attributes:
        request: the data field of a request.
        parse_request: the request of a data field.
        size: of a valid answer's data, without the error before it.
        parse_answer: the answer to this request in the data of a valid answer.
        answer: the data of an answer.
    """

    request: Callable[[Notation, Any], bytes]
    parse_request: Callable[[Notation, bytes], Request[Any]]
    size: Callable[[Notation, Any], int]
    parse_answer: Callable[[Notation, Any, bytes], Any]
    answer: Callable[[Notation, Any, Any], bytes]


def run_limit(kind: ElementKind) -> int:
    """The most elements in a run (43 to 47): 32 of 32 bits, by FACON's rule."""
    return MAX_DISCRETES if kind.bits == 1 else MAX_READ_WORDS // kind.words


def require_run_limit(first: Element, count: int, command: Command) -> None:
    """Check the length of a run; other requests have the same limits in all protocols.

    Raises:
        UsageError: it is too long.
    """
    limit = run_limit(first.kind)
    if count > limit:
        raise UsageError(
            f"{command.words} ({command:02X}) from {first}: expected 1 to {limit} elements, got {count}"
        )


def acknowledged(
    request: Callable[[Notation, Any], bytes], parse_request: Callable[[Notation, bytes], Request[Any]]
) -> CommandRow:
    """A command whose answer is only the error."""
    return CommandRow(
        request, parse_request, lambda _w, _r: 0, lambda _w, _r, _d: None, lambda _w, _r, _a: b""
    )


def parse_empty(make: Callable[[], Request[Any]]) -> Callable[[Notation, bytes], Request[Any]]:
    """A parser of empty data, which makes a request."""

    def parse(w: Notation, data: bytes) -> Request[Any]:
        w.nothing_after(data)
        return make()

    return parse


def _parse_run_stop(w: Notation, data: bytes) -> RunStop:
    if data not in {w.digit(0), w.digit(1)}:
        raise FrameError(f"expected {w.shown(1)} (run) or {w.shown(0)} (stop)", raw=data)
    return RunStop(data == w.digit(1))


def _parse_control(w: Notation, data: bytes) -> ControlDiscrete:
    control = next((control for control in Control if w.digit(control) == data[:1]), None)
    if control is None:
        *most, last = (f"{w.shown(control)} {control.name.lower()}" for control in Control)
        raise FrameError(f"expected {', '.join(most)} or {last}", raw=data)
    element, at = w.take_element(data, 1)
    w.nothing_after(data[at:])
    return ControlDiscrete(control, element)


def _read_run(w: Notation, r: ReadDisabled | ReadDiscretes | ReadRegisters) -> bytes:
    require_run_limit(r.first, r.count, r.command)
    return w.count(r.count) + w.element(r.first)


def _parse_read_run(
    make: Callable[[Element, int], ReadDisabled | ReadDiscretes | ReadRegisters], *, zero_is_256: bool
) -> Callable[[Notation, bytes], Request[Any]]:
    def parse(w: Notation, data: bytes) -> Request[Any]:
        element, count, rest = w.take_run(data, zero_is_256=zero_is_256)
        w.nothing_after(rest)
        request = make(element, count)
        require_run_limit(element, count, request.command)
        return request

    return parse


def _read_bits(make: Callable[[Element, int], ReadDisabled | ReadDiscretes]) -> CommandRow:
    return CommandRow(
        _read_run,
        _parse_read_run(make, zero_is_256=True),
        lambda _, r: int(r.count),
        lambda w, _, raw: w.take_bits(raw),
        lambda w, _, values: w.bits(values),
    )


def _write_discretes(w: Notation, r: WriteDiscretes) -> bytes:
    require_run_limit(r.first, len(r.values), r.command)
    return w.count(len(r.values)) + w.element(r.first) + w.bits(r.values)


def _parse_write_discretes(w: Notation, data: bytes) -> WriteDiscretes:
    element, count, rest = w.take_run(data, zero_is_256=True)
    _as_many(count, len(rest), rest)
    values = w.take_bits(rest)
    request = WriteDiscretes(element, values)
    require_run_limit(element, count, request.command)
    return request


def _write_registers(w: Notation, r: WriteRegisters) -> bytes:
    require_run_limit(r.first, len(r.values), r.command)
    return w.count(len(r.values)) + w.element(r.first) + w.words(r.values, r.first.kind.bits)


def _parse_write_registers(w: Notation, data: bytes) -> WriteRegisters:
    element, count, rest = w.take_run(data, zero_is_256=False)
    values = w.take_words(rest, element.kind.bits)
    _as_many(count, len(values), rest)
    request = WriteRegisters(element, values)
    require_run_limit(element, count, request.command)
    return request


def _as_many(count: int, got: int, raw: bytes) -> None:
    if got != count:
        raise FrameError(f"expected {count} values, got {got}", raw=raw)


def _parse_read_mixed(w: Notation, data: bytes) -> ReadMixed:
    elements = []
    at = w.octet
    for _ in range(w.take_count(data)):
        element, at = w.take_element(data, at)
        elements.append(element)
    w.nothing_after(data[at:])
    return ReadMixed(tuple(elements))


def _parse_write_mixed(w: Notation, data: bytes) -> WriteMixed:
    items = []
    at = w.octet
    for _ in range(w.take_count(data)):
        element, at = w.take_element(data, at)
        end = at + w.value_sizes[element.kind.bits]
        if end > len(data):
            raise FrameError(f"the value of {element} is incomplete", raw=data)
        items.append((element, w.take_value(element, data[at:end])))
        at = end
    w.nothing_after(data[at:])
    return WriteMixed(tuple(items))


ROWS: Final[dict[int, CommandRow]] = {
    Command.RUN_STOP: acknowledged(lambda w, r: w.digit(r.run), _parse_run_stop),
    Command.CONTROL_DISCRETE: acknowledged(
        lambda w, r: w.digit(r.control) + w.element(r.element), _parse_control
    ),
    Command.READ_DISABLED: _read_bits(ReadDisabled),
    Command.READ_DISCRETES: _read_bits(ReadDiscretes),
    Command.WRITE_DISCRETES: acknowledged(_write_discretes, _parse_write_discretes),
    Command.READ_REGISTERS: CommandRow(
        _read_run,
        _parse_read_run(ReadRegisters, zero_is_256=False),
        lambda w, r: r.count * w.value_sizes[r.first.kind.bits],
        lambda w, r, raw: w.take_words(raw, r.first.kind.bits),
        lambda w, r, values: w.words(values, r.first.kind.bits),
    ),
    Command.WRITE_REGISTERS: acknowledged(_write_registers, _parse_write_registers),
    Command.READ_MIXED: CommandRow(
        lambda w, r: w.count(len(r.elements)) + b"".join(map(w.element, r.elements)),
        _parse_read_mixed,
        lambda w, r: w.values_size(r.elements),
        lambda w, r, raw: w.take_values(r.elements, raw),
        lambda w, r, values: b"".join(map(w.value, r.elements, values)),
    ),
    Command.WRITE_MIXED: acknowledged(
        lambda w, r: w.count(len(r.items)) + b"".join(w.element(e) + w.value(e, v) for e, v in r.items),
        _parse_write_mixed,
    ),
    Command.LOOPBACK: CommandRow(
        lambda _, r: bytes(r.data),
        lambda _, data: Loopback(data),
        lambda _, r: len(r.data) - 1,  # no error before it
        lambda _w, _r, raw: raw,
        lambda _w, _r, data: bytes(data),
    ),
}
"""The commands with the same format in both; not status and program."""
