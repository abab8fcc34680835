"""A loopback test as a value: its plan, its counts, its result."""

from __future__ import annotations

from dataclasses import dataclass, field
from typing import TYPE_CHECKING, Final

from fatektool.errors import UsageError
from fatektool.jobs.linetest.binomial import upper_bound
from fatektool.jobs.linetest.latency import Times
from fatektool.jobs.linetest.loopback.data import Pattern
from fatektool.jobs.linetest.steps import Steps
from fatektool.protocol.commands import MAX_LOOPBACK

if TYPE_CHECKING:
    from fatektool.jobs.linetest.raw_frame import RawFrame

DEFAULT_SIZES: Final = (0, 1, 16, 64, 128, 256)
DEFAULT_COUNT: Final = 100
ERRORS: Final = ("timeout", "checksum", "garbled", "mismatch", "stale", "refused")


def size_range(raw: RawFrame | None) -> tuple[int, int]:
    """How few and how many characters one exchange carries."""
    return (0, MAX_LOOPBACK) if raw is None else (raw.least, raw.most)


def usual_sizes(raw: RawFrame | None) -> tuple[int, ...]:
    """The sizes of a test for which none are named."""
    least, most = size_range(raw)
    return tuple(size for size in DEFAULT_SIZES if least <= size <= most)


@dataclass(frozen=True, slots=True)
class LoopbackPlan:
    """What to send, how often, and the limits.

    Args:
        count: exchanges; None for no limit.
        duration_s: begin none after so many seconds; None for no limit.
        sizes: numbers of characters, used in turn: 0 to 256; with ``raw`` up to 511 bytes with the codes.
        patterns: used in turn.
        interval_s: from the start of one to the start of the next; 0 for at once.
        seed: of the random pattern.
        max_error_rate: 0 to 1; a higher rate fails.
        max_p99_ms: a higher value fails; None for no limit.
        raw: start and end code of the user's own ladder program; None for 4E.

    Raises:
        UsageError: a value out of its range.
    """

    count: int | None = DEFAULT_COUNT
    duration_s: float | None = None
    sizes: tuple[int, ...] = DEFAULT_SIZES
    patterns: tuple[Pattern, ...] = tuple(Pattern)
    interval_s: float = 0.0
    seed: int = 0
    max_error_rate: float = 0.0
    max_p99_ms: float | None = None
    raw: RawFrame | None = None

    def __post_init__(self) -> None:
        least, most = size_range(self.raw)
        wrong = [size for size in self.sizes if not least <= size <= most]
        if wrong or not self.sizes:
            got = ", ".join(map(str, wrong)) or "none"
            raise UsageError(f"loopback sizes: expected {least} to {most} characters, got {got}")
        if not self.patterns:
            raise UsageError("loopback: expected at least one pattern")


@dataclass(slots=True)
class Tally:
    """Exchanges counted: all of them, or those of one size.

    Attributes:
        sent: requests.
        ok: answers as they should be.
        errors: the others, by kind.
        latency: from the first byte out to the last byte in, of the good ones.
        turnaround: the same without the time on the wire.
    """

    sent: int = 0
    ok: int = 0
    errors: dict[str, int] = field(default_factory=lambda: dict.fromkeys(ERRORS, 0))
    latency: Times = field(default_factory=Times)
    turnaround: Times = field(default_factory=Times)

    @property
    def failed(self) -> int:
        """How many were no good."""
        return self.sent - self.ok

    @property
    def error_rate(self) -> float:
        """0 to 1; 0 if nothing was sent."""
        return self.failed / self.sent if self.sent else 0.0

    @property
    def error_rate_upper95(self) -> float:
        """The highest rate that agrees with what was seen, 95 % one-sided, exact."""
        return upper_bound(self.failed, self.sent)

    def count(self, error: str | None, latency_s: float, wire_s: float) -> None:
        """Count one exchange; ``error`` is None for a good one."""
        self.sent += 1
        if error is not None:
            self.errors[error] += 1
            return
        self.ok += 1
        self.latency.add(latency_s)
        self.turnaround.add(latency_s - wire_s)


@dataclass(slots=True)
class Heard:
    """What was received beside the answers, for the diagnosis.

    Attributes:
        twice: answers that were received a second time.
        late: answers that were received after the time-out of their exchange.
        late_s: how long the slowest of those took, without wire time; 0 if that is not known.
        foreign: valid frames of other stations, by station.
        noise_bytes: bytes that are no valid frame.
        noise: the first of them.
        faster_than_wire: answers that arrived faster than the line's baud rate allows.
        steps: whether answers arrive in the steps of a USB adapter.
    """

    twice: int = 0
    late: int = 0
    late_s: float = 0.0
    foreign: dict[int, int] = field(default_factory=dict)
    noise_bytes: int = 0
    noise: bytes = b""
    faster_than_wire: int = 0
    steps: Steps = field(default_factory=Steps)


@dataclass(slots=True)
class LoopbackResult:
    """The result of a test, or of the part of it that was done.

    Attributes:
        plan: what was asked for.
        timeout_s: the time-out of each answer, without wire time.
        total: all exchanges.
        by_size: those of each size.
        heard: what was received beside the answers.
        bytes_sent: of the requests.
        bytes_received: all bytes received.
        wire_s: time on the wire of what was sent and received, at the line's speed.
        duration_s: from the first request to the end.
        ended: ``count``, ``duration``, ``interrupted`` or ``line lost``.
        lost: why the line was lost, in words; None if it was not.
        echoes: True on a line that echoes what is sent; None if that is not known.
    """

    plan: LoopbackPlan
    timeout_s: float
    total: Tally = field(default_factory=Tally)
    by_size: dict[int, Tally] = field(default_factory=dict)
    heard: Heard = field(default_factory=Heard)
    bytes_sent: int = 0
    bytes_received: int = 0
    wire_s: float = 0.0
    duration_s: float = 0.0
    ended: str = "count"
    lost: str | None = None
    echoes: bool | None = None

    @property
    def paced(self) -> bool:
        """False if most answers arrived faster than the baud rate allows: there is no such line."""
        return self.heard.faster_than_wire * 2 <= self.total.ok

    @property
    def line_use(self) -> float | None:
        """Wire time divided by time; None without a line of this baud rate, or if no time has passed."""
        return self.wire_s / self.duration_s if self.paced and self.duration_s > 0 else None

    @property
    def turnaround(self) -> Times:
        """The PLC's time to answer: without wire time, if there is a line of this baud rate."""
        return self.total.turnaround if self.paced else self.total.latency

    @property
    def faults(self) -> list[str]:
        """The limits that were exceeded, in words; none for a line that passed the test."""
        total, plan = self.total, self.plan
        if not total.sent:
            return ["nothing was sent"]
        found = []
        if total.error_rate > plan.max_error_rate:
            found.append(f"error rate {total.error_rate:.3g}, allowed {plan.max_error_rate:g}")
        p99_ms = total.latency.summary_ms()["p99"]
        if plan.max_p99_ms is not None and (p99_ms is None or p99_ms > plan.max_p99_ms):
            got = "without an answer" if p99_ms is None else f"{p99_ms:g} ms"
            found.append(f"p99 {got}, allowed {plan.max_p99_ms:g} ms")
        return found
