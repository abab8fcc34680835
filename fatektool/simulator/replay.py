"""A recorded PLC: it answers each request as recorded, byte for byte, with the same delay.

::

    recorded    ask A   answer 1      ask B   nothing      ask B   answer 2
    replayed    A ──> answer 1, and again for ever         B ──> silence, then answer 2 for ever

The bytes received between a request and the next one are its answer: also late answers to earlier requests,
noise and echoes, because the same client will send the same requests again. Each request has its own sequence
of answers, for all clients and listeners together. A request that was not recorded gets no answer, and is
counted.

Loopbacks differ, because clients send each one with new data. So the loopbacks to a station are one sequence,
and in the recorded answers the old data is replaced by the new; after the sequence, a station that answered
any goes on answering them.

Nothing here depends on the protocol: a ``Slave`` splits the requests, and answers loopbacks.
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
"""The most different unknown requests that are remembered; all are counted."""


class Recorded(NamedTuple):
    """One record of a trace.

    Attributes:
        time_s: the time in seconds, from any start.
        sent: True if the client sent it, False if it received it.
        data: the bytes.
    """

    time_s: float
    sent: bool
    data: bytes


@dataclass(slots=True)
class _Exchange:
    """A request, its time, and the input before the next one: seconds after it, bytes."""

    request: RequestFrame
    time_s: float
    heard: list[tuple[float, bytes]] = field(default_factory=list)


class Replay:
    """A recording for a ``Server``: one sequence of answers, shared by all lines.

    Args:
        records: the recording, in order.
        protocol: a name of ``SLAVES``.
        speed: 1 for the recorded delays, 10 for a tenth of them, 0 for none.
        on_unknown: gets each request that was not recorded.

    Raises:
        DataError: it has no request.
        UsageError: a speed below 0.

    Attributes:
        unknown: the requests that were not recorded, with their count.
        unknown_count: the total of these counts.
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
            raise UsageError(f"replay speed: expected 0 or more, got {speed}")
        make_slave = SLAVES[protocol].make
        exchanges = _exchanges(records, make_slave)
        if not exchanges:
            raise DataError(
                f"no {protocol} request in the recording",
                hint="use --protocol with the recorded protocol",
            )
        self.unknown: dict[RequestFrame, int] = {}
        self.unknown_count = 0
        self._make_slave = make_slave
        self._pace = 1 / speed if speed else 0.0
        self._on_unknown = on_unknown
        # These PLCs are used only for answers to loopbacks.
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
        del whole_answers  # a recorded answer is always sent in the recorded pieces
        return ReplayLine(self, self._make_slave(self._plcs))

    def answer(self, request: RequestFrame) -> list[tuple[float, bytes]]:
        """The answer: seconds after the request, bytes; empty for none."""
        answers = self._left.get(_question(request))
        if answers is None:
            self._count_unknown(request)
            return []
        exchange = answers.pop() if len(answers) > 1 else answers[0]
        heard = exchange.heard
        if exchange.request.raw != request.raw:
            # The echo of a two-wire line is the request, which may differ from the answer.
            swaps = {exchange.request.raw: request.raw, self._echo(exchange.request): self._echo(request)}
            for old, new in swaps.items():
                if old:  # no PLC answers a broadcast
                    heard = [(delay_s, data.replace(old, new)) for delay_s, data in heard]
        return [(delay_s * self._pace, data) for delay_s, data in heard]

    def _prepare_loopbacks(self, answers: list[_Exchange]) -> None:
        """Make the data replaceable, and answer loopbacks after the last recorded one."""
        good = None
        for exchange in answers:
            echo = self._echo(exchange.request)
            heard = b"".join(data for _, data in exchange.heard)
            if echo and echo in heard:
                if not any(echo in data for _, data in exchange.heard):  # received in pieces
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
        slave: splits the bytes into requests; used only by this line.
    """

    def __init__(self, replay: Replay, slave: Slave) -> None:
        self._replay = replay
        self._slave = slave

    def receive(self, data: bytes, now: float) -> list[tuple[float, bytes]]:
        """Receive bytes of requests; returns the answers as (due time, bytes), times never decreasing.

        Requests that are received together are answered one after the other. A request that is received while
        an answer is still due does not wait: its client has given up that answer, as in the recording.
        """
        due: list[tuple[float, bytes]] = []
        for request in self._slave.cut(data):
            start = due[-1][0] if due else now
            due += [(start + delay_s, piece) for delay_s, piece in self._replay.answer(request)]
        return due

    def datagram(self, data: bytes, now: float) -> list[tuple[float, bytes]]:
        """Like ``receive``, for a medium in which every message is complete."""
        self._slave.reset()
        due = self.receive(data, now)
        self._slave.reset()
        return due


def _question(request: RequestFrame) -> object:
    """The key by which requests are equal."""
    return (request.station, request.kind) if request.kind is RequestKind.LOOPBACK else request.raw


def _exchanges(
    records: Iterable[Recorded], make_slave: Callable[[Mapping[int, SimulatedPlc]], Slave]
) -> list[_Exchange]:
    """The requests in a recording, each with its answer.

    A request may be in several records, and a record may have several requests. Input before the first
    request is ignored: it answers nothing.
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
            latest = last.heard[-1][0] if last.heard else 0.0  # clocks may be set back
            last.heard.append((max(latest, record.time_s - last.time_s), record.data))
    for group in groups:
        if len(group) > 1:
            _share_out(group, make_slave({}))
    return [exchange for group in groups for exchange in group]


def _share_out(group: list[_Exchange], slave: Slave) -> None:
    """Assign the answers to several requests that were sent together.

    They are assigned by station and command, if the protocol's answers have the same form as its requests;
    the rest stays with the last request.
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
