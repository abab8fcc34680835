"""The data fields of FACON requests and answers, divided and explained."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any, Final

from fatektool.errors import FrameError
from fatektool.protocol.commands import (
    COMMAND_WORDS,
    PAGE_BYTES,
    Command,
    ControlDiscrete,
    Loopback,
    ReadDisabled,
    ReadDiscretes,
    ReadMixed,
    ReadPage,
    ReadRegisters,
    RunStop,
    WriteDiscretes,
    WriteMixed,
    WritePage,
    WriteRegisters,
)
from fatektool.protocol.explain import Field
from fatektool.protocol.facon_text import CHARS, HEX_DIGITS, element_text, take_value, unhex
from fatektool.protocol.plc_errors import MEANINGS
from fatektool.protocol.status import BriefStatus, DetailedStatus, StatusFlags

if TYPE_CHECKING:
    from collections.abc import Iterable

    from fatektool.protocol.commands import Request
    from fatektool.protocol.elements import Element

_ACKNOWLEDGED: Final = {
    Command.RUN_STOP,
    Command.CONTROL_DISCRETE,
    Command.WRITE_DISCRETES,
    Command.WRITE_REGISTERS,
    Command.WRITE_MIXED,
    Command.WRITE_PAGE,
}

_READS: Final[dict[int, tuple[bytes, int]]] = {
    Command.READ_DISABLED: (b"01", 1),
    Command.READ_DISCRETES: (b"01", 1),
    Command.READ_REGISTERS: (HEX_DIGITS, 4),
    Command.READ_MIXED: (HEX_DIGITS, 1),
}
"""The characters that an answer's values are written in, and the fewest that a value takes."""

_MOST_CHARS: Final = 256
"""What the values of any read take at most: 256 discretes, or 64 words."""

_WHOLE: Final[dict[int, int]] = {Command.READ_PAGE: 256, Command.DETAILED_STATUS: 128}


class _Cutter:
    """Takes a data field apart from the left."""

    def __init__(self, data: bytes) -> None:
        self.data = data
        self.at = 0
        self.fields: list[Field] = []

    def cut(self, chars: int, name: str, meaning: str) -> None:
        self.fields.append(Field(name, self.data[self.at : self.at + chars], meaning))
        self.at += chars

    def element(self, element: Element, meaning: str = "") -> None:
        self.cut(len(element_text(element)), "element", meaning or f"{element}")

    def value(self, element: Element, value: int) -> None:
        self.cut(CHARS[element.kind.bits], f"{element}", _shown(element, value))

    def page(self, data: bytes) -> None:
        self.cut(2 * len(data), "page", f"{len(data) // 2} words, first {data[:8].hex(' ', 2).upper()} …")


def request_fields(  # noqa: C901  # a case a command
    request: Request[Any], data: bytes
) -> tuple[Field, ...]:
    """The data field of a request, divided."""
    cutter = _Cutter(data)
    match request:
        case RunStop(run):
            cutter.cut(1, "control", "RUN" if run else "STOP")
        case ControlDiscrete(control, element):
            cutter.cut(1, "control", control.name.lower())
            cutter.element(element)
        case ReadDisabled(first, count) | ReadDiscretes(first, count) | ReadRegisters(first, count):
            cutter.cut(2, "n", f"{count}")
            cutter.element(first, _span(first, count))
        case WriteDiscretes(first, values) | WriteRegisters(first, values):
            cutter.cut(2, "n", f"{len(values)}")
            cutter.element(first, _span(first, len(values)))
            for place, value in enumerate(values):
                cutter.value(first.after(place), int(value))
        case ReadMixed(elements):
            cutter.cut(2, "n", f"{len(elements)}")
            for element in elements:
                cutter.element(element)
        case WriteMixed(items):
            cutter.cut(2, "n", f"{len(items)}")
            for element, value in items:
                cutter.element(element)
                cutter.value(element, value)
        case Loopback():
            cutter.cut(len(data), "test data", f"{len(data)} characters")
        case ReadPage(page):
            cutter.cut(4, "page number", _page(page))
        case WritePage(page, content):
            cutter.cut(4, "page number", _page(page))
            cutter.page(content)
    return tuple(cutter.fields)


def answer_fields(command: int, data: bytes, asked: Request[Any] | None) -> tuple[Field, ...]:
    """The data field of an answer, divided.

    Args:
        command: the command's code.
        data: the field.
        asked: the request it answers, if that is known.

    Raises:
        FrameError: no answer to this command has such data.
    """
    cutter = _Cutter(data)
    if command == Command.LOOPBACK:
        cutter.cut(len(data), "test data", f"{len(data)} characters")
        return tuple(cutter.fields)
    if len(data) == 1 and data != b"0":
        if data not in HEX_DIGITS:
            raise FrameError("the error character is no hex digit", raw=data)
        meaning = MEANINGS.get(int(data, 16), "a code that no paper lists")
        cutter.cut(1, "error", f"REFUSED: {meaning}")
        return tuple(cutter.fields)
    if command not in COMMAND_WORDS:
        raise FrameError(f"command {command:02X} is not in the paper", raw=data)
    if len(data) != _WHOLE.get(command):  # those two may come without the error character
        if not data.startswith(b"0"):
            raise FrameError("an answer begins with its error character", raw=data)
        cutter.cut(1, "error", "none")
    _values(cutter, command, data[cutter.at :], asked)
    return tuple(cutter.fields)


def _values(cutter: _Cutter, command: int, rest: bytes, asked: Request[Any] | None) -> None:
    if command in _ACKNOWLEDGED:
        if rest:
            raise FrameError("an acknowledgement has no data", raw=rest)
    elif command == Command.BRIEF_STATUS:
        brief = BriefStatus.parse(unhex(rest))
        cutter.cut(2, "status 1", flag_words(brief.flags))
        cutter.cut(2, "status 2", brief.model or "a code that names no model")
        cutter.cut(2, "status 3", "reserved")
    elif command == Command.DETAILED_STATUS:
        _detailed(cutter, DetailedStatus.parse(unhex(rest)))
    elif command == Command.READ_PAGE:
        page = unhex(rest)
        if len(page) != PAGE_BYTES:
            raise FrameError(f"expected a page of {PAGE_BYTES} bytes, got {len(page)}", raw=rest)
        cutter.page(page)
    else:
        _read(cutter, command, rest, list(_elements(asked)))


def _read(cutter: _Cutter, command: int, rest: bytes, elements: list[Element]) -> None:
    """The values of a read; ``elements`` is empty if it is not known what was asked."""
    characters, fewest = _READS[command]
    if not 0 < len(rest) <= _MOST_CHARS or len(rest) % fewest or rest.translate(None, characters):
        raise FrameError("no answer to a read has such data", raw=rest)
    if not elements:
        cutter.cut(len(rest), "values", "of elements that the request names")
        return
    chars = sum(CHARS[element.kind.bits] for element in elements)
    if len(rest) != chars:
        raise FrameError(f"expected {chars} characters of values, as was asked, got {len(rest)}", raw=rest)
    for element in elements:
        value = take_value(element, cutter.data[cutter.at : cutter.at + CHARS[element.kind.bits]])
        if command == Command.READ_DISABLED:
            cutter.cut(1, f"{element}", "disabled" if value else "enabled")
        else:
            cutter.value(element, value)


def _elements(asked: Request[Any] | None) -> Iterable[Element]:
    match asked:
        case ReadDisabled(first, count) | ReadDiscretes(first, count) | ReadRegisters(first, count):
            return (first.after(place) for place in range(count))
        case ReadMixed(elements):
            return elements
    return ()


def _detailed(cutter: _Cutter, status: DetailedStatus) -> None:
    system = status.system
    cutter.cut(2, "status 1", flag_words(status.flags))
    cutter.cut(2, "main unit type", system.unit_type_name or "not in the paper")
    cutter.cut(2, "main unit points", f"{system.points or 'not in the paper'}")
    cutter.cut(2, "OS version", system.os_version)
    cutter.cut(4, "ladder size", f"{system.ladder_words} words")
    for name in list(system.__slots__)[4:]:
        cutter.cut(4, name.replace("_", " "), f"{getattr(system, name)}")
    cutter.cut(len(cutter.data) - cutter.at, "reserved", "")


def flag_words(flags: StatusFlags) -> str:
    """Status byte 1 in words."""
    words = [name.replace("_", " ") for name in flags.__slots__[1:] if getattr(flags, name)]
    return ", ".join(["RUN" if flags.running else "STOP", *words])


def _span(first: Element, count: int) -> str:
    return f"{first}" if count == 1 else f"{first} to {first.after(count - 1)}"


def _page(page: int) -> str:
    return f"{page}, the header" if page == 0 else f"{page}"


def _shown(element: Element, value: int) -> str:
    return ("on" if value else "off") if element.kind.bits == 1 else f"{value}"
