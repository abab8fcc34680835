"""The data fields of FACON requests, read: what the other side of a line asks (FACON paper, section 4.2).

Each function takes a data field and gives the request, or a function that does. All raise ``FrameError`` for
data that no such request has, and ``UsageError`` for what breaks a request's own limits.
"""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

from fatektool.errors import FrameError
from fatektool.protocol.commands import (
    Control,
    ControlDiscrete,
    ReadMixed,
    ReadPage,
    Request,
    RunStop,
    WriteDiscretes,
    WriteMixed,
    WritePage,
    WriteRegisters,
)
from fatektool.protocol.fatek.facon.text import (
    CHARS,
    nothing_after,
    take_bits,
    take_count,
    take_element,
    take_run,
    take_value,
    take_words,
    unhex,
)

if TYPE_CHECKING:
    from collections.abc import Callable

    from fatektool.protocol.elements import Element


def parse_read_run(
    make: Callable[[Element, int], Request[Any]], *, zero_is_256: bool
) -> Callable[[bytes], Request[Any]]:
    """Reads a number and a first element, and makes a request of them."""

    def parse(data: bytes) -> Request[Any]:
        element, count, rest = take_run(data, zero_is_256=zero_is_256)
        nothing_after(rest)
        return make(element, count)

    return parse


def parse_empty(make: Callable[[], Request[Any]]) -> Callable[[bytes], Request[Any]]:
    """Reads nothing."""

    def parse(data: bytes) -> Request[Any]:
        nothing_after(data)
        return make()

    return parse


def parse_run_stop(data: bytes) -> RunStop:
    """41."""
    if data not in {b"0", b"1"}:
        raise FrameError("expected 1 (run) or 0 (stop)", raw=data)
    return RunStop(data == b"1")


def parse_control(data: bytes) -> ControlDiscrete:
    """42."""
    if data[:1] not in {b"1", b"2", b"3", b"4"}:
        raise FrameError("expected 1 disable, 2 enable, 3 set or 4 reset", raw=data)
    element, at = take_element(data, 1)
    nothing_after(data[at:])
    return ControlDiscrete(Control(int(data[:1])), element)


def parse_write_discretes(data: bytes) -> WriteDiscretes:
    """45."""
    element, count, rest = take_run(data, zero_is_256=True)
    if len(rest) != count:
        raise FrameError(f"expected {count} values, got {len(rest)}", raw=rest)
    return WriteDiscretes(element, take_bits(rest))


def parse_write_registers(data: bytes) -> WriteRegisters:
    """47."""
    element, count, rest = take_run(data, zero_is_256=False)
    values = take_words(rest, element.kind.bits)
    if len(values) != count:
        raise FrameError(f"expected {count} values, got {len(values)}", raw=rest)
    return WriteRegisters(element, values)


def parse_read_mixed(data: bytes) -> ReadMixed:
    """48."""
    elements = []
    at = 2
    for _ in range(take_count(data)):
        element, at = take_element(data, at)
        elements.append(element)
    nothing_after(data[at:])
    return ReadMixed(tuple(elements))


def parse_write_mixed(data: bytes) -> WriteMixed:
    """49."""
    items = []
    at = 2
    for _ in range(take_count(data)):
        element, at = take_element(data, at)
        end = at + CHARS[element.kind.bits]
        if end > len(data):
            raise FrameError(f"the value of {element} is cut off", raw=data)
        items.append((element, take_value(element, data[at:end])))
        at = end
    nothing_after(data[at:])
    return WriteMixed(tuple(items))


def parse_page_number(data: bytes) -> int:
    """Four hex digits."""
    page = unhex(data[:4])
    if len(page) != 2:
        raise FrameError("expected a page number of 4 hex digits", raw=data)
    return int.from_bytes(page, "big")


def parse_read_page(data: bytes) -> ReadPage:
    """4F."""
    nothing_after(data[4:])
    return ReadPage(parse_page_number(data))


def parse_write_page(data: bytes) -> WritePage:
    """50."""
    return WritePage(parse_page_number(data), unhex(data[4:]))
