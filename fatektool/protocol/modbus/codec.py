"""Modbus as a ``Codec``, in three framings: RTU and ASCII on serial lines, TCP.

Elements have references by a map, the standard one by default: ``mapped``.

**Fences.** An RTU or ASCII answer does not identify its request, and the paper has no function that returns
the data of the request. But the answer to a read has a byte count. So the fence is a read of a number of
registers or coils that no request since the last fence had: an answer with that length belongs to it, and all
earlier answers were received or are lost. A map of a few registers has only a few lengths: then ``fence``
returns None, and silence is used instead. A TCP answer repeats the number of its request, and needs no fence.
"""

from __future__ import annotations

from dataclasses import dataclass, replace
from functools import cached_property
from typing import TYPE_CHECKING, Any, Final, TypeVar

from fatektool.errors import FatektoolError, FrameError, UsageError
from fatektool.protocol.commands import ReadDiscretes, ReadRegisters
from fatektool.protocol.elements import Element
from fatektool.protocol.modbus import data as modbus_data
from fatektool.protocol.modbus import sizes as modbus_sizes
from fatektool.protocol.modbus.framing import MAX_PDU
from fatektool.protocol.modbus.map import STANDARD
from fatektool.protocol.modbus.pdu import EXCEPTION

if TYPE_CHECKING:
    from collections.abc import Collection

    from fatektool.protocol.codec import Decoder, Frame
    from fatektool.protocol.commands import Command, Request
    from fatektool.protocol.modbus.framing import Framing
    from fatektool.protocol.modbus.map import ModbusMap

A = TypeVar("A")


@dataclass(frozen=True)
class ModbusCodec:
    """Modbus in one framing, with one map.

    Attributes:
        framing: RTU, ASCII or TCP.
        map: which elements have which references.
    """

    framing: Framing
    map: ModbusMap = STANDARD

    commands: Final[frozenset[Command]] = modbus_sizes.COMMANDS
    loopback_alphabet: Final[bytes] = b""
    last_error: Final[int] = 0xFF

    def mapped(self, modbus_map: ModbusMap) -> ModbusCodec:
        """The same with another map."""
        return replace(self, map=modbus_map)

    @property
    def name(self) -> str:
        """The name of ``--protocol``."""
        return self.framing.name

    @property
    def data_bits(self) -> int | None:
        """Of a serial line; None for TCP."""
        return self.framing.data_bits

    @property
    def default_tcp_port(self) -> int | None:
        """502 for TCP."""
        return self.framing.tcp_port

    @property
    def stations(self) -> range:
        """1 to 247; over TCP 0 to 255, where 0 and 255 are the PLC at the address itself."""
        return self.framing.stations

    @property
    def numbers(self) -> int:
        """65536 for TCP, else 1."""
        return self.framing.numbers

    @property
    def quiet_chars(self) -> float:
        """3.5 for RTU."""
        return self.framing.quiet_chars

    @property
    def unique_fences(self) -> bool:
        """False: the earlier requests decide which lengths of answers are left."""
        return False

    @property
    def probe(self) -> Request[Any]:
        """One register, or one discrete if the map has no register."""
        stretch = min(self.map.stretches, key=lambda stretch: stretch.area.of_bits, default=None)
        if stretch is None:
            raise UsageError("this Modbus map is empty")
        first = Element(stretch.symbol, stretch.first)
        return ReadDiscretes(first, 1) if stretch.area.of_bits else ReadRegisters(first, 1)

    def decoder(self) -> Decoder:
        """A new decoder for one stream."""
        return self.framing.decoder()

    def code(self, request: Request[Any]) -> int:
        """The Modbus function of this request."""
        return modbus_data.function_of(request, self.map)

    def encode(self, station: int, request: Request[A], number: int = 0) -> bytes:
        """The request as one frame for this station."""
        if station and station not in self.stations:
            raise UsageError(f"station: expected 0 to {self.stations[-1]}, got {station}")
        return self.framing.encode(station, modbus_data.request_pdu(request, self.map), number)

    def parse_answer(self, request: Request[A], frame: Frame) -> A:
        """The answer to this request in a frame."""
        return modbus_data.parse_answer(request, frame.data, self.map)

    def good_answer(self, request: Request[A], asked: bytes, raw: bytes) -> A:
        """The contents of a valid answer: its station, function and number are those of the request."""
        framing = self.framing
        decoder = framing.decoder()
        decoder.feed(raw)
        frame = decoder.next_frame()
        if frame is None or frame.raw != raw or framing.repeated(raw) != framing.repeated(asked):
            raise FrameError("not the expected answer", raw=raw)
        return self.parse_answer(request, frame)

    def encode_answer(self, station: int, request: Request[A], answer: A, number: int = 0) -> bytes:
        """The frame of a PLC with this answer."""
        return self.framing.encode(station, modbus_data.answer_pdu(request, answer, self.map), number)

    def encode_raw(
        self,
        station: int,
        command: int,
        data: bytes,
        number: int = 0,
        *,
        answer: bool = False,
    ) -> bytes:
        """A frame with any function and data; requests and answers have the same form."""
        del answer
        if station and station not in self.stations:
            raise UsageError(f"station: expected 0 to {self.stations[-1]}, got {station}")
        if len(data) >= MAX_PDU:
            raise UsageError(f"frame data: expected at most {MAX_PDU - 1} bytes, got {len(data)}")
        return self.framing.encode(station, bytes([command]) + data, number)

    def encode_refusal(self, station: int, command: int, code: int, number: int = 0) -> bytes:
        """The exception that a PLC answers to this function."""
        return self.encode_raw(station, command | EXCEPTION, bytes([code]), number)

    def checksum(self, data: bytes) -> bytes:
        """The CRC or LRC of station and PDU."""
        if self.framing.checksum is None:
            raise UsageError(f"{self.name} frames have no checksum: the network has its own")
        return self.framing.checksum(data)

    def error_text(self, code: int) -> str:
        """The meaning of an exception."""
        return modbus_data.exception_text(code)

    def request_bytes(self, request: Request[A]) -> int:
        """Length of the request's frame, in bytes."""
        return self.framing.size(modbus_sizes.request_size(request))

    def answer_bytes(self, request: Request[A]) -> int:
        """Length of the answer's frame, in bytes."""
        return self.framing.size(modbus_sizes.answer_size(request))

    def neighbourhood(self, element: Element, *, writes: bool) -> int:
        """The stretch of the map that an element is in."""
        return self.map.stretch_of(element, writes=writes)

    def most(self, symbol: str, *, writes: bool) -> int:
        """The most elements of a kind in one request."""
        return modbus_sizes.most(symbol, writes=writes)

    def mixed_words(self, *, writes: bool) -> int:  # noqa: ARG002  # the interface's
        """0: a request is for consecutive elements."""
        return 0

    def echo_may_pass(self, request: Request[A]) -> bool:
        """True if the request's own echo could be taken for its answer, as always with 05 and 06."""
        try:
            modbus_data.parse_answer(request, modbus_data.request_pdu(request, self.map), self.map)
        except FatektoolError:
            return False
        return True

    def shape(self, request: Request[Any]) -> bytes:
        """What is known of an answer in advance: the function, and for a read the number of bytes."""
        size = 0 if request.writes else modbus_sizes.answer_size(request)
        return bytes([modbus_data.function_of(request, self.map), size])

    def fence(self, nonce: bytes, asked: Collection[bytes] | None) -> Request[Any] | None:
        """A read whose answer has a length that no answer to an earlier request has.

        Args:
            nonce: where the search begins.
            asked: the shapes of the earlier requests; None if not known: then no length is left.
        """
        if asked is None:
            return None
        found = list(self._fences.items())
        start = int.from_bytes(nonce[-2:], "big")
        for place in range(len(found)):
            shape, fence = found[(start + place) % len(found)]
            if shape not in asked:
                return fence
        return None

    @cached_property
    def _fences(self) -> dict[bytes, Request[Any]]:
        """Reads from the beginning of each stretch, each of a length of its own, by their shapes."""
        found: dict[bytes, Request[Any]] = {}
        for stretch in self.map.stretches:
            first = Element(stretch.symbol, stretch.first)
            step = 8 if stretch.area.of_bits else 1
            most = min(stretch.count, step * _LONGEST_FENCE) if stretch.width == 1 else 0
            for count in range(step, most + 1, step):
                fence = ReadDiscretes(first, count) if step == 8 else ReadRegisters(first, count)
                found.setdefault(self.shape(fence), fence)
        return found


_LONGEST_FENCE: Final = 32
"""In registers, or bytes of coils: long enough for many to differ, short enough to cost little."""
