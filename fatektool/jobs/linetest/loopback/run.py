"""The loopback test: how many exchanges are answered as they should be, and how fast. Nothing is retried.

::

    request ─> PLC ─> the same characters       ok
                      an error code             refused
                      other characters          mismatch
                      a wrong checksum          checksum
                      bytes that are no frame   garbled
                      those of an earlier one   stale
                      nothing in time           timeout

Each exchange is counted as one of these; if none was ok and several were received, as the first of them in
this list. What is received before the right answer is no error of this exchange: a late answer is the error
of its own exchange.

An exchange that failed may still be answered later. So no request has the same characters as an unanswered
one before it, unless that one's time-out was waited for once more.

A broken connection is one exchange with a time-out; if it cannot be made again, the test ends.

Memory does not grow with the length of the test: times are counted in buckets (``latency``).
"""

from __future__ import annotations

from math import inf
from typing import TYPE_CHECKING, Final

from fatektool.errors import TransportClosed
from fatektool.jobs.linetest.loopback.by_plc import PlcExchanger
from fatektool.jobs.linetest.loopback.by_program import RawExchanger
from fatektool.jobs.linetest.loopback.data import payloads
from fatektool.jobs.linetest.loopback.result import LoopbackPlan, LoopbackResult, Tally

if TYPE_CHECKING:
    from collections.abc import Callable

    from fatektool.client import Plc
    from fatektool.exchange.link import Link
    from fatektool.jobs.linetest.loopback.exchange import Exchanger

_FASTER_THAN_WIRE: Final = 0.9
_LISTENED_S: Final = 2.0


def run_loopback(
    plc: Plc, plan: LoopbackPlan, on_exchange: Callable[[LoopbackResult], object] | None = None
) -> LoopbackResult:
    """Send, compare, count, until the plan is done, the line is lost, or Ctrl-C.

    Args:
        plc: the PLC.
        plan: what to do.
        on_exchange: gets the figures so far after each exchange.
    """
    test = _Test(plc.link, plan)
    try:
        test.run(on_exchange)
        test.wait_for_the_last()
    except KeyboardInterrupt:
        test.result.ended = "interrupted"
    except TransportClosed as error:
        test.result.ended, test.result.lost = "line lost", str(error)
    finally:
        test.end()
    return test.result


class _Test:
    def __init__(self, link: Link, plan: LoopbackPlan) -> None:
        self.result = LoopbackResult(plan, link.timeout_s)
        heard = self.result.heard
        self._exchanger: Exchanger = (
            PlcExchanger(link, heard) if plan.raw is None else RawExchanger(link, heard, plan.raw)
        )
        self._byte_time_s = link.byte_time_s
        self._clock = link.transport.clock
        self._began = self._clock()
        self._end = inf
        self._heard_before = 0

    def run(self, on_exchange: Callable[[LoopbackResult], object] | None) -> None:
        result, exchanger = self.result, self._exchanger
        plan = result.plan
        exchanger.begin()
        self._heard_before = exchanger.bytes_received
        self._began = due = self._clock()
        self._end = inf if plan.duration_s is None else self._began + plan.duration_s
        for data in payloads(plan.sizes, plan.patterns, exchanger.characters, plan.seed):
            if plan.count is not None and result.total.sent >= plan.count:
                return
            if plan.interval_s:
                exchanger.listen_until(min(due, self._end))
                due = max(due + plan.interval_s, self._clock())
            if self._clock() >= self._end:
                result.ended = "duration"
                return
            if data in exchanger.unanswered:  # its answer, if it comes now, could be that one's
                exchanger.listen_until(self._clock() + result.timeout_s)
                exchanger.unanswered.clear()
            self._exchange(data)
            if on_exchange is not None:
                self.measure()
                on_exchange(result)

    def wait_for_the_last(self) -> None:
        """Wait for late answers, which are no lost ones then."""
        if self.result.plan.raw is not None or not self._exchanger.unanswered:
            return  # such a frame does not say which request it answers
        if self.result.heard.late or not self._exchanger.bytes_received:
            self._exchanger.listen_until(self._clock() + min(3 * self.result.timeout_s, _LISTENED_S))

    def end(self) -> None:
        """The test is over."""
        self.measure()
        self._exchanger.end()

    def measure(self) -> None:
        """Update the figures that are not counted by exchange."""
        result, exchanger = self.result, self._exchanger
        result.duration_s = self._clock() - self._began
        result.bytes_received = exchanger.bytes_received - self._heard_before
        result.wire_s = (result.bytes_sent + result.bytes_received) * self._byte_time_s
        result.echoes = exchanger.echoes

    def _exchange(self, data: bytes) -> None:
        result, exchanger = self.result, self._exchanger
        frame_bytes = exchanger.frame_bytes(data)
        result.bytes_sent += frame_bytes
        wire_s = 2 * frame_bytes * self._byte_time_s
        exchanger.ready()
        began = self._clock()
        error = exchanger.exchange(data)
        latency_s = self._clock() - began
        if error is None:
            result.heard.faster_than_wire += latency_s < wire_s * _FASTER_THAN_WIRE
            result.heard.steps.add(latency_s, wire_s)
        result.total.count(error, latency_s, wire_s)
        result.by_size.setdefault(len(data), Tally()).count(error, latency_s, wire_s)
