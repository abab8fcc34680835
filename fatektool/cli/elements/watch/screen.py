"""``watch`` on a terminal: a table that changes; keys move it, pause it, write a value and end it."""

from __future__ import annotations

from collections import deque
from typing import TYPE_CHECKING, Any, Final

from fatektool.cli.elements.values import shown
from fatektool.cli.elements.watch.table import WatchTable
from fatektool.cli.elements.watch.view import WatchView
from fatektool.cli.shared.keys import terminal_keys
from fatektool.cli.shared.output import Held
from fatektool.cli.shared.reading import Reading, lost_words
from fatektool.errors import FatektoolError
from fatektool.files.times import local_clock
from fatektool.jobs.elements.assignment import write_assignments
from fatektool.jobs.elements.items import value_of

if TYPE_CHECKING:
    from collections.abc import Callable, Mapping

    from fatektool.cli.elements.watch.rounds import SnapshotRounds
    from fatektool.cli.shared.rounds import RoundTimes
    from fatektool.client import Plc
    from fatektool.jobs.elements.selection import Item
    from fatektool.jobs.snapshots.snapshot import Snapshot

_AROUND: Final = 4
"""Title, header, the last line, and the line of the cursor."""
_READ_ONLY: Final = "this line is read-only: nothing can be written; see --read-only"


class WatchScreen:
    """The screen, the keys, and the rounds.

    Args:
        plc: the PLC.
        rounds: what is read.
        comments: of the elements, by key.
        pace: how often a round is read, and how many.
    """

    def __init__(
        self, plc: Plc, rounds: SnapshotRounds, comments: Mapping[str, str], pace: RoundTimes
    ) -> None:
        self._plc, self._rounds, self._pace = plc, rounds, pace
        keys = [item.item.key for item in rounds.items]
        self._table = WatchTable(keys, comments)
        name = f"station {plc.link.station} on {plc.target}"
        refusal = _READ_ONLY if plc.link.state.read_only else ""
        self._view = WatchView(len(keys), name, self._write, refusal)
        self._new: deque[Snapshot] = deque()
        self._reading: Reading[Snapshot] | None = None

    def run(self) -> bool:
        """Show it all until ``q``, Ctrl-C or the last round; True if an element of that had no value.

        Raises:
            LineError: the first round found no answer.
        """
        from rich.live import Live

        with Held() as held, Live(auto_refresh=False, vertical_overflow="crop") as live:

            def show(*, is_last: bool = False) -> None:
                live.update(self._drawn(live.console.size, is_last=is_last), refresh=True)

            def down() -> Callable[[], object]:
                live.stop()
                return lambda: live.start(refresh=True)

            with terminal_keys(down) as keys:
                held.on_news = keys.wake
                self._reading = reading = Reading(
                    self._plc, self._read, self._pace, keys.wake, failed=self._rounds.fail
                )
                try:
                    with reading:
                        while not (self._view.is_over or reading.is_over):
                            for key in keys.read():
                                self._press(key, reading)
                            self._view.message = held.over(self._view.message, reading.last)
                            show()
                finally:
                    show(is_last=True)
                if reading.error is not None:
                    raise reading.error
        return not self._view.is_over and reading.last is not None and bool(reading.last.errors)

    def _read(self) -> Snapshot:
        snapshot = self._rounds.read()
        self._new.append(snapshot)
        return snapshot

    def _press(self, key: str, reading: Reading[Snapshot]) -> None:
        was_paused = self._view.is_paused
        self._view.press(key)
        if self._view.is_paused != was_paused:
            reading.pause(on=self._view.is_paused)

    def _write(self, text: str, pairs: list[tuple[Item, int]]) -> None:
        """Have it written in the thread that has the line."""
        assert self._reading is not None  # noqa: S101  # keys are read by its side

        def job() -> None:
            try:
                failed = write_assignments(self._plc, pairs)
            except FatektoolError as error:
                self._view.message = f"{text}: {error.message}"
                return
            items = {item.element: item for item, _ in pairs}
            said = [
                f"{items[each.element].key}: "
                + each.words(lambda raw, item=items[each.element]: shown(value_of(item, raw)))  # type: ignore[misc]
                for each in failed
            ]
            self._view.message = "; ".join(said) or f"{text}: written and read back"

        self._reading.do(job)

    def _drawn(self, size: tuple[int, int], *, is_last: bool) -> Any:
        """What is on the terminal.

        Args:
            size: its columns and lines.
            is_last: no key is read any more: without the line of keys.
        """
        from rich.console import Group
        from rich.text import Text

        columns, lines = size
        reading, view = self._reading, self._view
        snapshot = None if reading is None else reading.last
        if reading is None or snapshot is None:
            return Text("")
        while self._new:
            self._table.take(self._new.popleft())
        lost = lost_words(reading)
        rows = view.fit(lines - _AROUND - bool(lost))
        mode = {True: "RUN", False: "STOP", None: "mode unknown"}[snapshot.running]
        title = [view.name] if lost else [local_clock(snapshot.time), mode, view.name]
        if view.is_paused:
            title.append("PAUSED")

        def line(text: str) -> Text:
            return Text(text, no_wrap=True, overflow="ellipsis")

        parts: list[Any] = [line("  ".join(title))]
        if lost:
            parts.append(line(lost))
        parts.append(self._table.rows(snapshot, columns, rows, is_known=not lost))
        more = len(snapshot.values) - rows.stop
        if not is_last:
            parts.append(line(view.foot))
        elif more:
            parts.append(line(f"and {more} more"))
        return Group(*parts)
