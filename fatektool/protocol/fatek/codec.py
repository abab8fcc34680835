"""The common part of the codecs of FACON and the M-series: all except the form of a frame.

The data of an answer begins with the error, 0 for none; after another error there is no more data. 4E
differs: its answer is the data of the request, without an error before it.
"""

from __future__ import annotations

from abc import ABC, abstractmethod
from typing import TYPE_CHECKING, Any, ClassVar, TypeVar

from fatektool.errors import FrameError, UsageError
from fatektool.protocol.codec import require_commands
from fatektool.protocol.commands import (
    MAX_MIXED_WRITE_WORDS,
    MAX_READ_WORDS,
    Command,
    Loopback,
    ReadBriefStatus,
)
from fatektool.protocol.elements import KINDS
from fatektool.protocol.fatek.fields import run_limit

if TYPE_CHECKING:
    from collections.abc import Callable, Collection, Mapping

    from fatektool.errors import PlcRefused
    from fatektool.protocol.codec import Decoder, Frame
    from fatektool.protocol.commands import Request
    from fatektool.protocol.elements import Element
    from fatektool.protocol.fatek.fields import CommandRow
    from fatektool.protocol.fatek.notation import Notation

A = TypeVar("A")


class DataFields:
    """The data fields of one protocol.

    Args:
        notation: the format of the parts.
        rows: the format of each command; there are no others.
        refusal: the exception for an error code, a command's code, and the request as text.
        paper: the paper with the commands, for messages.
        error_optional: commands whose valid answers may have no error code.
        any_size: commands whose valid answers may have any number of bytes.
    """

    def __init__(
        self,
        notation: Notation,
        rows: Mapping[int, CommandRow],
        refusal: Callable[[int, int, str], PlcRefused],
        paper: str,
        *,
        error_optional: frozenset[Command] = frozenset(),
        any_size: frozenset[Command] = frozenset(),
    ) -> None:
        self.notation = notation
        self.rows = rows
        self.refusal = refusal
        self.paper = paper
        self.error_optional = error_optional
        self.any_size = any_size

    @property
    def commands(self) -> frozenset[Command]:
        """The commands of the table."""
        return frozenset(Command(code) for code in self.rows)

    def request_data(self, request: Request[A]) -> bytes:
        """The data field of a request of one of ``rows``.

        Raises:
            UsageError: a run that is too long, or an element that would be read as another.
        """
        return self.rows[request.command].request(self.notation, request)

    def parse_request(self, command: int, data: bytes) -> Request[object]:
        """The request in a data field.

        Raises:
            FrameError: an unknown command, or data that no request of it has.
        """
        row = self.rows.get(command)
        if row is None:
            raise FrameError(f"command {command:02X} is not in {self.paper}", raw=data)
        try:
            return row.parse_request(self.notation, data)
        except UsageError as error:
            raise FrameError(error.message, raw=data) from error

    def answer_size(self, request: Request[A]) -> int:
        """The length of a valid answer's data, with the error; the usual length if it varies."""
        return 1 + self.rows[request.command].size(self.notation, request)

    def parse_answer(self, request: Request[A], data: bytes) -> A:
        """The answer to this request in a data field.

        Raises:
            PlcRefused: an error code.
            FrameError: not an answer to this request, by length or content.
        """
        notation = self.notation
        command = request.command
        row = self.rows[command]
        size = 1 + row.size(notation, request)
        if len(data) != size or not data.startswith(notation.no_error) or command == Command.LOOPBACK:
            data = self._values(request, data, size)
        else:
            data = data[1:]
        answer: A = row.parse_answer(notation, request, data)
        return answer

    def _values(self, request: Request[A], data: bytes, size: int) -> bytes:
        """The values in an answer with another length than expected, if they are complete."""
        notation = self.notation
        command = request.command
        loopback = command == Command.LOOPBACK
        code = notation.error_code(data)
        if code is not None and not (loopback and size == 1):
            raise self.refusal(code, command, _asked(request))
        if loopback:
            return data
        if len(data) == size or (command in self.any_size and data):
            if not data.startswith(notation.no_error):
                raise notation.wrong_error(data)
            return data[1:]
        if command in self.error_optional and len(data) == size - 1:
            return data
        raise FrameError(
            f"answer to {_asked(request)}: expected {size} {notation.unit} of data, got {len(data)}", raw=data
        )

    def answer_data(self, request: Request[A], answer: A) -> bytes:
        """The data field of the answer to a request."""
        data = self.rows[request.command].answer(self.notation, request, answer)
        return data if request.command == Command.LOOPBACK else self.notation.no_error + data


def _asked(request: Request[Any]) -> str:
    from fatektool.protocol.plc_errors import asked  # the words of errors are loaded with the first

    return asked(request)


class FatekCodec(ABC):
    """A ``Codec``; FACON and the M-series add the form of a frame.

    Args:
        request_frame: station, command and data as a frame that asks.
        answer_frame: the same as a frame that answers.

    Attributes:
        data: the format of data fields.
        framing_bytes: the bytes of a frame without its data.
    """

    name: ClassVar[str]
    commands: ClassVar[frozenset[Command]]
    loopback_alphabet: ClassVar[bytes]
    data_bits: ClassVar[int]
    default_tcp_port: ClassVar[int | None]
    last_error: ClassVar[int]
    data: ClassVar[DataFields]
    framing_bytes: ClassVar[int]

    stations: ClassVar[range] = range(1, 255)
    numbers: ClassVar[int] = 1
    quiet_chars: ClassVar[float] = 0.0
    unique_fences: ClassVar[bool] = True
    probe: ClassVar[Request[Any]] = ReadBriefStatus()

    def __init__(
        self,
        request_frame: Callable[[int, int, bytes], bytes],
        answer_frame: Callable[[int, int, bytes], bytes],
    ) -> None:
        self.request_frame = request_frame
        self.answer_frame = answer_frame

    @property
    def same_form(self) -> bool:
        """True if requests and answers have the same form."""
        return self.request_frame == self.answer_frame

    @abstractmethod
    def decoder(self) -> Decoder:
        """A new decoder for one stream."""

    @abstractmethod
    def checksum(self, data: bytes) -> bytes:
        """The checksum of the bytes that it covers."""

    @abstractmethod
    def good_answer(self, request: Request[A], asked: bytes, raw: bytes) -> A:
        """The contents of a valid answer, parsed without a decoder."""

    @abstractmethod
    def error_text(self, code: int) -> str:
        """The meaning of an error code."""

    @abstractmethod
    def echo_may_pass(self, request: Request[A]) -> bool:
        """True if the request's own echo could be taken for its answer."""

    def code(self, request: Request[Any]) -> int:
        """The command's code."""
        return request.command

    def encode(self, station: int, request: Request[A], number: int = 0) -> bytes:
        """The request as one frame for this station."""
        del number  # a frame has no place for it
        command = request.command
        rows = self.data.rows
        if command not in rows:
            require_commands(self, command)
        return self.request_frame(station, command, rows[command].request(self.data.notation, request))

    def parse_answer(self, request: Request[A], frame: Frame) -> A:
        """The answer to this request in a frame."""
        return self.data.parse_answer(request, frame.data)

    def encode_answer(self, station: int, request: Request[A], answer: A, number: int = 0) -> bytes:
        """The frame of a PLC with this answer."""
        del number
        return self.answer_frame(station, request.command, self.data.answer_data(request, answer))

    def encode_raw(
        self,
        station: int,
        command: int,
        data: bytes,
        number: int = 0,
        *,
        answer: bool = False,
    ) -> bytes:
        """A frame with any command and data."""
        del number
        return (self.answer_frame if answer else self.request_frame)(station, command, data)

    def encode_refusal(self, station: int, command: int, code: int, number: int = 0) -> bytes:
        """The frame in which a PLC refuses this command."""
        del number
        return self.answer_frame(station, command, self.data.notation.digit(code))

    def request_bytes(self, request: Request[A]) -> int:
        """Length of the request's frame, in bytes."""
        return self.framing_bytes + len(self.data.request_data(request))

    def answer_bytes(self, request: Request[A]) -> int:
        """Length of the answer's frame, in bytes; for 53 with FACON's 64 bytes."""
        return self.framing_bytes + self.data.answer_size(request)

    def neighbourhood(self, element: Element, *, writes: bool) -> int:  # noqa: ARG002  # the interface's
        """0: all elements can be in a run."""
        return 0

    def most(self, symbol: str, *, writes: bool) -> int:  # noqa: ARG002  # the same both ways
        """The most elements of a kind in one run."""
        return run_limit(KINDS[symbol])

    def mixed_words(self, *, writes: bool) -> int:
        """The most words in one mixed request."""
        return MAX_MIXED_WRITE_WORDS if writes else MAX_READ_WORDS

    def shape(self, request: Request[Any]) -> bytes:  # noqa: ARG002  # the interface's
        """Empty: the nonce identifies a fence."""
        return b""

    def fence(self, nonce: bytes, asked: Collection[bytes] | None) -> Request[Any]:  # noqa: ARG002  # the interface's
        """A loopback (4E) with a nonce."""
        return Loopback(nonce)
