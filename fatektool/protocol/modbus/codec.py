"""Modbus as a ``Codec``, in three framings: RTU and ASCII on serial lines, TCP.

What is asked goes through a map, the standard one unless another is given: ``mapped``.

**Fences.** An RTU or ASCII answer does not name its question, and the paper lists no function that would send
back what it was sent. But the answer to a read says how many bytes it has. So the fence is a read of a number
of registers or coils that nothing asked since the last fence had: an answer of just that length is its own,
and all that was asked before is in or lost. A map of a few registers has not as many lengths: then ``fence``
gives None, and silence must do. A TCP answer repeats the number of its request, and needs no fence.
"""

from __future__ import annotations

from dataclasses import dataclass, replace
from typing import TYPE_CHECKING, Any, Final, TypeVar

from fatektool.errors import FatektoolError, UsageError
from fatektool.protocol.commands import ReadDiscretes, ReadRegisters
from fatektool.protocol.elements import Element
from fatektool.protocol.modbus import data as modbus_data
from fatektool.protocol.modbus import frame as modbus_frame
from fatektool.protocol.modbus import sizes as modbus_sizes
from fatektool.protocol.modbus.frame import AsciiDecoder, RtuDecoder, TcpDecoder
from fatektool.protocol.modbus.map import STANDARD

if TYPE_CHECKING:
    from collections.abc import Callable, Collection, Iterator

    from fatektool.protocol.codec import Decoder, Frame
    from fatektool.protocol.commands import Command, Request
    from fatektool.protocol.modbus.map import ModbusMap

A = TypeVar("A")


@dataclass(frozen=True, slots=True)
class Framing:
    """What RTU, ASCII and TCP differ in.

    Attributes:
        name: of ``--protocol``.
        encode: station, PDU and number as a frame.
        decoder: a new decoder.
        size: length of a frame around a PDU of so many bytes.
        data_bits: that a serial line needs; None if it is not spoken there.
        tcp_port: unless one is named.
        stations: that one PLC can be asked under.
        numbers: how many requests can be told apart by the number that their answers repeat.
        quiet_chars: the silence in characters before a frame.
    """

    name: str
    encode: Callable[[int, bytes, int], bytes]
    decoder: Callable[[], Decoder]
    size: Callable[[int], int]
    data_bits: int | None
    tcp_port: int | None = None
    stations: range = range(1, 1 + modbus_frame.LAST_STATION)
    numbers: int = 1
    quiet_chars: float = 0.0


@dataclass(frozen=True)
class ModbusCodec:
    """Modbus in one framing, over one map.

    Attributes:
        framing: RTU, ASCII or TCP.
        map: which elements have which references.
    """

    framing: Framing
    map: ModbusMap = STANDARD

    commands: Final[frozenset[Command]] = modbus_data.COMMANDS
    loopback_alphabet: Final[bytes] = b""

    def mapped(self, modbus_map: ModbusMap) -> ModbusCodec:
        """The same over another map."""
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
        """1 to 247; over TCP 0 to 255, of which 0 and 255 are the PLC at the address itself."""
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
    def probe(self) -> Request[Any]:
        """One register, or one discrete where the map has no register."""
        stretch = min(self.map.stretches, key=lambda stretch: stretch.area.of_bits, default=None)
        if stretch is None:
            raise UsageError("this Modbus map has nothing in it")
        first = Element(stretch.symbol, stretch.first)
        return ReadDiscretes(first, 1) if stretch.area.of_bits else ReadRegisters(first, 1)

    def decoder(self) -> Decoder:
        """A new decoder for one stream."""
        return self.framing.decoder()

    def code(self, request: Request[Any]) -> int:
        """The Modbus function that asks this."""
        return modbus_data.function_of(request, self.map)

    def encode(self, station: int, request: Request[A], number: int = 0) -> bytes:
        """The request as one frame for this station."""
        if station and station not in self.stations:
            raise UsageError(f"station: expected 0 to {self.stations[-1]}, got {station}")
        return self.framing.encode(station, modbus_data.request_pdu(request, self.map), number)

    def parse_request(self, frame: Frame) -> Request[object]:
        """The request that a frame holds."""
        return modbus_data.parse_request(frame.data, self.map)

    def parse_answer(self, request: Request[A], frame: Frame) -> A:
        """What a frame answers to this request."""
        return modbus_data.parse_answer(request, frame.data, self.map)

    def encode_answer(self, station: int, request: Request[A], answer: A, number: int = 0) -> bytes:
        """The frame in which a PLC gives this answer."""
        return self.framing.encode(station, modbus_data.answer_pdu(request, answer, self.map), number)

    def request_bytes(self, request: Request[A]) -> int:
        """Length of the frame that asks this, in bytes."""
        return self.framing.size(modbus_sizes.request_size(request))

    def answer_bytes(self, request: Request[A]) -> int:
        """Length of the frame that answers this request, in bytes."""
        return self.framing.size(modbus_sizes.answer_size(request))

    def neighbourhood(self, element: Element, *, writes: bool) -> int:
        """The stretch of the map that an element lies in."""
        return self.map.stretch_of(element, writes=writes)

    def most(self, symbol: str, *, writes: bool) -> int:
        """How many elements of a kind one request holds."""
        return modbus_sizes.most(symbol, writes=writes)

    def mixed_words(self, *, writes: bool) -> int:  # noqa: ARG002  # the interface's
        """0: a request is for neighbours."""
        return 0

    def echo_may_pass(self, request: Request[A]) -> bool:
        """True if the request's own echo could be taken for its answer, as with 05 and 06 it always could."""
        try:
            modbus_data.parse_answer(request, modbus_data.request_pdu(request, self.map), self.map)
        except FatektoolError:
            return False
        return True

    def shape(self, request: Request[Any]) -> bytes:
        """What is known of an answer beforehand: the function, and of a read the number of bytes."""
        size = 0 if request.writes else modbus_sizes.answer_size(request)
        return bytes([modbus_data.function_of(request, self.map), size])

    def fence(self, nonce: bytes, asked: Collection[bytes] | None) -> Request[Any] | None:
        """A read whose answer has a length that no answer to what was asked has.

        Args:
            nonce: where to begin to look.
            asked: the shapes of what was asked; None for anything: then no length is left.
        """
        if asked is None:
            return None
        found = list(self._fences())
        start = int.from_bytes(nonce[-2:], "big")
        for place in range(len(found)):
            fence = found[(start + place) % len(found)]
            if self.shape(fence) not in asked:
                return fence
        return None

    def _fences(self) -> Iterator[Request[Any]]:
        """Reads from the beginning of each stretch, each of a length of its own."""
        shapes: set[bytes] = set()
        for stretch in self.map.stretches:
            first = Element(stretch.symbol, stretch.first)
            step = 8 if stretch.area.of_bits else 1
            most = min(stretch.count, step * _LONGEST_FENCE) if stretch.width == 1 else 0
            for count in range(step, most + 1, step):
                fence = ReadDiscretes(first, count) if step == 8 else ReadRegisters(first, count)
                if self.shape(fence) not in shapes:
                    shapes.add(self.shape(fence))
                    yield fence


_LONGEST_FENCE: Final = 32
"""In registers, or bytes of coils: long enough for many to differ, short enough to cost little."""

RTU: Final = ModbusCodec(
    Framing(
        "modbus-rtu", modbus_frame.rtu_bytes, RtuDecoder, lambda size: size + 3, data_bits=8, quiet_chars=3.5
    )
)
ASCII: Final = ModbusCodec(
    Framing("modbus-ascii", modbus_frame.ascii_bytes, AsciiDecoder, lambda size: 2 * size + 7, data_bits=7)
)
TCP: Final = ModbusCodec(
    Framing(
        "modbus-tcp",
        modbus_frame.tcp_bytes,
        TcpDecoder,
        lambda size: size + modbus_frame.TCP_HEADER,
        data_bits=None,
        tcp_port=502,
        stations=range(256),
        numbers=1 << 16,
    )
)
