"""Times that come in steps of 16 ms: a USB adapter that delays received bytes causes them.

Such an adapter passes on received bytes when a timer of 16 ms ends. Then the answer to a request of 10 bytes
and that to one of 100 take whole numbers of steps, whatever their time on the wire. As angles of a circle of
16 ms the times all point one way, while the wire times point everywhere. Sums of sine and cosine tell that,
however many times there are (mean resultant length; Mardia and Jupp, Directional Statistics, section 2.3).
"""

from __future__ import annotations

from dataclasses import dataclass, field
from math import cos, hypot, inf, sin, tau
from typing import Final

STEP_S: Final = 0.016
_ENOUGH: Final = 20
_ALIGNED: Final = 0.9
_SPREAD: Final = 0.6


@dataclass(slots=True)
class Angles:
    """Times as angles of a circle of one step."""

    count: int = 0
    cosines: float = 0.0
    sines: float = 0.0

    def add(self, time_s: float) -> None:
        """Count one time."""
        angle = time_s / STEP_S * tau
        self.count += 1
        self.cosines += cos(angle)
        self.sines += sin(angle)

    @property
    def alignment(self) -> float:
        """0 for times spread over the step, 1 for times that differ by whole steps."""
        return hypot(self.cosines, self.sines) / self.count if self.count else 0.0


@dataclass(slots=True)
class Steps:
    """Whether times come in steps."""

    latency: Angles = field(default_factory=Angles)
    wire: Angles = field(default_factory=Angles)
    least_s: float = inf
    most_s: float = 0.0

    def add(self, latency_s: float, wire_s: float) -> None:
        """Count one exchange: how long it took, and how long its bytes are on the wire."""
        self.latency.add(latency_s)
        self.wire.add(wire_s)
        self.least_s = min(self.least_s, latency_s)
        self.most_s = max(self.most_s, latency_s)

    @property
    def seen(self) -> bool:
        """True if the times come in steps and the wire times do not, over more than one step."""
        return (
            self.latency.count >= _ENOUGH
            and self.least_s > STEP_S / 2
            and self.most_s - self.least_s > STEP_S / 2
            and self.latency.alignment > _ALIGNED
            and self.wire.alignment < _SPREAD
        )
