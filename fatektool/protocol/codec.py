"""What a protocol is to the rest of the house: requests to bytes, bytes to frames, frames to answers.

A client holds one ``Codec`` and knows nothing else of the protocol it speaks, so that another
protocol is another file.
"""

from __future__ import annotations

from typing import TYPE_CHECKING, NamedTuple, Protocol, TypeVar

from fatektool.errors import UsageError
from fatektool.protocol.plc_errors import PROGRAM_COMMANDS

if TYPE_CHECKING:
    from fatektool.protocol.commands import Command, Request

A = TypeVar("A")


class Frame(NamedTuple):
    """A whole frame with a right checksum, request or answer.

    Attributes:
        station: 0 to 255; who is asked or who answers.
        command: the command's code, known or not.
        data: what stands between command and checksum, error character included.
        raw: the frame as it came over the wire.
    """

    station: int
    command: int
    data: bytes
    raw: bytes


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

        A frame that began and has not ended is none then, and another may stand behind its beginning.
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
        """The bytes that a loopback (4E) may carry over any line that this protocol is spoken on."""

    @property
    def data_bits(self) -> int:
        """The fewest data bits of a serial line that carry its frames, 7 or 8."""

    @property
    def default_tcp_port(self) -> int | None:
        """The port of TCP and UDP unless one is named; None if no paper says one."""

    def decoder(self) -> Decoder:
        """A new decoder for one stream."""

    def encode(self, station: int, request: Request[A]) -> bytes:
        """The request as one frame for this station.

        Raises:
            UsageError: the request cannot be said in this protocol.
        """

    def parse_request(self, frame: Frame) -> Request[object]:
        """The request that a frame holds.

        Raises:
            FrameError: it holds none.
        """

    def parse_answer(self, request: Request[A], frame: Frame) -> A:
        """What a frame answers to this request; its station and command are the caller's to check.

        Raises:
            PlcRefused: an error code.
            FrameError: no answer to this request, by length or content.
        """

    def answer_bytes(self, request: Request[A]) -> int:
        """Length in bytes of the frame that answers this request; the likely one if it varies."""

    def echo_may_pass(self, request: Request[A]) -> bool:
        """True if the request's own echo could be taken for its answer."""


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
            hint="save the program with the vendor's software; 'fatektool snapshot --all' saves the data",
        )
    raise UsageError(f"{codec.name} has no such command: its paper does not list {listed}")
