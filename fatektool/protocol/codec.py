"""The interface of all protocols: requests to bytes, bytes to frames, frames to answers.

A client uses one ``Codec`` and nothing else of the protocol, so another protocol is another file.

Most answers do not identify their request. So a codec defines how a late answer is distinguished from the
expected one: by a number that it repeats (``numbers``), or by a *fence*, a request whose answer differs from
the answers to all requests before it.
"""

from __future__ import annotations

from typing import TYPE_CHECKING, Any, Final, NamedTuple, Protocol, TypeVar

from fatektool.errors import UsageError
from fatektool.protocol.commands import PROGRAM_COMMANDS

if TYPE_CHECKING:
    from collections.abc import Collection

    from fatektool.protocol.commands import Command, Request
    from fatektool.protocol.elements import Element

A = TypeVar("A")


class Frame(NamedTuple):
    """A complete frame with a correct checksum, request or answer.

    Attributes:
        station: 0 to 255; the PLC that is asked or answers.
        command: the command's code, also an unknown one.
        data: the bytes between command and checksum, error character included.
        raw: the frame as on the wire.
        number: of the request, if answers repeat it; else 0.
    """

    station: int
    command: int
    data: bytes
    raw: bytes
    number: int = 0


class Decoder(Protocol):
    """Splits a stream into frames, in whatever pieces it is received.

    ``next_frame`` returns a frame, or None if more bytes are needed. It raises ``FrameError`` after it has
    dropped bad bytes, so the caller just goes on. It never raises anything else.
    """

    def feed(self, data: bytes) -> None:
        """Add received bytes."""

    def next_frame(self) -> Frame | None:
        """The next complete frame, or None."""

    def expect_no_more(self) -> bool:
        """Note that no more bytes are expected; True if ``next_frame`` may find something now.

        An incomplete frame is then not a frame, and another frame may follow its beginning.
        """

    def clear(self) -> int:
        """Drop all bytes that were not returned as frames; return their number."""


class Codec(Protocol):
    """One protocol. Stateless."""

    def __hash__(self) -> int:
        """One codec is one key, such as of the costs of its plans."""

    @property
    def name(self) -> str:
        """The name of ``--protocol``."""

    @property
    def commands(self) -> frozenset[Command]:
        """The commands in its paper."""

    @property
    def loopback_alphabet(self) -> bytes:
        """The bytes that a loopback (4E) may contain on any line with this protocol."""

    @property
    def data_bits(self) -> int | None:
        """The data bits that a serial line needs at least, 7 or 8; None if it is for networks."""

    @property
    def default_tcp_port(self) -> int | None:
        """The default port of TCP and UDP; None if no paper has one."""

    @property
    def stations(self) -> range:
        """The valid stations of one PLC."""

    @property
    def numbers(self) -> int:
        """The count of different numbers that answers repeat; 1 if answers have no number."""

    @property
    def quiet_chars(self) -> float:
        """The silence on a serial line before a request, in characters."""

    @property
    def last_error(self) -> int:
        """The highest error code in an answer."""

    @property
    def probe(self) -> Request[Any]:
        """A short request that every PLC answers, and whose echo differs from the answer."""

    def decoder(self) -> Decoder:
        """A new decoder for one stream."""

    def code(self, request: Request[Any]) -> int:
        """The command code in the frames of this request and of its answers."""

    def encode(self, station: int, request: Request[A], number: int = 0) -> bytes:
        """The request as one frame for this station.

        Args:
            station: 0 for all of them.
            request: what is asked.
            number: 0 to ``numbers`` - 1; the answer repeats it.

        Raises:
            UsageError: this protocol has no such request.
        """

    def parse_answer(self, request: Request[A], frame: Frame) -> A:
        """The answer to this request in a frame; the caller checks station and command.

        Raises:
            PlcRefused: an error code.
            PlcBusy: the PLC is busy; ask again.
            GatewayTimeout: a gateway reports that it got no answer.
            FrameError: not an answer to this request, by length or content.
        """

    def good_answer(self, request: Request[A], asked: bytes, raw: bytes) -> A:
        """The contents of a valid answer, parsed without a decoder, for a stream of requests.

        It checks as much as a decoder and ``parse_answer``, with one comparison for everything that the
        request determines: station, command, number, no error.

        Args:
            request: what is asked.
            asked: its frame.
            raw: ``answer_bytes`` bytes.

        Raises:
            FrameError: anything else than the valid answer; a decoder finds out what.
        """

    def encode_answer(self, station: int, request: Request[A], answer: A, number: int = 0) -> bytes:
        """The frame of a PLC with this answer to a request.

        Raises:
            UsageError: this protocol has no such answer.
        """

    def encode_raw(
        self,
        station: int,
        command: int,
        data: bytes,
        number: int = 0,
        *,
        answer: bool = False,
    ) -> bytes:
        """A frame with any command and data, also a command that the protocol does not have.

        Args:
            station: 0 for all of them.
            command: 0 to 255; in Modbus the function.
            data: the bytes between command and checksum.
            number: 0 to ``numbers`` - 1.
            answer: True for an answer, if its frame differs from a request's.

        Raises:
            UsageError: it does not fit into a frame.
        """

    def encode_refusal(self, station: int, command: int, code: int, number: int = 0) -> bytes:
        """The frame in which a PLC refuses this command.

        Args:
            station: of the PLC that refuses.
            command: 0 to 255; in Modbus the function.
            code: the error code, 1 to ``last_error``.
            number: of the request.
        """

    def checksum(self, data: bytes) -> bytes:
        """The checksum of the bytes that it covers, as sent.

        Raises:
            UsageError: frames of this protocol have no checksum.
        """

    def error_text(self, code: int) -> str:
        """The meaning of an error code above 0."""

    def request_bytes(self, request: Request[A]) -> int:
        """Length of the request's frame in bytes, the same for all addresses of its elements."""

    def answer_bytes(self, request: Request[A]) -> int:
        """Length of the answer's frame in bytes; the usual one if it varies."""

    def neighbourhood(self, element: Element, *, writes: bool) -> int:
        """A number that is the same for all elements that can be in one run with this one.

        Raises:
            UsageError: the protocol does not have this element; the message has what it has.
        """

    def most(self, symbol: str, *, writes: bool) -> int:
        """The most elements of a kind in one run (44 to 47)."""

    def mixed_words(self, *, writes: bool) -> int:
        """The most words in one mixed request (48, 49); 0 if there is no such request."""

    def echo_may_pass(self, request: Request[A]) -> bool:
        """True if the request's own echo could be taken for its answer."""

    @property
    def unique_fences(self) -> bool:
        """True if the answer to a fence always differs from the answers to all other requests."""

    def shape(self, request: Request[Any]) -> bytes:
        """What an answer shows of its request; a fence must have another shape than earlier requests."""

    def fence(self, nonce: bytes, asked: Collection[bytes] | None) -> Request[Any] | None:
        """A request whose answer differs from all others that may be received; None if there is none left.

        Args:
            nonce: never the same twice.
            asked: the shapes of the requests whose answers may still be received; None if not known.
        """


def require_commands(codec: Codec, *needed: Command) -> None:
    """Check that a protocol has these commands, before anything is opened or sent.

    Raises:
        UsageError: it does not have one of them.
    """
    missing = [command for command in needed if command not in codec.commands]
    if not missing:
        return
    listed = " and ".join(f"{command.words} ({command:02X})" for command in missing)
    if PROGRAM_COMMANDS.issuperset(missing):
        raise UsageError(
            f"{codec.name} has no program commands: its paper does not list {listed}",
            hint=_ANOTHER_WAY,
        )
    raise UsageError(f"{codec.name} has no such command: its paper does not list {listed}")


_ANOTHER_WAY: Final = "save the program with the vendor's software; 'fatektool snapshot' saves the data"


def require_station(codec: Codec, station: int) -> None:
    """Check that one PLC can have this station, before anything is opened or sent.

    Raises:
        UsageError: it cannot.
    """
    if station not in codec.stations:
        raise UsageError(
            f"station: expected {codec.stations[0]} to {codec.stations[-1]}, got {station}",
            hint="0 is a broadcast: no PLC answers it" if not station else f"{codec.name} has no others",
        )
