"""Requests to a PLC and their answers: deadlines, retries, and the right answer for each request.

Answers do not identify their request: a 4F answer carries no page number, a 46 answer no register. So after a
time-out, the late answer to page 5 could be taken for page 6. This is prevented as follows:

- Input is dropped before each request.
- After anything unexpected (a time-out, noise, an unsolicited answer), a **fence** is sent before the next
  request: see ``fences``. If answers repeat a number of their request (``Codec.numbers``), no fence is
  needed.
- A write whose answer was lost is read back before it is sent again.

``unsolicited`` counts input after which an earlier answer may have been taken for another's. After many
requests of one kind, a fence is sent, and what may be wrong is read again: that is ``batch.read_all``.

A PLC whose answers are late gets more time, up to four times as much; a silent one does not. A busy PLC is
asked again, after pauses that grow. If the PLC refuses a request of the link itself (a fence, a read to learn
whether the line echoes, a read-back), that is not reported as an answer to the caller's request: the link
goes on without it.

Each part is a file, and imports only those above it::

    state         the PLC, the settings, what is known of the PLC; counters, sent: values
    outstanding   requests whose answers may still be received, and how late answers are
    receiver      input that is not an answer
    sender        output
    attempts      one try: send, read until the answer is received or its time is over
    no_answer     the error when there is none
    fences        after one, no earlier answer can be received
    link          the interface for the rest of the program: tries, fences, read-back
    stream        many requests in a row, while nothing unexpected is received; batch: many, and their proof
"""

from __future__ import annotations

import os
from typing import TYPE_CHECKING, Any, TypeVar

from fatektool.callbacks import ignore
from fatektool.errors import (
    FrameError,
    GatewayTimeout,
    LineError,
    PlcBusy,
    PlcRefused,
    TransportClosed,
    TransportError,
)
from fatektool.exchange.attempts import Attempts
from fatektool.exchange.fences import Fences
from fatektool.exchange.no_answer import Effort, late_words, longer_timeout, no_answer
from fatektool.exchange.receiver import Receiver
from fatektool.exchange.sender import Sender
from fatektool.exchange.state import MARGIN, LinkState
from fatektool.protocol.codec import require_station

if TYPE_CHECKING:
    from collections.abc import Callable

    from fatektool.protocol.codec import Codec
    from fatektool.protocol.commands import Request
    from fatektool.transport.base import LineSettings, Transport

A = TypeVar("A")


class Link:
    """Requests to one station over one transport, and their answers.

    Args:
        transport: the medium, open.
        codec: the protocol.
        station: 1 to the codec's last.
        line: speed and format, for wire times; over TCP and UDP those of the line after the gateway.
        timeout_s: the PLC's time to answer, in seconds, without wire time.
        retries: retries per request.
        nonces: returns the fences' nonces, never the same twice; for tests.
        read_only: refuse every request that writes, before a byte is sent.
        note: gets details, for ``-v``.
        warn: gets a message if answers are late.

    Attributes:
        state: the PLC, the settings, and what is known of the PLC.
        receiver: its input.
        sender: its output.
        attempts: single tries.
        fences: exclude late answers.
        counters: of what was sent and received.
    """

    def __init__(
        self,
        transport: Transport,
        codec: Codec,
        station: int,
        line: LineSettings,
        *,
        timeout_s: float = 0.5,
        retries: int = 3,
        nonces: Callable[[], bytes] = lambda: os.urandom(4).hex().upper().encode(),
        read_only: bool = False,
        note: Callable[[str], None] = ignore,
        warn: Callable[[str], None] = ignore,
    ) -> None:
        require_station(codec, station)
        self.state = state = LinkState(
            transport, codec, station, line, timeout_s=timeout_s, retries=retries, read_only=read_only
        )
        self.receiver = Receiver(state)
        self.sender = Sender(state, self.receiver)
        self.attempts = Attempts(state, self.receiver, self.sender)
        self.fences = Fences(state, self.receiver, self.sender, self.attempts, nonces=nonces, note=note)
        self.transport = transport
        self.line = line
        self.byte_time_s = line.byte_time_s
        self.counters = state.counters
        self.note = note
        self._warn = warn
        self._late_warned_s = 0.0

    @property
    def codec(self) -> Codec:
        """The protocol."""
        return self.state.codec

    @property
    def station(self) -> int:
        """The station of the PLC; ``fences.change_station`` changes it."""
        return self.state.station

    @property
    def timeout_s(self) -> float:
        """The PLC's time to answer, in seconds, without wire time."""
        return self.state.timeout_s

    @property
    def retries(self) -> int:
        """Retries per request."""
        return self.state.retries

    @property
    def echoes(self) -> bool | None:
        """True if the line echoes what is sent; None if not known."""
        return self.state.echoes

    @property
    def unsolicited(self) -> int:
        """The number of inputs after which answers may be shifted; numbered answers never are."""
        return 0 if self.state.numbered else self.receiver.unsolicited

    @property
    def disturbances(self) -> tuple[int, int, int]:
        """Unsolicited input, errors and fences so far: unchanged if nothing unexpected was received."""
        counters = self.counters
        return (0, 0, 0) if self.state.numbered else (self.unsolicited, counters.trouble, counters.fences)

    def ask(self, request: Request[A]) -> A:
        """Send a request and return its answer, with retries.

        Raises:
            NoAnswer: no valid answer in any try.
            PlcRefused: the answer is an error code.
            PlcBusy: the PLC is busy, still at the last try.
            LineReadOnly: it writes, and the line is read-only.
        """
        state = self.state
        state.require_permission(request)
        failure: LineError | PlcBusy | None = None
        effort = Effort(state)
        for attempt in range(state.retries + 1):
            self.receiver.drop_input()
            if self.receiver.needs_fence:
                try:
                    self.fence(request)
                except LineError as error:  # the fence is still needed: more tries are useless
                    cause = failure if isinstance(failure, TransportClosed | GatewayTimeout) else error
                    raise no_answer(state, self.receiver, request, cause, effort) from error
            tries = effort.tries
            try:
                if state.must_learn_echo(request):
                    self.attempts.learn_echo()
                effort.tries += 1
                answer = self.attempts.once(request)
            except (TransportError, FrameError) as error:
                failure = error
            except PlcBusy as error:
                failure = error
                self.attempts.wait_while_busy(attempt)
            else:
                self._warn_if_late()
                return answer
            if effort.tries > tries and _may_be_made(request, failure) and self.is_made(request, effort):
                return None  # type: ignore[return-value]  # a write's answer is None
        if isinstance(failure, PlcBusy):
            raise PlcBusy(
                f"{failure.message}, also {effort}",
                code=int(failure.details["code"], 16),
                command=int(failure.details["command"], 16),
                accepted=failure.accepted,
                hint=f"wait until the PLC is ready, or use more than --retries {state.retries}",
            )
        raise no_answer(state, self.receiver, request, failure, effort)

    def fence(self, before: Request[Any] | None = None) -> None:
        """Exclude later answers to earlier requests: see ``Fences.pass_one``."""
        self.fences.pass_one(before)

    def is_made(self, request: Request[A], effort: Effort | None = None) -> bool:
        """Read back a write whose answer was lost: True if the PLC has made it.

        Raises:
            LineError: that is not known.
        """
        from fatektool.protocol.read_back import read_back  # loaded when an answer is lost

        question, made = read_back(request)  # type: ignore[arg-type]  # request.writes: its answer is None
        effort = effort or Effort(self.state)
        effort.tries = effort.tries or 1  # it was sent, here or by the caller
        try:
            return made(self.ask(question))
        except (PlcRefused, PlcBusy):
            return False
        except LineError as error:
            raise no_answer(self.state, self.receiver, request, error, effort, unknown=True) from error

    def broadcast(self, request: Request[None]) -> None:
        """Send a broadcast to all PLCs on the line (station 0). PLCs do not reply to broadcasts.

        Raises:
            LineReadOnly: it writes, and the line is read-only.
        """
        self.state.require_permission(request)
        self.transport.write(self.codec.encode(0, request))

    def _warn_if_late(self) -> None:
        late_s = self.state.late_s
        if late_s > self._late_warned_s:
            self._late_warned_s = late_s * MARGIN  # again when it is much later than that
            self._warn(
                f"answers are late: {late_words(late_s, self.timeout_s)}; "
                f"use --timeout {longer_timeout(late_s):g}"
            )


def _may_be_made(request: Request[Any], failure: LineError | PlcBusy | None) -> bool:
    """True for a write that may have been made in spite of this error."""
    if isinstance(failure, GatewayTimeout) and not failure.handed_on:
        return False
    return request.writes and not (isinstance(failure, PlcBusy) and not failure.accepted)
