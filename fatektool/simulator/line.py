"""A line to simulated PLCs, without I/O and without a clock: bytes and times in, bytes and times out.

::

    receive(request, now)
       │  the request on the wire             len * bits_per_char / baud
       │  the PLC scans and answers           scan_s
       v  the answer on the wire, in pieces   about 2 ms of wire time each, due with their last char
    [(due, piece), (due, piece) ...]

Times are those of the clock of ``now``. They are ideal times: if a caller is late with one piece, the next is
not later. The wires of both directions have their own times, as on RS-232: a request waits for an earlier one
on the wire, an answer waits for the answers before it, so due times never decrease from one call to the next.

Without a baud rate there is no wire time, and an answer is one piece.

A USB adapter with a *latency timer* passes on received bytes only at its ticks: then a piece is due at the
next tick. Ticks are multiples of the timer on the clock of ``now``.
"""

from __future__ import annotations

from math import floor
from typing import TYPE_CHECKING

if TYPE_CHECKING:
    from collections.abc import Callable

    from fatektool.simulator.faults import Faults
    from fatektool.simulator.slaves.base import RequestFrame, Slave

BITS_PER_CHAR = 10
"""7E1 and 8N1: start, seven or eight bits, parity or none, stop."""

PIECE_S = 0.002
WHOLE_ANSWERS = float("inf")


class SimulatedLine:
    """One connection to the PLCs of a slave.

    Args:
        slave: splits the bytes into requests and answers them; used only by this line.
        faults: injected errors; None for none. Shared by all lines of a simulator.
        baud: bits per second; None for no wire time.
        bits_per_char: with start, parity and stop bits.
        scan_s: the PLC's time from the end of a request to the start of its answer.
        piece_s: wire time of one piece of an answer; ``WHOLE_ANSWERS`` for a medium with datagrams.
        latency_timer_s: seconds between the ticks of a USB adapter, often 16 ms by default; 0 for none.
        after_request: called after a request is executed, before its answer is sent: saves the memory, so
            that nothing is acknowledged that could be lost.
    """

    def __init__(
        self,
        slave: Slave,
        faults: Faults | None = None,
        baud: float | None = None,
        bits_per_char: float = BITS_PER_CHAR,
        scan_s: float = 0.0,
        *,
        piece_s: float = PIECE_S,
        latency_timer_s: float = 0.0,
        after_request: Callable[[], object] | None = None,
    ) -> None:
        self._slave = slave
        self._faults = faults
        self._char_s = bits_per_char / baud if baud else 0.0
        self._scan_s = scan_s
        self._piece_chars = _piece_chars(piece_s, self._char_s)
        self._latency_timer_s = latency_timer_s
        self._after_request = after_request
        self._request_wire_free = float("-inf")
        self._answer_wire_free = float("-inf")
        self._held: list[bytes] = []

    @property
    def powered(self) -> bool:
        """False from a power cut to the next ``power_on``: nothing is received then."""
        return self._faults is None or self._faults.powered

    def receive(self, data: bytes, now: float) -> list[tuple[float, bytes]]:
        """Receive bytes of requests; returns the answers as (due time, bytes), times never decreasing."""
        due: list[tuple[float, bytes]] = []
        if not self.powered:
            return due
        char_s = self._char_s
        start = max(now, self._request_wire_free)
        self._request_wire_free = start + len(data) * char_s
        if self._faults is not None and self._faults.echoes():
            self._send(data, start, due)
        for request in self._slave.cut(data):
            self._serve(request, start + request.end * char_s + self._scan_s, due)
            if not self.powered:
                self._held.clear()
                self._slave.reset()
                break
        return due

    def datagram(self, data: bytes, now: float) -> list[tuple[float, bytes]]:
        """Like ``receive``, for a medium in which every message is complete."""
        self._slave.reset()
        due = self.receive(data, now)
        self._slave.reset()
        return due

    def _serve(self, request: RequestFrame, ready: float, due: list[tuple[float, bytes]]) -> None:
        faults = self._faults
        garbage = None if faults is None else faults.garbage(self._slave, request)
        if garbage is not None:
            self._send(garbage, ready, due)
            return
        answer = self._slave.answer(request) if faults is None else faults.answer(self._slave, request)
        if self._after_request is not None:
            self._after_request()
        if self._held and self.powered:
            held, self._held = self._held, []
            for late in held:
                self._send(late, ready, due)
        if answer is None:
            return
        if faults is None:
            self._send(answer, ready, due)
            return
        spoiled = faults.spoil(self._slave, request, answer)
        if spoiled.late:
            self._held += spoiled.copies
        else:
            for copy in spoiled.copies:
                self._send(copy, ready + spoiled.delay_s, due)

    def _send(self, data: bytes, ready: float, due: list[tuple[float, bytes]]) -> None:
        if not data:
            return
        start = max(ready, self._answer_wire_free)
        char_s = self._char_s
        size = self._piece_chars or len(data)
        for at in range(0, len(data), size):
            piece = data[at : at + size]
            due.append((self._handed_on(start + (at + len(piece)) * char_s), piece))
        self._answer_wire_free = start + len(data) * char_s

    def _handed_on(self, received: float) -> float:
        """The time at which the adapter passes on a received piece: the next tick, never the same."""
        timer_s = self._latency_timer_s
        if not timer_s:
            return received
        ticks = floor(received / timer_s) + 1
        return ticks * timer_s if ticks * timer_s > received else (ticks + 1) * timer_s


def _piece_chars(piece_s: float, char_s: float) -> int:
    """Characters of one piece; 0 for whole answers."""
    if not char_s or piece_s == WHOLE_ANSWERS:
        return 0
    return max(1, round(piece_s / char_s))
