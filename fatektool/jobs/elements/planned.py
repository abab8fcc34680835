"""Values of elements as a part of a write that can be undone.

A value that does not take is named with its reason, and the others are written: it may be read-only, or the
PLC's program writes it too. So it is not written again, as a program's page is.
"""

from __future__ import annotations

from dataclasses import dataclass
from typing import TYPE_CHECKING, Any, Final

from fatektool.errors import DataError, PlcError, PlcNotReady
from fatektool.jobs.elements.ledger import Fate, Ledger
from fatektool.jobs.elements.reads import named
from fatektool.jobs.elements.spans import spans_of
from fatektool.jobs.elements.writes import NotTaken, write_elements
from fatektool.jobs.status import brief_or_none

if TYPE_CHECKING:
    from collections.abc import Sequence

    from fatektool.client import Plc
    from fatektool.jobs.progress import Progress
    from fatektool.protocol.elements import Element
    from fatektool.protocol.status import BriefStatus

_STATES: Final = {
    Fate.ACKNOWLEDGED: ("values_written", "written but not read back"),
    Fate.UNCERTAIN: ("values_uncertain", "uncertain"),
    Fate.BEFORE: ("values_old", "the previous value"),
}


@dataclass(frozen=True, slots=True)
class RegisterChange:
    """An element that will be written: its value and its new value; raw, unsigned."""

    element: Element
    before: int
    after: int


class PlannedValues:
    """The values of one write.

    Args:
        plc: the PLC.
        changes: what is written; no discrete or register twice.
        status: the PLC's (40) when its values were read; None where there is none.

    Attributes:
        not_taken: what did not take, when it is written and read back.
    """

    before: Final = "its previous values"
    mode: Final = ""

    def __init__(self, plc: Plc, changes: Sequence[RegisterChange], status: BriefStatus | None) -> None:
        self._plc = plc
        self._changes = changes
        self._status = status
        self._ledger = Ledger()
        self._undone = Ledger()
        self._read_back = False
        self._doubtful: set[Element] = set()
        self.not_taken: list[NotTaken] = []

    @property
    def untouched(self) -> bool:
        """True if no value was written."""
        return all(self._fate_of(change.element) is Fate.BEFORE for change in self._changes)

    def prepare(self) -> None:
        """Check model and mode once more (40), where both are known.

        Raises:
            DataError: another model answers.
            PlcNotReady: it went to RUN.
            LineError: no answer.
        """
        before = self._status
        now = None if before is None else brief_or_none(self._plc)
        if before is None or now is None:
            return
        if now.status2 != before.status2:
            raise DataError(
                f"this is not the PLC whose values were read (model code {before.status2:02X}, now "
                f"{now.status2:02X})",
                hint="was it exchanged meanwhile? run the same command again",
            )
        if now.flags.running and not before.flags.running:
            raise PlcNotReady(
                "the PLC went to RUN since its values were read",
                hint="run the same command again",
            )

    def write(self, progress: Progress) -> None:
        """Write what differs and read it back; ``not_taken`` names what did not take.

        Raises:
            LineError: no answer.
            PlcBusy: the PLC stays busy.
        """
        total = len(self._changes)
        progress("writing", 0, total)
        items = [(change.element, change.after) for change in self._changes]
        self.not_taken = write_elements(self._plc, items, self._ledger)
        self._doubtful = {each.element for each in self.not_taken}
        self._read_back = True
        progress("writing", total, total)

    def put_back(self, progress: Progress) -> None:
        """Write back all values that may not be the previous ones, and read them back.

        Raises:
            PlcError: one of them does not take its previous value.
            LineError: no answer.
        """
        items = [
            (change.element, change.before)
            for change in self._changes
            if self._fate_of(change.element) is not Fate.BEFORE
        ]
        progress("rolling back", 0, len(items))
        failed = write_elements(self._plc, items, self._undone)
        progress("rolling back", len(items), len(items))
        if failed:
            names = named(str(each.element) for each in failed)
            raise PlcError(f"{names} did not take the previous value: {failed[0].reason}")

    def look(self) -> None:
        """Nothing is asked: a value that is uncertain is written again."""

    def states(self) -> list[tuple[str, str]]:
        """What the PLC holds of each value, in ranges."""
        words = {fate: holds for fate, (_, holds) in _STATES.items()}
        if self._read_back:
            words[Fate.ACKNOWLEDGED] = "the new value"
        return [(named(spans), holds) for fate, holds in words.items() if (spans := self._spans(fate))]

    def details(self) -> dict[str, Any]:
        """The same for scripts."""
        return {key: self._spans(fate) for fate, (key, _) in _STATES.items()}

    def _spans(self, fate: Fate) -> list[str]:
        elements = (change.element for change in self._changes)
        return spans_of(element for element in elements if self._fate_of(element) is fate)

    def _fate_of(self, element: Element) -> Fate:
        """What is known of a value: nothing of one that did not take, or was being written back."""
        if element in self._doubtful or self._undone.fate_of(element) is not Fate.BEFORE:
            return Fate.UNCERTAIN
        return self._ledger.fate_of(element)
