"""Explanations of Modbus frames: every byte belongs to a field with a meaning.

Requests and answers have similar forms. Which one a frame is, is known from the direction in a trace; else
from the form; and if both are possible, from the requests before it. An answer to a read has no address: its
values are named by the request before it, if there is one. Elements are those of the standard map.
"""

from __future__ import annotations

from dataclasses import replace
from typing import TYPE_CHECKING, Final, NamedTuple

from fatektool.errors import FrameError
from fatektool.protocol.explain import Explanation, Field, FrameRole
from fatektool.protocol.modbus import pdu as modbus_pdu
from fatektool.protocol.modbus.data import AREAS, exception_text
from fatektool.protocol.modbus.framing import LAST_STATION
from fatektool.protocol.modbus.map import STANDARD, Reference
from fatektool.protocol.modbus.pdu import EXCEPTION, FUNCTION_WORDS, OF_BITS, READS, Pdu

if TYPE_CHECKING:
    from collections.abc import Iterable, Iterator

    from fatektool.protocol.codec import Decoder, Frame
    from fatektool.protocol.modbus.codec import ModbusCodec
    from fatektool.protocol.modbus.framing import FramePart

_PIECE: Final = 1 << 15
"""The bytes given to a decoder at once: it keeps at most 64 KiB, and a record of a trace may have more."""


class _Part(NamedTuple):
    """A part of a PDU: its name, its length in bytes, its meaning."""

    name: str
    size: int
    meaning: str


class ModbusExplainer:
    """Explains frames in one framing, piece by piece, in the order in which they were sent."""

    def __init__(self, codec: ModbusCodec) -> None:
        self._framing = codec.framing
        self._head = sum(part.size for part in codec.framing.before)
        self._last: dict[tuple[int, int, int], Pdu] = {}

    @property
    def form(self) -> str:
        """The form of a frame, as text."""
        return self._framing.form

    @property
    def binary(self) -> bool:
        """False for the characters of ASCII."""
        return self._framing.octet == 1

    def explain(self, data: bytes, role: FrameRole = FrameRole.EITHER) -> Iterator[Explanation]:
        """Explain all frames in a piece of the trace, and the bytes outside frames.

        Args:
            data: the bytes.
            role: REQUEST or ANSWER if the direction is known.
        """
        decoder = self._framing.decoder()
        for at in range(0, len(data), _PIECE):
            decoder.feed(data[at : at + _PIECE])
            yield from self._frames(decoder, role)
        if decoder.expect_no_more():
            yield from self._frames(decoder, role)

    def _frames(self, decoder: Decoder, role: FrameRole) -> Iterator[Explanation]:
        while True:
            try:
                frame = decoder.next_frame()
            except FrameError as error:
                whole = (Field("bytes", error.raw, error.message),)
                yield Explanation(FrameRole.BROKEN, error.raw, whole, fault=error.message)
                continue
            if frame is None:
                return
            yield self._frame(frame, role)

    def _frame(self, frame: Frame, role: FrameRole) -> Explanation:
        key = (frame.station, frame.command, frame.number)
        role, said, fault = _understood(frame.data, role, asked=key in self._last)
        if said is None:
            parts = [_Part("data", len(frame.data) - 1, "in a form that this function does not have")]
        elif said.exception:
            self._last.pop(key, None)
            parts = [_Part("exception", 1, f"REFUSED: {exception_text(said.exception)}")]
        elif role is FrameRole.ANSWER:
            parts = _answer_parts(said, self._last.pop(key, None))
        else:
            self._last[key] = said
            parts = _request_parts(said)
        return Explanation(
            role,
            frame.raw,
            tuple(self._fields(frame, parts)),
            frame.station,
            frame.command,
            True if self._framing.after else None,
            fault,
        )

    def _fields(self, frame: Frame, parts: list[_Part]) -> Iterator[Field]:
        yield from _around(self._framing.before, frame.raw[: self._head])
        function = frame.data[0]
        words = FUNCTION_WORDS.get(frame.command, "not in the map")
        refused = ", refused" if function & EXCEPTION else ""
        at = self._head
        for part in (
            _Part("station", 1, self._who(frame.station)),
            _Part("function", 1, f"{words}{refused}"),
            *parts,
        ):
            end = at + part.size * self._framing.octet
            if part.size:
                yield Field(part.name, frame.raw[at:end], part.meaning)
            at = end
        yield from _around(self._framing.after, frame.raw[at:])

    def _who(self, station: int) -> str:
        """A station as text."""
        if station in self._framing.own_units:
            return f"{station}, the PLC at this address"
        if not station:
            return "broadcast to all PLCs, none answers"
        if station > LAST_STATION and self._framing.data_bits is not None:
            return f"{station}, reserved on serial lines"
        return f"{station}"


def _around(parts: Iterable[FramePart], raw: bytes) -> Iterator[Field]:
    """The fields before the station, or after the PDU."""
    at = 0
    for part in parts:
        content = raw[at : at + part.size]
        yield Field(part.name, content, part.meaning(content))
        at += part.size


def _understood(pdu: bytes, role: FrameRole, *, asked: bool) -> tuple[FrameRole, Pdu | None, str | None]:
    """The role and contents of a PDU, or what is wrong with it."""
    found: dict[FrameRole, Pdu] = {}
    fault = None
    for kind, parse in (
        (FrameRole.REQUEST, modbus_pdu.parse_request),
        (FrameRole.ANSWER, modbus_pdu.parse_answer),
    ):
        if role in {kind, FrameRole.EITHER}:
            try:
                found[kind] = parse(pdu)
            except FrameError as error:
                fault = error.message
    if not found:
        return role, None, fault
    first = FrameRole.ANSWER if asked and FrameRole.ANSWER in found else next(iter(found))
    return first, found[first], None


def _request_parts(said: Pdu) -> list[_Part]:
    function, offset = said.function, said.offset
    if function in {modbus_pdu.WRITE_COIL, modbus_pdu.WRITE_REGISTER}:
        return _one_written(said)
    parts = [_Part("address", 2, f"{_named(function, offset)}, {_reference(function, offset)}")]
    count = len(said.bits) or len(said.registers) or said.count
    last = f" to {_named(function, offset + count - 1)}" if count > 1 else ""
    parts.append(_Part("count", 2, f"{count}: {_named(function, offset)}{last}"))
    if function in READS:
        return parts
    size = (count + 7) // 8 if function in OF_BITS else 2 * count
    return [*parts, _Part("n", 1, f"{size} bytes"), *_values(said, function, offset)]


def _answer_parts(said: Pdu, asked: Pdu | None) -> list[_Part]:
    function = said.function
    if function in {modbus_pdu.WRITE_COIL, modbus_pdu.WRITE_REGISTER}:
        return _one_written(said)
    if function not in READS:
        return [
            _Part("address", 2, f"{_named(function, said.offset)}, {_reference(function, said.offset)}"),
            _Part("count", 2, f"{said.count} written"),
        ]
    size = len(said.bits) // 8 if function in OF_BITS else 2 * len(said.registers)
    if asked is not None and function in OF_BITS and (asked.count + 7) // 8 == size:
        said = replace(said, bits=said.bits[: asked.count])
    return [_Part("n", 1, f"{size} bytes"), *_values(said, function, None if asked is None else asked.offset)]


def _one_written(said: Pdu) -> list[_Part]:
    where = f"{_named(said.function, said.offset)}, {_reference(said.function, said.offset)}"
    value = ("on" if said.bits[0] else "off") if said.bits else f"{said.registers[0]}"
    return [_Part("address", 2, where), _Part("value", 2, value)]


def _values(said: Pdu, function: int, offset: int | None) -> Iterator[_Part]:
    """Registers one by one, bits by the byte; without names if their address is not known."""
    for place, value in enumerate(said.registers):
        name = f"value {place + 1}" if offset is None else _named(function, offset + place)
        yield _Part(name, 2, f"{value}")
    for at in range(0, len(said.bits), 8):
        states = ["on" if bit else "off" for bit in said.bits[at : at + 8]]
        first = f"{at + 1}" if offset is None else _named(function, offset + at)
        yield _Part(f"{first} and on", 1, " ".join(states))


def _named(function: int, offset: int) -> str:
    found = STANDARD.element_at(Reference(AREAS[function], offset)) if offset <= 0xFFFF else None
    if found is None:
        return f"offset {offset}"
    return f"{found.element} {found.half}" if found.half else f"{found.element}"


def _reference(function: int, offset: int) -> str:
    return f"{Reference(AREAS[function], offset)}"
