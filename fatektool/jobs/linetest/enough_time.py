"""The time-out that a PLC with late answers needs: from the measured times, then tried."""

from __future__ import annotations

from dataclasses import dataclass
from typing import TYPE_CHECKING, Final

from fatektool.exchange.no_answer import longer_timeout
from fatektool.jobs.linetest.loopback.result import LoopbackPlan
from fatektool.jobs.linetest.loopback.run import run_loopback

if TYPE_CHECKING:
    from fatektool.client import Plc

_TRY: Final = LoopbackPlan(count=4, sizes=(0, 16, 64), max_error_rate=1.0)
_MOST_TRIES: Final = 3
_LONGEST_S: Final = 10.0
_QUIET_TRIES: Final = 4


@dataclass(frozen=True, slots=True)
class EnoughTime:
    """A time-out, and the result of trying it.

    Attributes:
        timeout_s: the time-out.
        sent: loopbacks.
        ok: those that were answered in this time.
        slowest_s: how long the slowest of them took, without wire time.
    """

    timeout_s: float
    sent: int
    ok: int
    slowest_s: float

    @property
    def proven(self) -> bool:
        """True if all were answered."""
        return 0 < self.ok == self.sent


def find_enough_time(plc: Plc, late_s: float) -> EnoughTime:
    """Try longer time-outs until one is long enough; the link keeps the last one.

    Args:
        plc: the PLC with late answers.
        late_s: how long the slowest answer took.

    Raises:
        KeyboardInterrupt: Ctrl-C.
        LineError: the line was lost.
    """
    link = plc.link
    timeout_s = min(longer_timeout(late_s), _LONGEST_S)
    tried = EnoughTime(timeout_s, 0, 0, 0.0)
    for _ in range(_MOST_TRIES):
        _wait_for_quiet(plc, timeout_s)
        link.state.timeout_s = timeout_s
        result = run_loopback(plc, _TRY)
        if result.ended == "interrupted":
            raise KeyboardInterrupt
        total = result.total
        slowest_s = (result.turnaround.summary_ms()["max"] or 0.0) / 1000
        if total.ok == total.sent:
            link.state.timeout_s = min(timeout_s, longer_timeout(slowest_s))  # all of them came in that, too
            return EnoughTime(link.timeout_s, total.sent, total.ok, slowest_s)
        tried = EnoughTime(timeout_s, total.sent, total.ok, slowest_s)
        timeout_s = min(max(longer_timeout(result.heard.late_s), 2 * timeout_s), _LONGEST_S)
        if timeout_s == tried.timeout_s:
            break
    return tried


def _wait_for_quiet(plc: Plc, quiet_s: float) -> None:
    """Receive late answers until nothing comes for so long."""
    receiver, clock = plc.link.receiver, plc.link.transport.clock
    for _ in range(_QUIET_TRIES):
        received = plc.link.counters.bytes_received
        receiver.listen_until(clock() + quiet_s)
        if plc.link.counters.bytes_received == received:
            break
    receiver.fence_passed()
