"""One exchange with a PLC: deadline, retry, and never another question's answer.

Answers do not name their question: a 4F answer carries no page number, a 46 answer no register. So after a
time-out the late answer to page 5 would pass for page 6. What keeps them apart:

- Input is dropped before each request.
- After any doubt (a time-out, garbage, an answer that nobody asked for) a **fence** is put up before the next
  request: see ``fences``. Where answers repeat a number of their request (``Codec.numbers``), that tells them
  apart, and none is needed.
- A write whose answer was lost is read back before it is sent again.

``suspicions`` counts what could mean that an earlier answer was taken for another's: input that nobody asked
for. Whoever sends many requests of one kind puts up a fence at the end and reads again what stands in doubt:
that is ``batch.ask_all``.

One try is ``attempt``. A PLC whose answers are seen to come late gets more time, up to four times; one that
is silent does not. One that says that it is busy is asked again, after growing pauses. What the link asks for
itself (a fence, a read to learn whether the line echoes, a read-back) is never told as what its caller has
asked: if that is refused, the answer that is wanted is looked for without it.
"""

from __future__ import annotations

import os
from typing import TYPE_CHECKING, Any, Final, TypeVar

from fatektool.errors import (
    DeadlinePassed,
    FrameError,
    GatewayTimeout,
    LineError,
    LineReadOnly,
    PlcBusy,
    PlcRefused,
    TransportClosed,
    TransportError,
)
from fatektool.exchange.attempts import Attempts
from fatektool.exchange.fences import Fences
from fatektool.exchange.no_answer import ROOM, Account, Silence, late_words, longer_timeout
from fatektool.exchange.receiver import Hearing
from fatektool.exchange.sending import Sender
from fatektool.protocol.codec import require_station
from fatektool.protocol.read_back import read_back
from fatektool.transport.base import no_note

if TYPE_CHECKING:
    from collections.abc import Callable

    from fatektool.exchange.sending import Sent
    from fatektool.protocol.codec import Codec
    from fatektool.protocol.commands import Request
    from fatektool.transport.base import LineSettings, Transport

A = TypeVar("A")

MOST_PATIENCE: Final = 4
"""So many times the time-out is an answer waited for, where answers were seen to come late."""

LONGEST_LISTENING_S: Final = 2.0
"""Before a PLC is called silent, it is listened to for so much longer than its time-out, at most."""

LONGEST_PAUSE_S: Final = 5.0
"""Between two questions to a PLC that is busy."""


class Link:
    """Exchanges with one station over one transport.

    Args:
        transport: the medium, open.
        codec: the protocol.
        station: 1 to the codec's last.
        line: speed and format, for wire times; over TCP and UDP that of the line behind the gateway.
        timeout_s: the PLC's time to answer, beside wire time.
        retries: further tries of one exchange.
        nonces: gives the fences' nonces, never the same twice; for tests.
        read_only: refuse every request that writes, before a byte is sent.
        note: is told what a curious user may want to know.
        warn: is told once that answers come late.
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
        note: Callable[[str], None] = no_note,
        warn: Callable[[str], None] = no_note,
    ) -> None:
        require_station(codec, station)
        self.transport = transport
        self.codec = codec
        self.station = station
        self.timeout_s = timeout_s
        self.retries = retries
        self.hearing = Hearing(transport, codec.decoder(), station)
        self.counters = self.hearing.counters
        self.line = line
        self.byte_time_s = line.byte_time_s
        self.read_only = read_only
        self.note = note
        self.warn = warn
        self.echoes: bool | None = None
        self.begin_with_echo()
        self.patient = True  # False where every answer is to have the same time
        self._late_told_s = 0.0
        self.answered: set[int] = set()  # commands
        self._attempts = Attempts(self)
        self.fences = Fences(self, nonces)
        self.sender = Sender(self)

    # --- what others call -------------------------------------------------------------------------

    def ask(self, request: Request[A]) -> A:
        """Send a request and give its answer, with retries.

        Raises:
            NoAnswer: no try found an answer to trust.
            PlcRefused: the answer is an error code.
            PlcBusy: it is at work, and still was at the last try.
            LineReadOnly: it writes, and the line may only be read.
        """
        self.require_leave(request)
        failure: LineError | PlcBusy | None = None
        account = Account(self)
        for attempt in range(self.retries + 1):
            self.hearing.drop_input()
            if self.hearing.doubt:
                try:
                    self.fence(request)
                except LineError as error:  # the fence stays up: further tries would be in vain
                    told = failure if isinstance(failure, TransportClosed | GatewayTimeout) else error
                    raise self.silence(request, told, account) from error
            sent = account.tries
            try:
                if self.echoes is None and self._needs_a_read_before(request):
                    self.learn_echo()
                account.tries += 1
                answer = self.try_once(request)
            except (TransportError, FrameError) as error:
                failure = error
            except PlcBusy as error:
                failure = error
                self.let_work(attempt)
            else:
                self._tell_if_late()
                return answer
            if account.tries > sent and _may_be_made(request, failure) and self.took(request, account):
                return None  # type: ignore[return-value]  # a write's answer is None
        if isinstance(failure, PlcBusy):
            raise PlcBusy(
                f"{failure.message}; still so {account}",
                code=int(failure.details["code"], 16),
                command=int(failure.details["command"], 16),
                accepted=failure.accepted,
                hint=f"wait until it has done its work, or give more than --retries {self.retries}",
            )
        raise self.silence(request, failure, account)

    def let_work(self, attempt: int) -> None:
        """Wait for a PLC that is busy, longer each time.

        Args:
            attempt: how often it was waited for already.
        """
        if attempt < self.retries:
            pause_s = min(self.timeout_s * 2**attempt, LONGEST_PAUSE_S)
            self.hearing.listen_until(self.transport.clock() + pause_s)

    def _tell_if_late(self) -> None:
        late_s = self.hearing.late_s
        if late_s > self._late_told_s:
            self._late_told_s = late_s * ROOM  # told again when it is much later than that
            self.warn(
                f"answers come late: {late_words(late_s, self.timeout_s)}; "
                f"give --timeout {longer_timeout(late_s):g}"
            )

    @property
    def suspicions(self) -> int:
        """How often something came that may have been an answer gone astray; numbered ones never do."""
        return 0 if self.numbered else self.hearing.suspicions

    @property
    def signs(self) -> tuple[int, int, int]:
        """Suspicions, trouble and fences so far: the same twice means that nothing was out of order."""
        counters = self.counters
        return (0, 0, 0) if self.numbered else (self.suspicions, counters.trouble, counters.fences)

    @property
    def numbered(self) -> bool:
        """True if each answer tells which request it belongs to."""
        return self.codec.numbers > 1

    def fence(self, before: Request[Any] | None = None) -> None:
        """Make sure that no answer to an earlier request can come any more: see ``fences``.

        Args:
            before: what is asked next, if that is known: the fence's answer must not pass for its either.

        Raises:
            NoAnswer: the PLC does not answer it.
            PlcRefused: it refuses it.
        """
        self.fences.put_up(before)

    def broadcast(self, request: Request[None]) -> None:
        """Send a request to every PLC on the line (station 0). Nobody answers.

        Raises:
            LineReadOnly: it writes, and the line may only be read.
        """
        self.require_leave(request)
        self.transport.write(self.codec.encode(0, request))

    def require_leave(self, request: Request[A]) -> None:
        """Check that this request may be sent at all.

        Raises:
            LineReadOnly: it writes, and the line may only be read.
        """
        if self.read_only and request.writes:
            raise LineReadOnly(f"{request.command.words} ({request.command:02X})")

    def begin_with_echo(self) -> None:
        """What is known of an echo before anything was asked: a TCP server has none.

        Of unit 0 nothing counts as known, so that a read goes before a write.
        """
        if self.numbered:
            self.echoes = None if self.station == 0 else False

    def _needs_a_read_before(self, request: Request[Any]) -> bool:
        """True where nothing is known of this line yet, and this request could be misunderstood.

        The echo of some could pass for the answer. And a write to unit 0 is handed by a gateway to every PLC
        behind it, none of which answers: what answers a read there is one PLC.
        """
        return self.codec.echo_may_pass(request) or (request.writes and self.station == 0)

    # --- one try ----------------------------------------------------------------------------------

    def learn_echo(self) -> None:
        """See ``Attempts.learn_echo``."""
        self._attempts.learn_echo()

    def try_once(self, request: Request[A]) -> A:
        """See ``Attempts.once``."""
        return self._attempts.once(request)

    def prepare(self, request: Request[Any]) -> Sent:
        """A request as it goes out; its answer may come from now on, until the next fence.

        Raises:
            UsageError: it cannot be said in this protocol.
            LineReadOnly: it writes, and the line may only be read.
        """
        if self.read_only:
            self.require_leave(request)
        self.fences.note_asked(request)
        self.counters.writes += request.writes
        return self.sender.prepare(request)

    @property
    def wait_s(self) -> float:
        """How long an answer is waited for, beside wire time: longer where answers were seen to come late."""
        late_s = self.hearing.late_s
        if not late_s or not self.patient:
            return self.timeout_s
        return min(max(self.timeout_s, ROOM * late_s), MOST_PATIENCE * self.timeout_s)

    # --- after a failure --------------------------------------------------------------------------

    def took(self, request: Request[A], account: Account | None = None) -> bool:
        """Read back a write whose answer was lost: did the PLC take it?

        Raises:
            LineError: that is not known.
        """
        question, took = read_back(request)  # type: ignore[arg-type]  # request.writes: its answer is None
        account = account or Account(self)
        account.tries = account.tries or 1  # it was sent, whoever did
        try:
            return took(self.ask(question))
        except (PlcRefused, PlcBusy):
            return False
        except LineError as error:
            raise self.silence(request, error, account, unknown=True) from error

    def silence(
        self, request: Request[A], failure: LineError | None, account: Account, *, unknown: bool = False
    ) -> LineError:
        """The error for a request that found no answer to trust: see ``silence.Silence``."""
        if isinstance(failure, TransportClosed | DeadlinePassed):
            return failure
        if not account.alive:
            self.listen_for_late()
        return Silence(self, request, failure, account, unknown).error()

    def listen_for_late(self) -> None:
        """Before a PLC is called silent, or its connection made anew: is it only late?"""
        hearing, since = self.hearing, self.hearing.owed_since
        if since is not None and not hearing.late_s and not hearing.words:
            longest_s = min(MOST_PATIENCE * self.timeout_s, self.timeout_s + LONGEST_LISTENING_S)
            hearing.listen_until(since + longest_s, or_late=True)


def _may_be_made(request: Request[Any], failure: LineError | PlcBusy | None) -> bool:
    """True for a write that may have been made, though this was its answer."""
    if isinstance(failure, GatewayTimeout) and not failure.handed_on:
        return False
    return request.writes and not (isinstance(failure, PlcBusy) and not failure.accepted)
