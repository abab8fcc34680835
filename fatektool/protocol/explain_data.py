"""What data fields say, the same in every protocol; how many bytes each part takes is the protocol's.

A ``Cutter`` takes a data field apart from the left. A protocol makes one of its own, which knows the sizes.
"""

from __future__ import annotations

from abc import ABC, abstractmethod
from typing import TYPE_CHECKING, Any, ClassVar

from fatektool.protocol.commands import (
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

if TYPE_CHECKING:
    from collections.abc import Iterable

    from fatektool.protocol.commands import Request
    from fatektool.protocol.elements import Element
    from fatektool.protocol.status import BriefStatus, DetailedStatus, StatusFlags

ACKNOWLEDGED = {
    Command.RUN_STOP,
    Command.CONTROL_DISCRETE,
    Command.WRITE_DISCRETES,
    Command.WRITE_REGISTERS,
    Command.WRITE_MIXED,
    Command.WRITE_PAGE,
}
"""The commands whose good answer is the error character or byte alone."""


class Cutter(ABC):
    """Takes a data field apart from the left.

    Attributes:
        octet: how many bytes on the wire one byte of content takes.
        value_sizes: how many bytes a value takes, by its bits.
        unit: what the wire's bytes are called.
    """

    octet: ClassVar[int]
    value_sizes: ClassVar[dict[int, int]]
    unit: ClassVar[str]

    def __init__(self, data: bytes) -> None:
        self.data = data
        self.at = 0
        self.fields: list[Field] = []

    @property
    def rest(self) -> bytes:
        """What is not yet cut."""
        return self.data[self.at :]

    @abstractmethod
    def element_size(self, element: Element) -> int:
        """How many bytes an element takes."""

    @abstractmethod
    def taken_value(self, element: Element, raw: bytes) -> int:
        """The value that these bytes are.

        Raises:
            FrameError: they are none.
        """

    def cut(self, size: int, name: str, meaning: str) -> None:
        """Make the next bytes a field."""
        self.fields.append(Field(name, self.data[self.at : self.at + size], meaning))
        self.at += size

    def octets(self, count: int, name: str, meaning: str) -> None:
        """Make the next bytes of content a field."""
        self.cut(count * self.octet, name, meaning)

    def all(self, name: str, meaning: str) -> None:
        """Make the rest a field."""
        self.cut(len(self.rest), name, meaning)

    def element(self, element: Element, meaning: str = "") -> None:
        """Cut an element off."""
        self.cut(self.element_size(element), "element", meaning or f"{element}")

    def value(self, element: Element, meaning: str) -> None:
        """Cut an element's value off."""
        self.cut(self.value_sizes[element.kind.bits], f"{element}", meaning)

    def page(self, data: bytes) -> None:
        """Cut a page of the program off."""
        first = data[:8].hex(" ", 2).upper()
        self.octets(len(data), "page", f"{len(data) // 2} words, first {first} …")

    def read_values(self, command: int, elements: Iterable[Element]) -> None:
        """Cut the values of a read off, each beside its element.

        Raises:
            FrameError: one of them is no value.
        """
        for element in elements:
            size = self.value_sizes[element.kind.bits]
            value = self.taken_value(element, self.data[self.at : self.at + size])
            if command == Command.READ_DISABLED:
                self.value(element, "disabled" if value else "enabled")
            else:
                self.value(element, shown(element, value))

    def values_size(self, elements: Iterable[Element]) -> int:
        """How many bytes the values of these elements take."""
        return sum(self.value_sizes[element.kind.bits] for element in elements)


def request_fields(request: Request[Any], cutter: Cutter) -> tuple[Field, ...]:  # noqa: C901  # a case a command
    """The data field of a request, divided."""
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
                cutter.value(first.after(place), shown(first, int(value)))
        case ReadMixed(elements):
            cutter.octets(1, "n", f"{len(elements)}")
            for element in elements:
                cutter.element(element)
        case WriteMixed(items):
            cutter.octets(1, "n", f"{len(items)}")
            for element, value in items:
                cutter.element(element)
                cutter.value(element, shown(element, value))
        case Loopback():
            loopback(cutter)
        case ReadPage(page):
            cutter.octets(2, "page number", _page(page))
        case WritePage(page, content):
            cutter.octets(2, "page number", _page(page))
            cutter.page(content)
    return tuple(cutter.fields)


def loopback(cutter: Cutter) -> None:
    """The data of a loopback, of a request as of its answer."""
    cutter.all("test data", f"{len(cutter.data)} {cutter.unit}")


def brief_status(cutter: Cutter, status: BriefStatus) -> None:
    """The three bytes of 40."""
    cutter.octets(1, "status 1", flag_words(status.flags, m_series=status.m_series))
    named = "reserved" if status.m_series else status.model or "a code that names no model"
    cutter.octets(1, "status 2", named)
    cutter.octets(1, "status 3", "reserved")


def detailed_status(cutter: Cutter, status: DetailedStatus) -> None:
    """The 64 bytes of 53, in FACON's layout."""
    system = status.system
    cutter.octets(1, "status 1", flag_words(status.flags, m_series=status.assumed))
    cutter.octets(1, "main unit type", system.unit_type_name or "not in the paper")
    cutter.octets(1, "main unit points", f"{system.points or 'not in the paper'}")
    cutter.octets(1, "OS version", system.os_version)
    cutter.octets(2, "ladder size", f"{system.ladder_words} words")
    for name in list(system.__slots__)[4:]:
        cutter.octets(2, name.replace("_", " "), f"{getattr(system, name)}")
    cutter.all("reserved", "")


def elements_of(asked: Request[Any] | None) -> list[Element]:
    """The elements whose values answer a read; none if it is not known what was asked."""
    match asked:
        case ReadDisabled(first, count) | ReadDiscretes(first, count) | ReadRegisters(first, count):
            return [first.after(place) for place in range(count)]
        case ReadMixed(elements):
            return list(elements)
    return []


def flag_words(flags: StatusFlags, *, m_series: bool = False) -> str:
    """Status byte 1 in words."""
    words = [name.replace("_", " ") for name in flags.__slots__[1:] if getattr(flags, name)]
    if m_series:
        words = ["memory card" if word == "rom pack" else word for word in words]
    return ", ".join(["RUN" if flags.running else "STOP", *words])


def shown(element: Element, value: int) -> str:
    """A value in words."""
    return ("on" if value else "off") if element.kind.bits == 1 else f"{value}"


def _span(first: Element, count: int) -> str:
    return f"{first}" if count == 1 else f"{first} to {first.after(count - 1)}"


def _page(page: int) -> str:
    return f"{page}, the header" if page == 0 else f"{page}"
