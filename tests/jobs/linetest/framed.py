"""A PLC whose ladder program sends back what it gets: the paper's "loop back reply", CLINK in mode MD2.

Written from the FBs link paper: SR+1 holds start and end code, 0 for none; a message without an end code ends
when nothing came for the message detection time (R4148's high byte, 12 ms); what goes back holds the codes.
"""

from __future__ import annotations

from contextlib import contextmanager
from dataclasses import dataclass, field
from typing import TYPE_CHECKING

from fatektool.simulator.listen.servers import Server
from tests.hurry import hurried

if TYPE_CHECKING:
    from collections.abc import Iterator

Pieces = list[tuple[float, bytes]]


@dataclass
class FramedReply:
    """The program on a line.

    Args:
        start: start code; 0 for none.
        end: end code; 0 for none.
        baud: of a line of ten bits a byte, with wire times; None for none.
        scan_s: time to answer.
        echo: True for a two-wire line that gives back what it takes.
        dead: True if the program does not run.
        alter: exclusive-or of the middle byte of each n-th answer, n being the key.
        twice: True if it answers twice.
    """

    start: int = 2
    end: int = 3
    baud: int | None = 9600
    scan_s: float = 0.005
    echo: bool = False
    dead: bool = False
    alter: dict[int, int] = field(default_factory=dict)
    twice: bool = False
    answers: int = 0
    heard: list[bytes] = field(default_factory=list)
    _input: bytes = b""

    def receive(self, data: bytes, now: float) -> Pieces:
        self.heard.append(data)
        wire_s = len(data) * 10 / self.baud if self.baud else 0.0
        pieces: Pieces = [(now + wire_s, data)] if self.echo else []
        if self.dead:
            return pieces
        self._input += data
        while message := self._message():
            self.answers += 1
            for period, bits in self.alter.items():
                if self.answers % period == 0:
                    middle = len(message) // 2
                    message = message[:middle] + bytes([message[middle] ^ bits]) + message[middle + 1 :]
            due = now + wire_s + self.scan_s + (0.012 if not self.end else 0.0)
            pieces.append((due + (len(message) * 10 / self.baud if self.baud else 0.0), message))
            if self.twice:
                pieces.append((pieces[-1][0] + 0.001, message))
        return pieces

    def _message(self) -> bytes:
        """The next message, taken out of the input; what stands before its start code is dropped."""
        if self.start:
            place = self._input.find(self.start)
            self._input = self._input[place:] if place >= 0 else b""
        if not self.end:
            message, self._input = self._input, b""
            return message
        place = self._input.find(self.end)
        if place < 0:
            return b""
        message, self._input = self._input[: place + 1], self._input[place + 1 :]
        return message


@dataclass
class _Behind:
    """The program as a simulator's lines."""

    program: FramedReply
    powered: bool = True

    def line(self, *, whole_answers: bool = False) -> _Behind:
        assert not whole_answers, "it hangs on a stream"
        return self

    def receive(self, data: bytes, now: float) -> Pieces:
        return self.program.receive(data, now)

    datagram = receive


@contextmanager
def framed_on_tcp(program: FramedReply) -> Iterator[str]:
    """The program behind a gateway, in a thread; gives its target."""
    server = Server(_Behind(program))
    door = server.open_tcp()
    with hurried(server):
        yield door.address
