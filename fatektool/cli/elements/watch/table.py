"""The values of a round as a table, as many rows as fit."""

from __future__ import annotations

from collections import deque
from typing import TYPE_CHECKING, Any, Final

from fatektool.cli.elements.values import shown
from fatektool.cli.shared.bars import levels

if TYPE_CHECKING:
    from collections.abc import Mapping, Sequence

    from fatektool.jobs.snapshots.snapshot import Snapshot
    from fatektool.protocol.values import Value

_TREND: Final = 24
_VALUE: Final = 7
_GAPS: Final = 4


class WatchTable:
    """The table, with what it remembers of the rounds before.

    Args:
        keys: of the elements.
        comments: of the elements, by key.
    """

    def __init__(self, keys: Sequence[str], comments: Mapping[str, str]) -> None:
        self._comments = comments
        self._bars = levels()  # what is drawn live hides the terminal's encoding
        self._trends: dict[str, deque[float]] = {key: deque(maxlen=_TREND) for key in keys}
        self._before: dict[str, Value | None] = {}
        self._changed: set[str] = set()

    def take(self, snapshot: Snapshot) -> None:
        """The values of a round."""
        self._changed = {
            key
            for key, value in snapshot.values.items()
            if key in self._before and self._before[key] != value
        }
        self._before = snapshot.values
        for value, trended in zip(snapshot.values.values(), self._trends.values(), strict=True):
            if isinstance(value, int | float):
                trended.append(float(value))

    def rows(self, snapshot: Snapshot, columns: int, rows: range, *, is_known: bool) -> Any:
        """A table for rich.

        Args:
            snapshot: the last round.
            columns: of the terminal.
            rows: which of the elements.
            is_known: False to show ``?`` for all values.
        """
        from rich.table import Table
        from rich.text import Text

        comments = self._comments
        names = max(7, min(max(map(len, snapshot.values), default=0), columns // 3))
        with_units = any("unit" in part for part in snapshot.elements.values())
        table = Table(box=None, padding=(0, 1, 0, 0))
        table.add_column("element", no_wrap=True, min_width=names, max_width=names)
        table.add_column("value ", justify="right", no_wrap=True, min_width=_VALUE)
        if with_units:
            table.add_column("unit", no_wrap=True)
        if comments:
            table.add_column("comment", no_wrap=True)
        table.add_column("trend", no_wrap=True)
        units = (
            max(4, *(len(str(part.get("unit", ""))) for part in snapshot.elements.values()))
            if with_units
            else 0
        )
        values = max(_VALUE, *(len(shown(value)) + 1 for value in snapshot.values.values()))
        widest = max(map(len, comments.values()), default=0)
        remarks = min(max(_VALUE, widest), columns // 4) if comments else 0
        fits = max(1, columns - names - values - units - remarks - _GAPS - bool(comments))
        for key in list(snapshot.values)[rows.start : rows.stop]:
            text = Text(shown(snapshot.values[key]) if is_known else "?")
            if is_known and key in self._changed:
                text = Text.assemble((text.plain, "bold reverse"), "*")
            else:
                text.append(" ")
            unit = [Text(str(snapshot.elements[key].get("unit", "")))] if with_units else []
            last = (
                snapshot.errors[key]
                if key in snapshot.errors
                else trend(self._trends[key], self._bars)[-fits:]
            )
            remark = [Text(comments.get(key, "")[:remarks])] if comments else []
            table.add_row(Text(key), text, *unit, *remark, Text(last))
        return table


def trend(values: deque[float], bars: str) -> str:
    """A small chart of numbers, the lowest at the bottom, of eight characters."""
    if not values:
        return ""
    least, most = min(values), max(values)
    span = most / 2 - least / 2  # halves: the whole may be past the largest number
    if not span:
        return bars[0] * len(values)
    return "".join(bars[round((value / 2 - least / 2) / span * (len(bars) - 1))] for value in values)
