"""The other side of a line, by hand: what it answers to which request, byte for byte and second by second.

Frames are made by a sum of this file's own, so that a slip of the client's codec does not agree with itself.
"""

from __future__ import annotations

import itertools
from typing import TYPE_CHECKING

from fatektool.exchange.link import Link
from fatektool.protocol.fatek.facon.codec import FACON
from fatektool.transport.base import LineSettings
from fatektool.transport.memory import MemoryTransport

if TYPE_CHECKING:
    from collections.abc import Callable, Iterable

    from fatektool.transport.memory import Peer

Pieces = list[tuple[float, bytes]]
"""What comes back: seconds after the request, bytes."""

SILENCE: Pieces = []
BYTE_S = 10 / 9600
STATUS = b"\x020140C7\x03"
RUNNING = b"\x020140001540021\x03"
STOPPED = b"\x020140000540020\x03"
STOP = b"\x0201410F8\x03"


def frame(text: str, station: int = 1) -> bytes:
    """STX, station, command and data as given, LRC, ETX."""
    body = b"\x02" + f"{station:02X}{text}".encode("latin-1")
    return body + f"{sum(body) % 256:02X}".encode() + b"\x03"


def read_registers(first: int, count: int = 1) -> bytes:
    return frame(f"46{count:02X}R{first:05}")


def register(value: int) -> bytes:
    """The answer to one register read."""
    return frame(f"460{value:04X}")


def ask_page(page: int) -> bytes:
    return frame(f"4F{page:04X}")


def page_answer(data: bytes) -> bytes:
    return frame("4F0" + data.hex().upper())


def nonce(number: int) -> bytes:
    """The request and the answer of the fence of this number, counted from 0."""
    return frame(f"4EN{number}")


def soon(*answers: bytes) -> Pieces:
    return [(0.01, answer) for answer in answers]


class Script:
    """A turn for each request; silent after the last."""

    def __init__(self, *turns: Pieces) -> None:
        self._turns = iter(turns)
        self.heard: list[bytes] = []
        self.times: list[float] = []

    def receive(self, data: bytes, now: float) -> Pieces:
        self.heard.append(data)
        self.times.append(now)
        return [(now + after, piece) for after, piece in next(self._turns, SILENCE)]


class Rules:
    """An answer for each request, whenever it comes; a request that no rule names is met with silence.

    Args:
        answers: request to answer, or to a function of how often it was asked before.
        loopback: False for a PLC that does not know 4E.
        echo: True on a line that gives back what it takes.
        dead: True if nobody but the line answers.
    """

    def __init__(
        self,
        answers: dict[bytes, bytes | Callable[[int], Pieces]] | None = None,
        *,
        loopback: bool = True,
        echo: bool = False,
        dead: bool = False,
    ) -> None:
        self.answers: dict[bytes, bytes | Callable[[int], Pieces]] = {STATUS: RUNNING, **(answers or {})}
        self.loopback = loopback
        self.echo = echo
        self.dead = dead
        self.heard: list[bytes] = []
        self.times: list[float] = []

    def receive(self, data: bytes, now: float) -> Pieces:
        asked = self.heard.count(data)
        self.heard.append(data)
        self.times.append(now)
        pieces: Pieces = [(0.0, data)] if self.echo else []
        if not self.dead:
            pieces += self._answer(data, asked)
        return [(now + after, piece) for after, piece in pieces]

    def _answer(self, data: bytes, asked: int) -> Pieces:
        rule = self.answers.get(data, data if data[3:5] == b"4E" and self.loopback else b"")
        if callable(rule):
            return rule(asked)
        return soon(rule) if rule else SILENCE


def linked(
    peer: Peer,
    *,
    retries: int = 3,
    timeout_s: float = 0.5,
    line: LineSettings | None = None,
    notes: list[str] | None = None,
    transport: MemoryTransport | None = None,
) -> Link:
    """A link to a peer whose fences are ``nonce(0)``, ``nonce(1)`` and so on."""
    numbers = itertools.count()
    return Link(
        transport or MemoryTransport(peer),
        FACON,
        1,
        line or LineSettings(),
        timeout_s=timeout_s,
        retries=retries,
        nonces=lambda: b"N%d" % next(numbers),
        note=(lambda _: None) if notes is None else notes.append,
    )


def fences(heard: Iterable[bytes]) -> int:
    """How many of the requests are loopbacks."""
    return sum(request[3:5] == b"4E" for request in heard)
