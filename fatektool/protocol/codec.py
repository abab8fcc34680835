"""What a protocol is to the rest of the package: requests to bytes, bytes to frames, frames to answers.

A client holds one ``Codec`` and knows nothing else of the protocol, so that another
protocol is another file.

Most answers do not name their request. So a codec says how an answer that came late is told from the one
that is waited for: by a number that it repeats (``numbers``), or, behind a *fence*, a request whose answer
nothing that was asked before could have.
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
    """A whole frame with a right checksum, request or answer.

    Attributes:
        station: 0 to 255; who is asked or who answers.
        command: the command's code, known or not.
        data: what is between command and checksum, error character included.
        raw: the frame as it came over the wire.
        number: of the request, where answers repeat it; else 0.
    """

    station: int
    command: int
    data: bytes
    raw: bytes
    number: int = 0


class Decoder(Protocol):
    """Cuts frames out of a stream, whatever its chunks.

    ``next_frame`` gives a frame, None when more bytes are needed, or raises ``FrameError`` after it
    has dropped the bad bytes, so that the caller just goes on. It never raises anything else.
    """

    def feed(self, data: bytes) -> None:
        """Take bytes from the wire."""

    def next_frame(self) -> Frame | None:
        """Give the next whole frame, or None."""

    def expect_no_more(self) -> bool:
        """The time for what was fed is over; True if ``next_frame`` may find something in it now.

        A frame that began and has not ended is none then, and another may follow its beginning.
        """

    def clear(self) -> int:
        """Forget what was fed and not yet given; return how many bytes that was."""


class Codec(Protocol):
    """One protocol. Stateless."""

    @property
    def name(self) -> str:
        """The name of ``--protocol``."""

    @property
    def commands(self) -> frozenset[Command]:
        """The commands that its paper has."""

    @property
    def loopback_alphabet(self) -> bytes:
        """The bytes that a loopback (4E) may carry over any line that this protocol is used on."""

    @property
    def data_bits(self) -> int | None:
        """The fewest data bits of a serial line that carry its frames, 7 or 8; None if it is for networks."""

    @property
    def default_tcp_port(self) -> int | None:
        """The port of TCP and UDP unless one is named; None if no paper says one."""

    @property
    def stations(self) -> range:
        """The stations that one PLC can be asked under."""

    @property
    def numbers(self) -> int:
        """How many requests differ by a number that their answers repeat; 1 if answers bear none."""

    @property
    def quiet_chars(self) -> float:
        """How long a serial line must have been silent before a request, in characters."""

    @property
    def last_error(self) -> int:
        """The highest error code that an answer can carry."""

    @property
    def probe(self) -> Request[Any]:
        """What every PLC answers at no cost, and no echo of it could be taken for the answer."""

    def decoder(self) -> Decoder:
        """A new decoder for one stream."""

    def code(self, request: Request[Any]) -> int:
        """The command in the frames of this request and of its answers."""

    def encode(self, station: int, request: Request[A], number: int = 0) -> bytes:
        """The request as one frame for this station.

        Args:
            station: 0 for all of them.
            request: what is asked.
            number: 0 to ``numbers`` less 1; its answer repeats it.

        Raises:
            UsageError: the request cannot be said in this protocol.
        """

    def parse_answer(self, request: Request[A], frame: Frame) -> A:
        """What a frame answers to this request; its station and command are the caller's to check.

        Raises:
            PlcRefused: an error code.
            PlcBusy: it is at work, and is to be asked again.
            GatewayTimeout: a gateway says that it got no answer.
            FrameError: no answer to this request, by length or content.
        """

    def good_answer(self, request: Request[A], asked: bytes, raw: bytes) -> A:
        """What a good answer says, read without a decoder, for a stream of requests.

        It checks as much as a decoder and ``parse_answer`` do, with one comparison for all that the request
        determines: station, command, number, no error.

        Args:
            request: what is asked.
            asked: its frame.
            raw: as many bytes as ``answer_bytes`` says.

        Raises:
            FrameError: these bytes are anything else than the good answer; a decoder finds out what.
        """

    def encode_answer(self, station: int, request: Request[A], answer: A, number: int = 0) -> bytes:
        """The frame in which a PLC gives this answer to a request.

        Raises:
            UsageError: no answer of this protocol can say it.
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
        """A frame with any command and data, whether the protocol has such a command or not.

        Args:
            station: 0 for all of them.
            command: 0 to 255; in Modbus the function.
            data: what is between command and checksum.
            number: 0 to ``numbers`` less 1.
            answer: True for an answer, where its frame differs from a request's.

        Raises:
            UsageError: no frame can hold this.
        """

    def encode_refusal(self, station: int, command: int, code: int, number: int = 0) -> bytes:
        """The frame in which a PLC refuses this command.

        Args:
            station: who refuses.
            command: 0 to 255; in Modbus the function.
            code: the error code, 1 to ``last_error``.
            number: of the request.
        """

    def checksum(self, data: bytes) -> bytes:
        """The checksum of what it covers, as it is sent.

        Raises:
            UsageError: frames of this protocol have none.
        """

    def error_text(self, code: int) -> str:
        """What an error code above 0 means, in words."""

    def request_bytes(self, request: Request[A]) -> int:
        """Length in bytes of the frame that asks this, whatever its elements' addresses."""

    def answer_bytes(self, request: Request[A]) -> int:
        """Length in bytes of the frame that answers this request; the likely one if it varies."""

    def neighbourhood(self, element: Element, *, writes: bool) -> int:
        """Which elements can share a run with this one: those of the same number.

        Raises:
            UsageError: the protocol cannot name this element; says what it can.
        """

    def most(self, symbol: str, *, writes: bool) -> int:
        """How many elements of a kind a run (44 to 47) holds."""

    def mixed_words(self, *, writes: bool) -> int:
        """How many words a mixed request (48, 49) holds; 0 if there is none."""

    def echo_may_pass(self, request: Request[A]) -> bool:
        """True if the request's own echo could be taken for its answer."""

    @property
    def unique_fences(self) -> bool:
        """True if the answer to a fence can be that of no other request, whatever was asked before."""

    def shape(self, request: Request[Any]) -> bytes:
        """What an answer shows of its request: fences avoid those of what was asked."""

    def fence(self, nonce: bytes, asked: Collection[bytes] | None) -> Request[Any] | None:
        """A request whose answer cannot be taken for that of any other; None if there is none left.

        Args:
            nonce: never the same twice.
            asked: the shapes of the requests whose answers may still come; None if that is not known.
        """


def require_commands(codec: Codec, *needed: Command) -> None:
    """Check that a protocol has these commands, before anything is opened or sent.

    Raises:
        UsageError: it lacks one.
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
    """Check that one PLC can be asked under this station, before anything is opened or sent.

    Raises:
        UsageError: it cannot.
    """
    if station not in codec.stations:
        raise UsageError(
            f"station: expected {codec.stations[0]} to {codec.stations[-1]}, got {station}",
            hint="0 is broadcast: no PLC answers it" if not station else f"{codec.name} has no others",
        )
