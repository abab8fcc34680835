"""FACON frames for the tests, independent of the simulator's own code."""

from __future__ import annotations

from typing import TYPE_CHECKING

if TYPE_CHECKING:
    from fatektool.simulator.line import SimulatedLine
    from fatektool.simulator.slaves.base import Slave


def frame(data: str, *, station: int = 1) -> bytes:
    """STX, station, what is given (command and data), LRC, ETX."""
    body = b"\x02" + f"{station:02X}{data}".encode("latin-1")
    return body + f"{sum(body) % 256:02X}".encode() + b"\x03"


def answers(slave: Slave, data: bytes) -> list[bytes]:
    """What the slave answers to all requests that ``data`` completes."""
    return [answer for request in slave.cut(data) if (answer := slave.answer(request)) is not None]


def ask(slave: Slave, data: str, *, station: int = 1) -> str:
    """The answer's data, error character first; its envelope is checked here."""
    (answer,) = answers(slave, frame(data, station=station))
    text = answer.decode("latin-1")
    assert answer == frame(text[3:-3], station=station)
    assert text[3:5] == data[:2]
    return text[5:-3]


def sent(line: SimulatedLine, data: bytes, now: float = 0.0) -> bytes:
    """All bytes that come back, whenever."""
    return b"".join(piece for _, piece in line.receive(data, now))
