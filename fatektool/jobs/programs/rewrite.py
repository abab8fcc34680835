"""Writing pages into a PLC, reading all back, and saying exactly what it holds if that fails."""

from __future__ import annotations

from typing import TYPE_CHECKING, Final

from fatektool.errors import FatektoolError, LineError, PlcError, PlcRefused, RestoreIncomplete
from fatektool.program.image import ranges

if TYPE_CHECKING:
    from collections.abc import Sequence

    from fatektool.client import Plc
    from fatektool.jobs.progress import Progress
    from fatektool.program.image import Program

_OLD: Final = "old"
_NEW: Final = "new"
_UNCERTAIN: Final = "uncertain"


class Rewrite:
    """One attempt to turn a PLC's program into another.

    Args:
        plc: the PLC, in STOP.
        wanted: the program to write.
        present: the program that is in it.
        safety_backup: where ``present`` lies, for messages.
        progress: told of each page.
    """

    def __init__(
        self, plc: Plc, wanted: Program, present: Program, safety_backup: str | None, progress: Progress
    ) -> None:
        self._plc = plc
        self._wanted = wanted
        self._present = present
        self._safety_backup = safety_backup
        self._progress = progress
        self._holds: dict[int, str] = {}
        self._unread: set[int] = set()  # acknowledged, which is not yet a proof
        self._again: list[int] = []
        self._foreign: list[int] = []

    @property
    def warnings(self) -> tuple[str, ...]:
        """What the user should know of a program that was proven in the end."""
        if not self._again:
            return ()
        told = f"page {ranges(self._again)} was acknowledged, not taken, and written again"
        if self._foreign:
            told += (
                f"; page {ranges(self._foreign)} held neither the old nor the new program: was the PLC "
                f"exchanged, or is somebody else loading a program? The safety backup may be of another"
            )
        return (told,)

    def write(self, pages: Sequence[int], *, rollback: bool = False) -> None:
        """Write pages in order, read the whole program back and compare.

        A page that reads back wrong is written once more: an acknowledged write that was not made.

        Args:
            pages: which, in order; the others are in the PLC already.
            rollback: put ``present`` back if this fails for good.

        Raises:
            RestoreIncomplete: the PLC's program is neither old nor new.
            PlcError: nothing was changed, or it was rolled back.
            LineError: it was rolled back.
        """
        self._holds = dict.fromkeys(pages, _OLD)
        try:
            self._write(self._wanted, pages, _NEW, "writing")
            self._prove(self._wanted, _NEW)
        except KeyboardInterrupt:
            raise self._incomplete("interrupted") from None
        except Exception as error:
            # Whatever it is, a trace that cannot be written among it: where the PLC stands must be said.
            if isinstance(error, PlcError) and self._unchanged():
                raise self._untouched(error) from error
            cause = _cause(error)
            if rollback:
                cause = f"{cause}; and rolling back failed: {self._roll_back(error)}"
            raise self._incomplete(cause) from error

    def _pages(self, *states: str) -> list[int]:
        return [number for number, state in sorted(self._holds.items()) if state in states]

    def _unchanged(self) -> bool:
        """True if the PLC is known to hold its old program to the byte."""
        before, after = self._present.pages, self._wanted.pages
        return not self._pages(_UNCERTAIN) and all(before[page] == after[page] for page in self._pages(_NEW))

    def _write(self, program: Program, pages: Sequence[int], state: str, phase: str) -> None:
        total = len(pages)
        done, before = 0, _OLD

        def begin() -> None:
            """The next page may be on its way from now on."""
            nonlocal before
            if done < total:
                before = self._holds.get(pages[done], _OLD)
                self._holds[pages[done]] = _UNCERTAIN

        def taken(acknowledged: int) -> None:
            nonlocal done
            self._holds[pages[done]] = state
            self._unread.add(pages[done])
            done = acknowledged
            self._progress(phase, done, total)
            begin()

        self._progress(phase, 0, total)
        begin()
        try:
            self._plc.write_pages([(number, program.pages[number]) for number in pages], taken)
        except PlcRefused:
            self._holds[pages[done]] = before
            raise

    def _prove(self, program: Program, state: str) -> None:
        wrong = self._read_back(program, range(len(program.pages)), "reading back")
        if wrong:
            self._again = wrong
            self._foreign = self._pages(_UNCERTAIN)
            self._write(program, wrong, state, "writing again")
            wrong = self._read_back(program, wrong, "reading back again")
        if wrong:
            raise PlcError(
                f"the PLC acknowledged page {ranges(wrong)}, but holds something else there",
                hint="the PLC's program memory may be worn out or protected",
            )
        words = self._plc.detailed_status().system.ladder_words
        if words != program.ladder_words:
            raise PlcError(
                f"the PLC's ladder size is {words} words now, and was {program.ladder_words} before",
                hint="was it exchanged meanwhile? see 'fatektool status'",
            )

    def _read_back(self, program: Program, pages: Sequence[int], phase: str) -> list[int]:
        total = len(pages)
        self._progress(phase, 0, total)
        found = self._plc.read_pages(pages, lambda done: self._progress(phase, done, total))
        self._unread.difference_update(pages)
        wrong = {
            number: page for number, page in zip(pages, found, strict=True) if page != program.pages[number]
        }
        self._holds |= {number: self._whose(number, page) for number, page in wrong.items()}
        return list(wrong)

    def _whose(self, number: int, page: bytes) -> str:
        if page == self._wanted.pages[number]:
            return _NEW
        return _OLD if page == self._present.pages[number] else _UNCERTAIN

    def _roll_back(self, cause: Exception) -> str:
        """Put the old program back and raise the cause; or tell why that failed too."""
        try:
            self._write(self._present, self._pages(_NEW, _UNCERTAIN), _OLD, "rolling back")
            self._prove(self._present, _OLD)
        except KeyboardInterrupt:
            return "interrupted"
        except Exception as error:  # noqa: BLE001  # it is told, whatever it is
            return _cause(error)
        kind = LineError if isinstance(cause, LineError) else PlcError
        raise kind(
            f"{_cause(cause)}; rolled back: the PLC holds its old program again, read back and proven, "
            f"and is in STOP",
            hint=getattr(cause, "hint", None),
            rolled_back=True,
            safety_backup=self._safety_backup,
        ) from cause

    def _untouched(self, error: PlcError) -> PlcError:
        return PlcError(
            f"{error.message}; nothing was changed: the PLC holds its old program and is in STOP",
            hint=error.hint,
            **error.details,
        )

    def _incomplete(self, cause: str) -> RestoreIncomplete:
        states = {_NEW: "holds the new program", _UNCERTAIN: "is uncertain", _OLD: "holds the old program"}
        unread = [number for number in self._pages(_NEW, _OLD) if number in self._unread]
        said = {words: self._pages(state) for state, words in states.items()}
        said = {words: [number for number in pages if number not in unread] for words, pages in said.items()}
        said["was written and not read back"] = unread
        parts = [f"page {ranges(pages)} {words}" for words, pages in said.items() if pages]
        way_back = (
            f"the old program lies in {self._safety_backup}"
            if self._safety_backup
            else "there is no safety backup"
        )
        return RestoreIncomplete(
            f"the restore did not complete ({cause}): {', '.join(parts)}; {way_back}; "
            f"the PLC is in STOP and must not RUN",
            hint="mend the cause and run the same restore again: it goes on where it stands",
            cause=cause,
            pages_written=self._pages(_NEW),
            pages_uncertain=self._pages(_UNCERTAIN),
            pages_old=self._pages(_OLD),
            pages_unread=unread,
            safety_backup=self._safety_backup,
        )


def _cause(error: Exception) -> str:
    if isinstance(error, FatektoolError):
        return error.message
    return f"a fault of fatektool itself: {type(error).__name__}: {error}"
