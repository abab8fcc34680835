"""A program as a part of a write that can be undone: the contents of the PLC are known page by page.

The PLC has to stay in STOP meanwhile. One that restarts may come back in RUN with half a program, so its mode
is read again after each page that took more than one exchange, and at the end.
"""

from __future__ import annotations

from typing import TYPE_CHECKING, Any, Final

from fatektool.errors import DataError, LineError, PlcError, PlcNotReady, PlcRefused
from fatektool.jobs.programs.reading import PAST_THE_END
from fatektool.program.image import ranges

if TYPE_CHECKING:
    from collections.abc import Sequence

    from fatektool.client import Plc
    from fatektool.jobs.progress import Progress
    from fatektool.program.archive import Backup
    from fatektool.program.image import Program

_OLD: Final = "the previous program"
_NEW: Final = "the new program"
_UNCERTAIN: Final = "uncertain"
_UNREAD: Final = "written but not read back"


class Rewrite:
    """One attempt to turn a PLC's program into another.

    Args:
        plc: the PLC.
        wanted: the program to write.
        present: the program that is in the PLC.
        pages: which are written, in order; the others are in the PLC already. None: nothing is read back.
        running: True if the PLC runs, and is to be stopped.

    Attributes:
        left: pages past the end of what the PLC takes, which it refused, and which it has as they are to be.
        running: True if the PLC is in RUN, as far as is known; None if it did not answer.
    """

    def __init__(
        self, plc: Plc, wanted: Program, present: Backup, pages: Sequence[int], *, running: bool
    ) -> None:
        self._plc = plc
        self._wanted = wanted
        self._present = present
        self._pages = pages
        self._may_stop = running
        self.running: bool | None = running
        self._holds = dict.fromkeys(pages, _OLD)
        self._unread: set[int] = set()  # acknowledged, which does not prove that it was written
        self._again: list[int] = []
        self._foreign: list[int] = []
        self._went_to_run = False
        self.left: list[int] = []

    @property
    def before(self) -> str:
        """What is said of a PLC that was not changed."""
        what = "program" if self._present.data is None else "program and data"
        mode = {True: "is in RUN", False: "is in STOP", None: "its mode is not known"}[self.running]
        return f"its previous {what} and {mode}"

    @property
    def mode(self) -> str:
        """What is said of the mode of a PLC whose program is incomplete."""
        return {
            True: "RUN: STOP it, its program is incomplete",
            False: "STOP: do not switch it to RUN",
            None: "not known: do not switch it to RUN; STOP it if it runs",
        }[self.running]

    @property
    def warnings(self) -> tuple[str, ...]:
        """What the user should know of a program that was verified in the end."""
        found = []
        if self._again:
            found.append(f"page {ranges(self._again)} was acknowledged but not stored, and was written again")
        if self._foreign:
            found[-1] += (
                f"; page {ranges(self._foreign)} held neither the previous nor the new program: was the PLC "
                f"replaced, or is somebody else loading a program? The safety backup may be of another one"
            )
        if self.left:
            found.append(f"the PLC refused page {ranges(self.left)}, which it has as on file already")
        if self._went_to_run:
            then = "it is in RUN now" if self.running else "it was stopped again"
            found.append(f"the PLC went to RUN while its program was written, as after a restart: {then}")
        return tuple(found)

    @property
    def untouched(self) -> bool:
        """True if the PLC is known to hold its previous program to the byte."""
        before, after = self._present.program.pages, self._wanted.pages
        return not self._in(_UNCERTAIN) and all(before[page] == after[page] for page in self._in(_NEW))

    def prepare(self) -> None:
        """Look once more before the first page (53), as a question may wait long; STOP the PLC if it runs.

        Raises:
            DataError: this is not the PLC of the plan.
            PlcError: it got a ROM pack, went to RUN, or does not stop.
            LineError: no answer.
        """
        status = self._plc.detailed_status()
        before, now = self._present.plc["system"], status.system.document()
        if now != before:
            changed = ", ".join(
                f"{name} {before[name]}, now {now[name]}" for name in now if now[name] != before[name]
            )
            raise DataError(
                f"this is not the PLC whose program was read ({changed})",
                hint="check whether the PLC was replaced, then run the restore again",
            )
        self.running = status.flags.running
        if status.flags.rom_pack or (self.running and not self._may_stop):
            what = "got a ROM pack" if status.flags.rom_pack else "went to RUN"
            raise PlcNotReady(
                f"the PLC {what} since its program was read",
                hint="check whether the PLC was replaced, then run the restore again",
            )
        if self._may_stop:
            self._stop()

    def _stop(self) -> None:
        """STOP the PLC; an end on the way says that the machine may have stopped."""
        doubt = "it is not known whether the PLC is in RUN or in STOP"
        try:
            self._plc.stop()
        except LineError as error:
            error.message = f"{error.message}: {doubt}"
            raise
        except KeyboardInterrupt:
            raise KeyboardInterrupt(doubt) from None
        self.running = False

    def write(self, progress: Progress) -> None:
        """Write the pages in order, read the whole program back and compare.

        A page that reads back wrong is written once more: an acknowledged write that was not made.

        Raises:
            PlcError: the PLC refused a page, has other data now, or went to RUN and may not be stopped.
            LineError: no answer.
        """
        if not self._pages:
            return
        self._write(self._wanted, self._pages, _NEW, "writing", progress)
        self._prove(self._wanted, _NEW, progress)

    def put_back(self, progress: Progress) -> None:
        """Write the previous program back, read all of it back and compare; the errors of ``write``."""
        if not self._pages:
            return
        previous = self._present.program
        self._write(previous, self._in(_NEW, _UNCERTAIN), _OLD, "rolling back", progress)
        self._prove(previous, _OLD, progress)

    def look(self) -> None:
        """Ask for the mode, then for the pages that may be written or not.

        Raises:
            PlcError: the PLC refuses.
            LineError: no answer; what was not asked stays as it was.
        """
        self.running = None
        self.running = self._plc.brief_status().flags.running
        uncertain = self._in(_UNCERTAIN)
        found = self._plc.read_pages(uncertain)
        self._holds |= {
            number: self._whose(number, page) for number, page in zip(uncertain, found, strict=True)
        }

    def states(self) -> list[tuple[str, str]]:
        """What the PLC has, by page."""
        pages = {state: self._in(state) for state in (_NEW, _OLD, _UNCERTAIN)}
        unread = self._acknowledged_only
        found = {state: [page for page in those if page not in unread] for state, those in pages.items()}
        found[_UNREAD] = unread
        order = (_NEW, _UNREAD, _UNCERTAIN, _OLD)
        return [(f"page {ranges(found[state])}", state) for state in order if found[state]]

    def details(self) -> dict[str, Any]:
        """The same for scripts; pages that were not read back are among those written."""
        return {
            "pages_written": self._in(_NEW),
            "pages_uncertain": self._in(_UNCERTAIN),
            "pages_old": self._in(_OLD),
            "pages_unread": self._acknowledged_only,
            "mode": {True: "run", False: "stop", None: None}[self.running],
        }

    @property
    def _acknowledged_only(self) -> list[int]:
        return [page for page in self._in(_NEW, _OLD) if page in self._unread]

    def _in(self, *states: str) -> list[int]:
        return [page for page, state in sorted(self._holds.items()) if state in states]

    def _write(
        self, program: Program, pages: Sequence[int], state: str, phase: str, progress: Progress
    ) -> None:
        total = len(pages)
        done, before = 0, _OLD
        counters = self._plc.link.counters
        sent = 0
        refused_at = -1

        def begin() -> None:
            """The next page may be on its way from now on."""
            nonlocal before
            if done < total:
                before = self._holds.get(pages[done], _OLD)
                self._holds[pages[done]] = _UNCERTAIN

        def taken(_: int) -> None:
            nonlocal done, sent
            self._holds[pages[done]] = state
            self._unread.add(pages[done])
            done += 1
            if counters.exchanges > sent + 1:
                self._keep_stopped()
            sent = counters.exchanges
            progress(phase, done, total)
            begin()

        progress(phase, 0, total)
        while done < total:
            sent = counters.exchanges
            begin()
            try:
                self._plc.write_pages([(number, program.pages[number]) for number in pages[done:]], taken)
            except PlcRefused as refusal:
                page = pages[done]
                self._holds[page] = before
                if refused_at != done and self._keep_stopped():
                    refused_at = done
                elif (
                    refusal.code in PAST_THE_END and self._present.program.pages[page] == program.pages[page]
                ):
                    self._holds[page] = state  # read back like all others
                    self.left.append(page)
                    done += 1
                else:
                    raise

    def _prove(self, program: Program, state: str, progress: Progress) -> None:
        wrong = self._read_back(program, range(len(program.pages)), "reading back", progress)
        if wrong:
            self._again = wrong
            self._foreign = self._in(_UNCERTAIN)
            self._write(program, wrong, state, "writing again", progress)
            wrong = self._read_back(program, wrong, "reading back again", progress)
        if wrong:
            raise PlcError(
                f"the PLC acknowledged page {ranges(wrong)}, but has other data there",
                hint="the PLC's program memory may be worn out or protected",
            )
        status = self._plc.detailed_status()
        words = status.system.ladder_words
        if words != program.ladder_words:
            raise PlcError(
                f"the PLC's ladder size is {words} words now, and was {program.ladder_words} before",
                hint="check whether the PLC was replaced: see 'fatektool status'",
            )
        self._note_mode(running=status.flags.running)

    def _keep_stopped(self) -> bool:
        """Read the mode, and STOP a PLC again that went to RUN by itself.

        Returns:
            True if it was in RUN.

        Raises:
            PlcNotReady: it is in RUN, and it was not agreed that it is stopped.
            PlcError: it does not stop.
            LineError: no answer.
        """
        if not self._note_mode(running=self._plc.brief_status().flags.running):
            return False
        if self.running:
            raise PlcNotReady("the PLC went to RUN while its program was written")
        return True

    def _note_mode(self, *, running: bool) -> bool:
        """The same, with the mode that was read; a PLC that must not be stopped stays in RUN."""
        self.running = running
        if running:
            self._went_to_run = True
            if self._may_stop:
                self._stop()
        return running

    def _read_back(self, program: Program, pages: Sequence[int], phase: str, progress: Progress) -> list[int]:
        total = len(pages)
        progress(phase, 0, total)
        found = self._plc.read_pages(pages, lambda done: progress(phase, done, total))
        self._unread.difference_update(pages)
        wrong = {
            number: page for number, page in zip(pages, found, strict=True) if page != program.pages[number]
        }
        self._holds |= {number: self._whose(number, page) for number, page in wrong.items()}
        return list(wrong)

    def _whose(self, number: int, page: bytes) -> str:
        if page == self._wanted.pages[number]:
            return _NEW
        return _OLD if page == self._present.program.pages[number] else _UNCERTAIN
