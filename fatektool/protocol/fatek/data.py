"""A protocol's data fields as a whole: its notation, its table of commands, and how it refuses.

An answer begins with the error, 0 for none; any other is all there is. 4E differs: it answers the very data
that it was sent, without an error before it.
"""

from __future__ import annotations

from dataclasses import dataclass
from typing import TYPE_CHECKING, TypeVar

from fatektool.errors import FrameError, PlcRefused, UsageError
from fatektool.protocol.commands import Command
from fatektool.protocol.plc_errors import asked

if TYPE_CHECKING:
    from collections.abc import Callable, Mapping

    from fatektool.protocol.commands import Request
    from fatektool.protocol.fatek.fields import Row
    from fatektool.protocol.fatek.notation import Notation

A = TypeVar("A")


@dataclass(frozen=True, slots=True)
class DataFields:
    """The data fields of one protocol.

    Attributes:
        notation: how pieces are written.
        rows: how each command is written; there are no others.
        refusal: the exception for an error code, a command's code, and what was asked in words.
        paper: which paper lists the commands, for messages.
        error_optional: commands whose good answers may lack the error.
        any_size: commands whose good answers may have any number of bytes.
    """

    notation: Notation
    rows: Mapping[int, Row]
    refusal: Callable[[int, int, str], PlcRefused]
    paper: str
    error_optional: frozenset[Command] = frozenset()
    any_size: frozenset[Command] = frozenset()

    @property
    def commands(self) -> frozenset[Command]:
        """The commands of the table."""
        return frozenset(Command(code) for code in self.rows)

    def request_data(self, request: Request[A]) -> bytes:
        """The data field of a request of one of ``rows``.

        Raises:
            UsageError: a run that is too long, or an element that would be taken for another.
        """
        return self.rows[request.command].request(self.notation, request)

    def parse_request(self, command: int, data: bytes) -> Request[object]:
        """The request that a data field holds.

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
        """How long the data of the good answer is, with the error; the likely length if it varies."""
        return 1 + self.rows[request.command].size(self.notation, request)

    def parse_answer(self, request: Request[A], data: bytes) -> A:
        """What an answer's data field says to this request.

        Raises:
            PlcRefused: an error code.
            FrameError: no answer to this request, by length or content.
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
        """The values in an answer that is not just what was expected, if they are there all the same."""
        notation = self.notation
        command = request.command
        loopback = command == Command.LOOPBACK
        code = notation.error_code(data)
        if code is not None and not (loopback and size == 1):
            raise self.refusal(code, command, asked(request))
        if loopback:
            return data
        if len(data) == size or (command in self.any_size and data):
            if not data.startswith(notation.no_error):
                raise notation.wrong_error(data)
            return data[1:]
        if command in self.error_optional and len(data) == size - 1:
            return data
        raise FrameError(
            f"answer to {asked(request)}: expected {size} {notation.unit} of data, got {len(data)}", raw=data
        )

    def answer_data(self, request: Request[A], answer: A) -> bytes:
        """The data field of the answer to a request."""
        data = self.rows[request.command].answer(self.notation, request, answer)
        return data if request.command == Command.LOOPBACK else self.notation.no_error + data
