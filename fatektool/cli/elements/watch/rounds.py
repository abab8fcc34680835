"""What each round reads, kept for a report if there is to be one."""

from __future__ import annotations

from typing import TYPE_CHECKING

from fatektool.files.times import utc
from fatektool.jobs.snapshots.snapshot import Snapshot, take_snapshot

if TYPE_CHECKING:
    from collections.abc import Sequence

    from fatektool.client import Plc
    from fatektool.errors import LineError
    from fatektool.jobs.snapshots.spec import SpecItem
    from fatektool.report.rounds import Rounds


class SnapshotRounds:
    """Reads rounds.

    Args:
        plc: the PLC.
        items: what to read.
        kept: gets the rounds, for a report; None for none.
    """

    def __init__(self, plc: Plc, items: Sequence[SpecItem], kept: Rounds | None) -> None:
        self._plc, self.items, self._kept = plc, items, kept

    def read(self) -> Snapshot:
        """One round.

        Raises:
            LineError: no answer.
        """
        snapshot = take_snapshot(self._plc, self.items)
        if self._kept is not None:
            self._kept.add(snapshot.document())
        return snapshot

    def fail(self, error: LineError) -> None:
        """A round that failed."""
        if self._kept is not None:
            self._kept.fail(utc(), error.message)
