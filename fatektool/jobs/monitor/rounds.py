"""The same elements read round after round: planned once, in the fewest bytes.

An element that the PLC refuses, or that its protocol cannot name, is left out of all later rounds; its reason
is kept. A round takes several requests, and the PLC scans its program between them: two elements may be of
different scans.
"""

from __future__ import annotations

from dataclasses import dataclass
from typing import TYPE_CHECKING, Any

from fatektool.errors import UsageError
from fatektool.exchange.batch import read_until_refused
from fatektool.files.times import utc
from fatektool.jobs.elements.reads import read_elements, turnaround
from fatektool.jobs.status import brief_or_none
from fatektool.planner import Values, plan_reads
from fatektool.protocol.elements import Element

if TYPE_CHECKING:
    from collections.abc import Iterable, Sequence

    from fatektool.client import Plc
    from fatektool.protocol.commands import Request


@dataclass(frozen=True, slots=True)
class Round:
    """What one round has read.

    Attributes:
        time: when it began, UTC, RFC 3339.
        running: True in RUN; None if the protocol does not tell.
        values: raw and unsigned, by element.
        errors: of each element without a value, why.
        duration_s: how long it took, on the clock of the line.
    """

    time: str
    running: bool | None
    values: dict[str, int]
    errors: dict[str, str]
    duration_s: float


class ElementRounds:
    """Reads elements round after round.

    Args:
        plc: the PLC.
    """

    def __init__(self, plc: Plc) -> None:
        self._plc = plc
        self._elements: dict[str, Element] = {}
        self._errors: dict[str, str] = {}
        self._plan: Sequence[Request[Any]] | None = None
        self._refuses_the_plan = False

    def choose(self, names: Iterable[str]) -> None:
        """Read these from the next round on; what was refused before stays refused."""
        chosen = {}
        for name in dict.fromkeys(names):
            if name in self._errors:
                continue
            try:
                chosen[name] = Element.parse(name)
                plan_reads([chosen[name]], self._plc.link.codec)
            except UsageError as error:  # no element of this protocol
                chosen.pop(name, None)
                self._errors[name] = error.message
        if chosen != self._elements:
            self._elements, self._plan, self._refuses_the_plan = chosen, None, False

    def read(self) -> Round:
        """One round.

        Raises:
            LineError: no answer.
        """
        clock = self._plc.link.transport.clock
        time, began = utc(), clock()
        status = brief_or_none(self._plc)
        values = self._planned()
        if values is None:
            values = self._divided()
        running = None if status is None else status.flags.running
        return Round(time, running, values, dict(self._errors), clock() - began)

    def _planned(self) -> dict[str, int] | None:
        """The values by the plan; None if there is none, or the PLC refuses one of its requests."""
        if self._plan is None:
            return None
        known = Values()
        answers, refusal = read_until_refused(self._plc.link, self._plan)
        if refusal is not None:
            self._plan, self._refuses_the_plan = None, True
            return None
        for request, answer in zip(self._plan, answers, strict=True):
            known.take(request, answer)
        return {name: known.value(element) for name, element in self._elements.items()}

    def _divided(self) -> dict[str, int]:
        """The values, and what is refused; then a plan of what is not."""
        reading = read_elements(self._plc, self._elements.values())
        for name, element in list(self._elements.items()):
            if element in reading.errors:
                self._errors[name] = reading.errors[element]
                del self._elements[name]
        if not self._refuses_the_plan:
            codec = self._plc.link.codec
            self._plan = plan_reads(self._elements.values(), codec, turnaround=turnaround(self._plc))
        return {name: reading.values[element] for name, element in self._elements.items()}
