"""What an examination finds, and what it is found by."""

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
        fault: False for what is worth knowing and no fault.
        finding: what it is.
        evidence: the figures that say so.
        advice: what to do.
    """

    rule: str
    fault: bool
    finding: str
    evidence: str
    advice: str


@dataclass(frozen=True, slots=True)
class Case:
    """What the rules look at: a test's figures, and the line it was run on."""

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
