"""A finding of the diagnosis, and what the rules look at."""

from __future__ import annotations

from dataclasses import dataclass
from typing import TYPE_CHECKING

from fatektool.exchange.no_answer import over_network

if TYPE_CHECKING:
    from fatektool.exchange.link import Link
    from fatektool.jobs.linetest.loopback.result import LoopbackResult
    from fatektool.protocol.codec import Codec
    from fatektool.transport.base import LineSettings


@dataclass(frozen=True, slots=True)
class Finding:
    """What a rule found.

    Attributes:
        rule: its name, for scripts.
        fault: True for a fault, False for a note.
        finding: what it is.
        evidence: the figures that show it.
        advice: what to do.
    """

    rule: str
    fault: bool
    finding: str
    evidence: str
    advice: str


@dataclass(frozen=True, slots=True)
class Case:
    """What the rules look at: the figures of a test, and its line."""

    result: LoopbackResult
    line: LineSettings
    station: int
    codec: Codec
    network: bool = False

    @classmethod
    def of(cls, result: LoopbackResult, link: Link) -> Case:
        """The case of a test over this link."""
        return cls(result, link.line, link.station, link.codec, over_network(link.transport))

    @property
    def silent(self) -> bool:
        """True if no answer was good."""
        return self.result.total.ok == 0 and self.result.total.sent > 0
