"""Explanations of the data fields of FACON and M-series requests and answers.

A ``Cutter`` divides a data field from the left, by its notation.
"""

from __future__ import annotations

from typing import TYPE_CHECKING, Any, Final

from fatektool.errors import FrameError
from fatektool.protocol.commands import (
    MAX_DISCRETES,
    MAX_READ_WORDS,
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
from fatektool.protocol.status import BriefStatus, DetailedStatus

if TYPE_CHECKING:
    from collections.abc import Iterable

    from fatektool.protocol.commands import Request
    from fatektool.protocol.elements import Element
    from fatektool.protocol.fatek.codec import FatekCodec
    from fatektool.protocol.fatek.fields import CommandRow
    from fatektool.protocol.fatek.notation import Notation
    from fatektool.protocol.status import StatusFlags

_ACKNOWLEDGED: Final = {
    Command.RUN_STOP,
    Command.CONTROL_DISCRETE,
    Command.WRITE_DISCRETES,
    Command.WRITE_REGISTERS,
    Command.WRITE_MIXED,
    Command.WRITE_PAGE,
}
"""The commands whose valid answer is only the error character or byte."""

_OF_BITS: Final = {Command.READ_DISABLED, Command.READ_DISCRETES}


class Cutter:
    """Divides a data field from the left.

    Args:
        notation: of the field.
        data: the field.
    """

    def __init__(self, notation: Notation, data: bytes) -> None:
        self.notation = notation
        self.data = data
        self.at = 0
        self.fields: list[Field] = []

    @property
    def rest(self) -> bytes:
        """The bytes that are not yet divided."""
        return self.data[self.at :]

    def cut(self, size: int, name: str, meaning: str) -> None:
        """Make the next bytes a field."""
        self.fields.append(Field(name, self.data[self.at : self.at + size], meaning))
        self.at += size

    def octets(self, count: int, name: str, meaning: str) -> None:
        """Make the next bytes of content a field."""
        self.cut(count * self.notation.octet, name, meaning)

    def all(self, name: str, meaning: str) -> None:
        """Make the rest a field."""
        self.cut(len(self.rest), name, meaning)

    def element(self, element: Element, meaning: str = "") -> None:
        """Make an element a field."""
        self.cut(self.notation.element_size(element), "element", meaning or f"{element}")

    def value(self, element: Element, meaning: str) -> None:
        """Make an element's value a field."""
        self.cut(self.notation.value_sizes[element.kind.bits], f"{element}", meaning)

    def page(self, data: bytes) -> None:
        """Make a page of the program a field."""
        first = data[:8].hex(" ", 2).upper()
        self.octets(len(data), "page", f"{len(data) // 2} words, first {first} …")

    def read_values(self, command: int, elements: Iterable[Element]) -> None:
        """Make the values of a read fields, each with its element.

        Raises:
            FrameError: one of them is not a value.
        """
        for element in elements:
            size = self.notation.value_sizes[element.kind.bits]
            value = self.notation.take_value(element, self.data[self.at : self.at + size])
            if command == Command.READ_DISABLED:
                self.value(element, "disabled" if value else "enabled")
            else:
                self.value(element, _shown(element, value))


def request_fields(  # noqa: C901  # a case a command
    codec: FatekCodec, request: Request[Any], data: bytes
) -> tuple[Field, ...]:
    """The data field of a request, as fields."""
    cutter = Cutter(codec.data.notation, data)
    match request:
        case RunStop(run):
            cutter.cut(1, "control", "RUN" if run else "STOP")
        case ControlDiscrete(control, element):
            cutter.cut(1, "control", control.name.lower())
            cutter.element(element)
        case ReadDisabled(first, count) | ReadDiscretes(first, count) | ReadRegisters(first, count):
            cutter.octets(1, "n", f"{count}")
            cutter.element(first, _span(first, count))
        case WriteDiscretes(first, values) | WriteRegisters(first, values):
            cutter.octets(1, "n", f"{len(values)}")
            cutter.element(first, _span(first, len(values)))
            for place, value in enumerate(values):
                cutter.value(first.after(place), _shown(first, int(value)))
        case ReadMixed(elements):
            cutter.octets(1, "n", f"{len(elements)}")
            for element in elements:
                cutter.element(element)
        case WriteMixed(items):
            cutter.octets(1, "n", f"{len(items)}")
            for element, value in items:
                cutter.element(element)
                cutter.value(element, _shown(element, value))
        case Loopback():
            _loopback(cutter)
        case ReadPage(page):
            cutter.octets(2, "page number", _page(page))
        case WritePage(page, content):
            cutter.octets(2, "page number", _page(page))
            cutter.page(content)
    return tuple(cutter.fields)


def answer_fields(
    codec: FatekCodec, command: int, data: bytes, asked: Request[Any] | None
) -> tuple[Field, ...]:
    """The data field of an answer, as fields.

    Args:
        codec: FACON's or the M-series'.
        command: the command's code.
        data: the field.
        asked: the request it answers, if that is known.

    Raises:
        FrameError: no answer to this command has such data.
    """
    notation = codec.data.notation
    cutter = Cutter(notation, data)
    if command == Command.LOOPBACK:
        _loopback(cutter)
        return tuple(cutter.fields)
    if len(data) == 1 and data != notation.no_error:
        code = notation.error_code(data)
        if code is None:
            raise FrameError(f"the {notation.error_name} is not a hex digit", raw=data)
        cutter.cut(1, "error", f"REFUSED: {codec.error_text(code)}")
        return tuple(cutter.fields)
    row = codec.data.rows.get(command)
    if row is None:
        raise FrameError(f"command {command:02X} is not in the paper", raw=data)
    if not (command in codec.data.error_optional and len(data) == row.size(notation, None)):
        if not data.startswith(notation.no_error):
            raise FrameError(f"expected the {notation.error_name} first", raw=data)
        cutter.cut(1, "error", "none")
    _values(cutter, command, row, asked)
    return tuple(cutter.fields)


def _values(cutter: Cutter, command: int, row: CommandRow, asked: Request[Any] | None) -> None:
    """The data after the error in a valid answer."""
    rest = cutter.rest
    if command in _ACKNOWLEDGED:
        if rest:
            raise FrameError("expected no data in an acknowledgement", raw=rest)
    elif command in {Command.BRIEF_STATUS, Command.DETAILED_STATUS}:
        _status(cutter, row.parse_answer(cutter.notation, None, rest))
    elif command == Command.READ_PAGE:
        page = cutter.notation.take_octets(rest)
        if len(page) != PAGE_BYTES:
            raise FrameError(f"expected a page of {PAGE_BYTES} bytes, got {len(page)}", raw=rest)
        cutter.page(page)
    else:
        _read(cutter, command, _elements_of(asked))


def _read(cutter: Cutter, command: int, elements: list[Element]) -> None:
    """The values of a read; ``elements`` is empty if the request is not known."""
    notation = cutter.notation
    word = notation.value_sizes[16]
    fewest = word if command == Command.READ_REGISTERS else 1
    most = MAX_DISCRETES if command in _OF_BITS else MAX_READ_WORDS * word
    alphabet = notation.bit_alphabet if command in _OF_BITS else notation.value_alphabet
    rest = cutter.rest
    if not 0 < len(rest) <= most or len(rest) % fewest or rest.translate(None, alphabet):
        raise FrameError("invalid data for the answer to a read", raw=rest)
    if not elements:
        cutter.all("values", "of the elements in the request")
        return
    size = notation.values_size(elements)
    if len(rest) != size:
        raise FrameError(
            f"expected {size} {notation.unit} of values, as requested, got {len(rest)}", raw=rest
        )
    cutter.read_values(command, elements)


def _loopback(cutter: Cutter) -> None:
    """The data of a loopback, of a request or its answer."""
    cutter.all("test data", f"{len(cutter.data)} {cutter.notation.unit}")


def _status(cutter: Cutter, status: object) -> None:
    """The answer to 40 or 53."""
    match status:
        case BriefStatus():
            _brief_status(cutter, status)
        case DetailedStatus():
            _detailed_status(cutter, status)
        case _:
            cutter.all("status", "in a layout that no paper describes")


def _brief_status(cutter: Cutter, status: BriefStatus) -> None:
    """The three bytes of 40."""
    cutter.octets(1, "status 1", _flag_words(status.flags, m_series=status.m_series))
    named = "reserved" if status.m_series else status.model or "a code that names no model"
    cutter.octets(1, "status 2", named)
    cutter.octets(1, "status 3", "reserved")


def _detailed_status(cutter: Cutter, status: DetailedStatus) -> None:
    """The 64 bytes of 53, in FACON's layout."""
    system = status.system
    cutter.octets(1, "status 1", _flag_words(status.flags, m_series=status.assumed))
    cutter.octets(1, "main unit type", system.unit_type_name or "not in the paper")
    cutter.octets(1, "main unit points", f"{system.points or 'not in the paper'}")
    cutter.octets(1, "OS version", system.os_version)
    cutter.octets(2, "ladder size", f"{system.ladder_words} words")
    for name in list(system.__slots__)[4:]:
        cutter.octets(2, name.replace("_", " "), f"{getattr(system, name)}")
    cutter.all("reserved", "")


def _elements_of(asked: Request[Any] | None) -> list[Element]:
    """The elements of a read; none if the request is not known."""
    match asked:
        case ReadDisabled(first, count) | ReadDiscretes(first, count) | ReadRegisters(first, count):
            return [first.after(place) for place in range(count)]
        case ReadMixed(elements):
            return list(elements)
    return []


def _flag_words(flags: StatusFlags, *, m_series: bool = False) -> str:
    """Status byte 1 as text."""
    words = [name.replace("_", " ") for name in flags.__slots__[1:] if getattr(flags, name)]
    if m_series:
        words = ["memory card" if word == "rom pack" else word for word in words]
    return ", ".join(["RUN" if flags.running else "STOP", *words])


def _shown(element: Element, value: int) -> str:
    """A value as text."""
    return ("on" if value else "off") if element.kind.bits == 1 else f"{value}"


def _span(first: Element, count: int) -> str:
    return f"{first}" if count == 1 else f"{first} to {first.after(count - 1)}"


def _page(page: int) -> str:
    return f"{page}, the header" if page == 0 else f"{page}"
