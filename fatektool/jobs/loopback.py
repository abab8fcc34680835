"""The loopback stress test (4E): how many exchanges come back as they went, and how fast. Nothing is retried.

::

    request ─> PLC ─> the same characters       ok
                      an error code             refused
                      other characters          mismatch
                      a wrong checksum          checksum
                      bytes that are no frame   garbled
                      those of an earlier one   stale
                      nothing in time           timeout

Each exchange ends as one of these; if none was ok and several were heard, as the one that stands further up.
What comes before the right answer is no error of this exchange: a late answer is the error of the one it
belongs to.

An exchange that failed may still be answered later. So no request carries what an unanswered one before it
carried, unless that one's time was waited out once more.

A connection that breaks costs one exchange, a time-out; if it cannot be made anew, the test ends.

Memory does not grow with the length of the test: times are counted in buckets (``latency``).
"""

from __future__ import annotations

from collections import deque
from math import inf
from typing import TYPE_CHECKING, Final

from fatektool.errors import FrameError, LineError, PlcRefused, TransportClosed, TransportError
from fatektool.jobs.loopback_data import payloads
from fatektool.jobs.loopback_result import LoopbackPlan, LoopbackResult, Tally
from fatektool.protocol.commands import Command, Loopback

if TYPE_CHECKING:
    from collections.abc import Callable

    from fatektool.client import Plc
    from fatektool.link import Link
    from fatektool.protocol.codec import Frame

_REMEMBERED: Final = 16
_SAMPLE_BYTES: Final = 64
_LEARNING_TRIES: Final = 3
_FASTER_THAN_WIRE: Final = 0.9
_WORST_FIRST: Final = ("mismatch", "checksum", "garbled", "stale")


def run_loopback(
    plc: Plc, plan: LoopbackPlan, on_exchange: Callable[[LoopbackResult], object] | None = None
) -> LoopbackResult:
    """Send, compare, count, until the plan is done, the line is lost, or Ctrl-C.

    Args:
        plc: who is asked.
        plan: what to do.
        on_exchange: is shown the figures so far after each exchange.
    """
    test = _Test(plc.link, plan)
    try:
        test.run(on_exchange)
    except KeyboardInterrupt:
        test.result.ended = "interrupted"
    except TransportClosed as error:
        test.result.ended, test.result.lost = "line lost", str(error)
    finally:
        test.measure()
    return test.result


class _Test:
    def __init__(self, link: Link, plan: LoopbackPlan) -> None:
        self.result = LoopbackResult(plan, link.timeout_s)
        self._link = link
        self._clock = link.transport.clock
        self._unanswered: list[bytes] = []
        self._earlier: deque[bytes] = deque(maxlen=_REMEMBERED)
        self._answered: bytes | None = None
        self._hung_up = False
        self._seen: set[str] = set()  # in this exchange
        self._began = self._clock()
        self._end = inf
        self._heard_before = 0
        link.hearing.on_stray = self._on_stray
        link.hearing.on_bad_bytes = self._on_bad_bytes

    def run(self, on_exchange: Callable[[LoopbackResult], object] | None) -> None:
        result, link = self.result, self._link
        plan = result.plan
        self._learn_echo()
        self._heard_before = link.counters.bytes_heard
        self._began = due = self._clock()
        self._end = inf if plan.duration_s is None else self._began + plan.duration_s
        for data in payloads(plan.sizes, plan.patterns, link.codec.loopback_alphabet, plan.seed):
            if plan.count is not None and result.total.sent >= plan.count:
                return
            if plan.interval_s:
                link.hearing.listen_until(min(due, self._end))
                due = max(due + plan.interval_s, self._clock())
            if self._clock() >= self._end:
                result.ended = "duration"
                return
            if data in self._unanswered:  # its answer, if it comes now, could be that one's
                link.hearing.listen_until(self._clock() + link.timeout_s)
                self._unanswered.clear()
            self._exchange(data)
            if on_exchange is not None:
                self.measure()
                on_exchange(result)

    def measure(self) -> None:
        """Bring the figures up to date that are not counted by exchange."""
        result, link = self.result, self._link
        result.duration_s = self._clock() - self._began
        result.bytes_received = link.counters.bytes_heard - self._heard_before
        result.wire_s = (result.bytes_sent + result.bytes_received) * link.byte_time_s
        result.echoes = link.echoes

    def _learn_echo(self) -> bool | None:
        """By a request that cannot be mistaken for its echo; where nobody answers nothing is learnt: None."""
        for _ in range(_LEARNING_TRIES):
            self._link.hearing.drop_input()
            try:
                self._link.learn_echo()
            except TransportClosed:
                raise
            except (LineError, PlcRefused):
                if self._link.echoes is None:
                    continue
            break
        return self._link.echoes

    def _exchange(self, data: bytes) -> None:
        link, result = self._link, self.result
        request = Loopback(data)
        link.hearing.drop_input()
        link.hearing.patience = 1  # a test gives every answer the same time
        self._seen.clear()
        frame_bytes = link.codec.answer_bytes(request)
        result.bytes_sent += frame_bytes
        wire_s = 2 * frame_bytes * link.byte_time_s
        began = self._clock()
        error = self._error_of(request)
        latency_s = self._clock() - began
        self._earlier.append(data)
        if error is None:
            self._hung_up = False
            self._answered = data
            self._unanswered.clear()
            result.heard.faster_than_wire += latency_s < wire_s * _FASTER_THAN_WIRE
            result.heard.steps.add(latency_s, wire_s)
        else:
            self._unanswered = [*self._unanswered[1 - _REMEMBERED :], data]
        result.total.count(error, latency_s, wire_s)
        result.by_size.setdefault(len(data), Tally()).count(error, latency_s, wire_s)

    def _error_of(self, request: Loopback) -> str | None:
        """Try once; None if the answer is good."""
        link = self._link
        heard, echoes = link.counters.bytes_heard, link.counters.echoes
        try:
            link.try_once(request)
            if link.echoes is None:  # was it an answer or an echo?
                return None if self._learn_echo() is False else "timeout"
        except PlcRefused:  # or a late answer of one character, which looks the same
            return "stale" if any(len(data) == 1 for data in self._unanswered) else "refused"
        except TransportClosed:  # a gateway may hang up once; the next request calls it again
            if self._hung_up:
                raise
            self._hung_up = True
            return "timeout"
        except (TransportError, FrameError):
            echo_bytes = link.codec.answer_bytes(request) * (link.counters.echoes - echoes)
            return self._worst_heard(link.counters.bytes_heard - heard - echo_bytes)
        return None

    def _worst_heard(self, heard_bytes: int) -> str:
        """What an exchange without an answer counts as."""
        for kind in _WORST_FIRST:
            if kind in self._seen:
                return kind
        if heard_bytes <= 0:
            return "timeout"
        self._hear_noise(heard_bytes, b"")  # the beginning of a frame
        return "garbled"

    # --- what is heard beside the answers ------------------------------------------------------------

    def _on_stray(self, frame: Frame) -> None:
        heard = self.result.heard
        if frame.station != self._link.station:
            heard.foreign[frame.station] = heard.foreign.get(frame.station, 0) + 1
            self._seen.add("mismatch")
        elif frame.command != Command.LOOPBACK or frame.data in self._earlier:
            if frame.command == Command.LOOPBACK and frame.data == self._answered:
                heard.twice += 1
            else:
                heard.late += 1
            self._seen.add("stale")
        else:
            self._seen.add("mismatch")

    def _on_bad_bytes(self, error: FrameError) -> None:
        self._seen.add("checksum" if error.checksum else "garbled")
        self._hear_noise(len(error.raw), error.raw)

    def _hear_noise(self, count: int, sample: bytes) -> None:
        heard = self.result.heard
        heard.noise_bytes += count
        if len(heard.noise) < _SAMPLE_BYTES:
            heard.noise += sample[: _SAMPLE_BYTES - len(heard.noise)]
