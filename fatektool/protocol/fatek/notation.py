"""The notation of FACON and M-series data fields: counts, elements, values.

Both have the same fields in the same order: FACON as characters, the M-series as bytes. A ``Notation`` is one
of the two, and ``fields`` is the table of all commands for both.
"""

from __future__ import annotations

import struct
from abc import ABC, abstractmethod
from typing import TYPE_CHECKING, ClassVar

from fatektool.errors import FrameError
from fatektool.protocol.commands import MAX_DISCRETES

if TYPE_CHECKING:
    from collections.abc import Iterable, Mapping, Sequence

    from fatektool.protocol.elements import Element


class Notation(ABC):
    """One notation.

    Attributes:
        unit: the name of the bytes on the wire.
        octet: units of one byte of content.
        value_sizes: units of a value, by its bits.
        no_error: before the values of a valid answer.
        error_name: the name of that field.
        bit_alphabet: the valid units of discretes.
        value_alphabet: the valid units of all other values.
    """

    unit: ClassVar[str]
    octet: ClassVar[int]
    value_sizes: ClassVar[Mapping[int, int]]
    no_error: ClassVar[bytes]
    error_name: ClassVar[str]
    bit_alphabet: ClassVar[bytes]
    value_alphabet: ClassVar[bytes]

    # --- different in the two -------------------------------------------------------------------------------

    @abstractmethod
    def octets(self, data: bytes) -> bytes:
        """Write bytes of content."""

    @abstractmethod
    def take_octets(self, raw: bytes) -> bytes:
        """Read bytes of content.

        Raises:
            FrameError: they are invalid.
        """

    @abstractmethod
    def bits(self, values: Iterable[bool]) -> bytes:
        """Write discretes."""

    @abstractmethod
    def take_bits(self, raw: bytes) -> tuple[bool, ...]:
        """Read discretes.

        Raises:
            FrameError: one is neither on nor off.
        """

    @abstractmethod
    def digit(self, value: int) -> bytes:
        """Write a control or error code: FACON's are 0 to F."""

    @abstractmethod
    def shown(self, value: int) -> str:
        """A control or error code, for messages."""

    @abstractmethod
    def count(self, number: int) -> bytes:
        """Write a number of elements, 1 to 256; 256 is 00."""

    @abstractmethod
    def take_count(self, data: bytes) -> int:
        """Read a number of elements, 0 to 255, at the beginning of the data.

        Raises:
            FrameError: there is none.
        """

    @abstractmethod
    def element(self, element: Element) -> bytes:
        """Write an element.

        Raises:
            UsageError: the receiver would read another element.
        """

    @abstractmethod
    def element_size(self, element: Element) -> int:
        """The size of an element, in units."""

    @abstractmethod
    def take_element(self, data: bytes, at: int) -> tuple[Element, int]:
        """Parse one element; returns it and the place after it.

        Raises:
            FrameError: there is none.
        """

    @abstractmethod
    def error_code(self, data: bytes) -> int | None:
        """The error code, if the answer's data is only that; else, or without an error, None."""

    @abstractmethod
    def wrong_error(self, data: bytes) -> FrameError:
        """The error for an answer of the right length that does not begin with ``no_error``."""

    # --- the same for both ----------------------------------------------------------------------------------

    def words(self, values: Sequence[int], bits: int) -> bytes:
        """Write unsigned values of 16 or 32 bits."""
        return self.octets(struct.pack(f">{len(values)}{'I' if bits == 32 else 'H'}", *values))

    def take_words(self, raw: bytes, bits: int) -> tuple[int, ...]:
        """Read unsigned values of 16 or 32 bits."""
        data = self.take_octets(raw)
        size, code = (4, "I") if bits == 32 else (2, "H")
        if len(data) % size:
            raise FrameError(f"expected values of {bits} bits", raw=raw)
        return struct.unpack(f">{len(data) // size}{code}", data)

    def value(self, element: Element, value: int) -> bytes:
        """Write one value of an element's width."""
        if element.kind.bits == 1:
            return self.bits((bool(value),))
        return self.octets(value.to_bytes(element.kind.bits // 8, "big"))

    def take_value(self, element: Element, raw: bytes) -> int:
        """Read one value of an element's width."""
        if element.kind.bits == 1:
            return int(self.take_bits(raw)[0])
        return int.from_bytes(self.take_octets(raw), "big")

    def take_values(self, elements: Iterable[Element], raw: bytes) -> tuple[int, ...]:
        """Read a value for each of these elements."""
        values = []
        at = 0
        for element in elements:
            end = at + self.value_sizes[element.kind.bits]
            values.append(self.take_value(element, raw[at:end]))
            at = end
        return tuple(values)

    def values_size(self, elements: Iterable[Element]) -> int:
        """The size of the values of these elements, in units."""
        return sum(self.value_sizes[element.kind.bits] for element in elements)

    def take_run(self, data: bytes, *, zero_is_256: bool) -> tuple[Element, int, bytes]:
        """Parse number and first element of a run; returns element, number and the rest."""
        count = self.take_count(data)
        if not count and zero_is_256:
            count = MAX_DISCRETES
        element, at = self.take_element(data, self.octet)
        return element, count, data[at:]

    def nothing_after(self, rest: bytes) -> None:
        """Refuse data after the last field."""
        if rest:
            raise FrameError(f"{len(rest)} more {self.unit} than expected", raw=rest)
