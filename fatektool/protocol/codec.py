"""What a protocol is to the rest of the house: requests to bytes, bytes to frames, frames to answers.

A client holds one ``Codec`` and knows nothing else of the protocol it speaks, so that another
protocol is another file.
"""

from __future__ import annotations

from typing import TYPE_CHECKING, NamedTuple, Protocol, TypeVar

if TYPE_CHECKING:
    from fatektool.protocol.commands import Request

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

    def clear(self) -> int:
        """Forget what was fed and not yet given; return how many bytes that was."""


class Codec(Protocol):
    """One protocol. Stateless."""

    @property
    def name(self) -> str:
        """The name of ``--protocol``."""

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
        """Length of the frame that answers this request, in bytes on the wire."""

    def echo_may_pass(self, request: Request[A]) -> bool:
        """True if the request's own echo could be taken for its answer."""
