"""A recorded PLC: it answers each request as it did then, byte for byte, and as late.

::

    recorded    ask A   answer 1      ask B   nothing      ask B   answer 2
    replayed    A ──> answer 1, and again for ever         B ──> silence, then answer 2 for ever

What came between a request and the next one is the answer to it: late answers to earlier requests, noise and
echoes too, as the same client will ask the same again. Each request has its own row of answers, whoever asks,
through whatever listener. A request that was never recorded gets no answer, and is counted.

Only a loopback is no question of its own: a client that sends one with fresh content means the same as
before. So the loopbacks to a station are one sequence, and in what was heard the old content gives way to the
new; when the sequence is used up, a station that answered any goes on to answer them.

Nothing here depends on the protocol: a ``Slave`` cuts the requests, and says how a loopback is answered.
"""

from __future__ import annotations

from dataclasses import dataclass, field
from typing import TYPE_CHECKING, NamedTuple

from fatektool.errors import DataError, UsageError
from fatektool.protocols import DEFAULT
from fatektool.simulator.build import build_plcs
from fatektool.simulator.slaves.base import BROADCAST, RequestFrame, RequestKind
from fatektool.simulator.slaves.registry import SLAVES

if TYPE_CHECKING:
    from collections.abc import Callable, Iterable, Mapping

    from fatektool.simulator.plc import SimulatedPlc
    from fatektool.simulator.slaves.base import Slave

_MOST_NAMES = 1000
"""How many different unknown requests are remembered; all are counted."""


class Recorded(NamedTuple):
    """One piece of a recorded conversation.

    Attributes:
        time_s: when, in seconds since any moment.
        sent: True for what the client sent, False for what it received.
        data: the bytes.
    """

    time_s: float
    sent: bool
    data: bytes


@dataclass(slots=True)
class _Exchange:
    """A request, when it was asked, and what came before the next: seconds after it, bytes."""

    request: RequestFrame
    time_s: float
    heard: list[tuple[float, bytes]] = field(default_factory=list)


class Replay:
    """A recording at work, for a ``Server``: one walk through the answers, shared by all lines.

    Args:
        records: the recording, in order.
        protocol: a name of ``SLAVES``.
        speed: 1 for the recorded delays, 10 for a tenth of them, 0 for none.
        on_unknown: is called with each request that was not recorded.

    Raises:
        DataError: there is no request in it.
        UsageError: a speed below 0.

    Attributes:
        unknown: how often each request came that was not recorded.
        unknown_count: how many those were in all.
    """

    powered = True

    def __init__(
        self,
        records: Iterable[Recorded],
        protocol: str = DEFAULT,
        *,
        speed: float = 1.0,
        on_unknown: Callable[[RequestFrame], None] = lambda _: None,
    ) -> None:
        if not speed >= 0:  # refuses NaN too
            raise UsageError(f"a replay's speed is 0 or more, not {speed}")
        make_slave = SLAVES[protocol].make
        exchanges = _exchanges(records, make_slave)
        if not exchanges:
            raise DataError(
                f"no {protocol} request in the recording",
                hint="if another protocol was recorded, name it with --protocol",
            )
        self.unknown: dict[RequestFrame, int] = {}
        self.unknown_count = 0
        self._make_slave = make_slave
        self._pace = 1 / speed if speed else 0.0
        self._on_unknown = on_unknown
        # Of these PLCs nothing is asked but how they would answer a loopback.
        stations = {exchange.request.station for exchange in exchanges} - {BROADCAST}
        self._plcs = build_plcs(sorted(stations), ladder_words=1) if stations else {}
        self._echoes = make_slave(self._plcs)
        self._left: dict[object, list[_Exchange]] = {}
        for exchange in exchanges:
            self._left.setdefault(_question(exchange.request), []).append(exchange)
        for answers in self._left.values():
            if answers[0].request.kind is RequestKind.LOOPBACK:
                self._prepare_loopbacks(answers)
            answers.reverse()  # the next one is taken from the end

    def line(self, *, whole_answers: bool = False) -> ReplayLine:
        """A new line to the recorded PLCs."""
        del whole_answers  # a recorded answer is always given in the pieces in which it was recorded
        return ReplayLine(self, self._make_slave(self._plcs))

    def answer(self, request: RequestFrame) -> list[tuple[float, bytes]]:
        """What comes back: seconds after the request, bytes. Nothing for a silence."""
        answers = self._left.get(_question(request))
        if answers is None:
            self._count_unknown(request)
            return []
        exchange = answers.pop() if len(answers) > 1 else answers[0]
        heard = exchange.heard
        if exchange.request.raw != request.raw:
            # What a two-wire line echoes is the request itself, which need not be what answers it.
            swaps = {exchange.request.raw: request.raw, self._echo(exchange.request): self._echo(request)}
            for old, new in swaps.items():
                if old:  # no PLC answers a broadcast
                    heard = [(delay_s, data.replace(old, new)) for delay_s, data in heard]
        return [(delay_s * self._pace, data) for delay_s, data in heard]

    def _prepare_loopbacks(self, answers: list[_Exchange]) -> None:
        """Make contents exchangeable, and see to it that a loopback behind the last one is answered too."""
        good = None
        for exchange in answers:
            echo = self._echo(exchange.request)
            heard = b"".join(data for _, data in exchange.heard)
            if echo and echo in heard:
                if not any(echo in data for _, data in exchange.heard):  # it came in pieces
                    exchange.heard = [(exchange.heard[-1][0], heard)]
                delay_s = next(delay_s for delay_s, data in exchange.heard if echo in data)
                good = _Exchange(exchange.request, exchange.time_s, [(delay_s, echo)])
        if good is not None:
            answers.append(good)

    def _echo(self, request: RequestFrame) -> bytes:
        return self._echoes.answer(request) or b""

    def _count_unknown(self, request: RequestFrame) -> None:
        self.unknown_count += 1
        named = request._replace(end=0)
        if named in self.unknown or len(self.unknown) < _MOST_NAMES:
            self.unknown[named] = self.unknown.get(named, 0) + 1
        self._on_unknown(request)


class ReplayLine:
    """One connection to a recorded PLC: bytes and times in, bytes and times out.

    Args:
        replay: the answers.
        slave: cuts the requests; used by this line alone.
    """

    def __init__(self, replay: Replay, slave: Slave) -> None:
        self._replay = replay
        self._slave = slave

    def receive(self, data: bytes, now: float) -> list[tuple[float, bytes]]:
        """Take bytes of requests; give what comes back, as (due time, bytes), times never decreasing.

        Requests that come at once are answered one after the other. One that comes while an answer is still
        due does not wait for it: its client has given that answer up, as it did when this was recorded.
        """
        due: list[tuple[float, bytes]] = []
        for request in self._slave.cut(data):
            start = due[-1][0] if due else now
            due += [(start + delay_s, piece) for delay_s, piece in self._replay.answer(request)]
        return due

    def datagram(self, data: bytes, now: float) -> list[tuple[float, bytes]]:
        """Like ``receive`` for a medium in which every message is complete."""
        self._slave.reset()
        due = self.receive(data, now)
        self._slave.reset()
        return due


def _question(request: RequestFrame) -> object:
    """What makes two requests the same one."""
    return (request.station, request.kind) if request.kind is RequestKind.LOOPBACK else request.raw


def _exchanges(
    records: Iterable[Recorded], make_slave: Callable[[Mapping[int, SimulatedPlc]], Slave]
) -> list[_Exchange]:
    """The requests in a recording, each with what it heard.

    A request may be in several records, and several in one. What came before the first is left out: it
    answers nothing.
    """
    slave = make_slave({})
    groups: list[list[_Exchange]] = []
    for record in records:
        if record.sent:
            asked = [_Exchange(request, record.time_s) for request in slave.cut(record.data)]
            if asked:
                groups.append(asked)
        elif groups:
            last = groups[-1][-1]
            latest = last.heard[-1][0] if last.heard else 0.0  # clocks have been known to be set back
            last.heard.append((max(latest, record.time_s - last.time_s), record.data))
    for group in groups:
        if len(group) > 1:
            _share_out(group, make_slave({}))
    return [exchange for group in groups for exchange in group]


def _share_out(group: list[_Exchange], slave: Slave) -> None:
    """Give each of several requests that were sent at once its own answer.

    They are known by station and command, where the protocol's answers can be cut as its requests are; what
    cannot be told apart stays with the last request.
    """
    last = group[-1]
    if not last.heard:
        return
    delay_s, heard = last.heard[0][0], b"".join(data for _, data in last.heard)
    last.heard = []
    waiting = list(group)
    taken = 0
    for answer in slave.cut(heard):
        for exchange in waiting:
            asked = exchange.request
            if (asked.station, asked.command) == (answer.station, answer.command):
                exchange.heard.append((delay_s, heard[taken : answer.end]))
                taken = answer.end
                waiting.remove(exchange)
                break
    if heard[taken:]:
        last.heard.append((delay_s, heard[taken:]))
