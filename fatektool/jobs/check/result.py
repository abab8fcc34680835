"""The result of a check: facts with a state each, and the worst of them.

States are those of monitoring plugins (Monitoring Plugins Development Guidelines, section 2.3). UNKNOWN is
the weakest of the bad ones: what could not be checked must not hide what was found.
"""

from __future__ import annotations

from dataclasses import dataclass, field
from enum import IntEnum
from typing import TYPE_CHECKING, Final

from fatektool.errors import FatektoolError, LineError, PortBusy

if TYPE_CHECKING:
    from collections.abc import Iterable

    from fatektool.protocol.status import StatusFlags


class State(IntEnum):
    """The exit codes of a monitoring plugin."""

    OK = 0
    WARNING = 1
    CRITICAL = 2
    UNKNOWN = 3


_BY_WEIGHT: Final = (State.CRITICAL, State.WARNING, State.UNKNOWN, State.OK)


def worst(states: Iterable[State]) -> State:
    """The worst state; OK if there is none."""
    return min(states, key=_BY_WEIGHT.index, default=State.OK)


@dataclass(frozen=True, slots=True)
class Fact:
    """One thing that was checked."""

    state: State
    words: str


@dataclass(slots=True)
class CheckResult:
    """The facts of one check.

    Attributes:
        facts: in the order of the table in ``jobs/check/plc.py``.
        figures: performance data by label, as a plugin prints it: ``0.031s``, ``0``, ``1200s;129600``.
        flags: the PLC's status; None if it was not reached.
        differs: True if the program is not the reference; None if it was not compared.
    """

    facts: list[Fact] = field(default_factory=list)
    figures: dict[str, str] = field(default_factory=dict)
    flags: StatusFlags | None = None
    differs: bool | None = None

    @property
    def state(self) -> State:
        """The worst of all facts."""
        return worst(fact.state for fact in self.facts)

    @property
    def words(self) -> str:
        """All facts on one line, the worst first."""
        ordered = sorted(self.facts, key=lambda fact: _BY_WEIGHT.index(fact.state))
        return ", ".join(fact.words for fact in ordered)

    def add(self, bad: State | None, words: str) -> None:
        """Add a fact; ``bad`` is None for one that is OK."""
        self.facts.append(Fact(State.OK if bad is None else bad, words))

    def fail(self, error: FatektoolError) -> None:
        """Add the error that ended the check of the PLC."""
        dead = isinstance(error, LineError) and not isinstance(error, PortBusy)
        self.add(State.CRITICAL if dead else State.UNKNOWN, error.message)
