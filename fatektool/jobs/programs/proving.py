"""Reading a program so that every page is proven: by a page on file, or by two readings in a row that agree.

::

    53, then all pages once                                 a page as on file is proven
    the others again, with the pages beside them            until two readings in a row agree
    53 again, if there were others                          as at the beginning

Where nothing is on file, or it is for another ladder size, or the PLC has more or fewer pages than the file,
the program is read whole until two passes agree (``reading``).
"""

from __future__ import annotations

from typing import TYPE_CHECKING

from fatektool.callbacks import ignore
from fatektool.errors import DataError, LineError, PlcRefused
from fatektool.jobs.programs.known import after_an_equal, neighbours
from fatektool.jobs.programs.reading import (
    MOST_PASSES,
    ProgramReading,
    gives_page,
    line_trouble,
    one_of_several,
    read_program_twice,
    require_same_status,
)
from fatektool.program.archive import Proof
from fatektool.program.image import Program, ranges

if TYPE_CHECKING:
    from collections.abc import Callable, Sequence

    from fatektool.client import Plc
    from fatektool.jobs.programs.known import KnownPages
    from fatektool.jobs.progress import Progress
    from fatektool.protocol.status import DetailedStatus


def read_proven(
    plc: Plc,
    known: KnownPages | None,
    progress: Progress = ignore,
    *,
    phase: str = "reading",
    after_first: Callable[[ProgramReading], None] | None = None,
) -> ProgramReading:
    """Read 53 and all pages, each page proven.

    Args:
        plc: the PLC.
        known: what is on file of it; None for nothing.
        progress: called for each page.
        phase: what the progress calls it.
        after_first: looks at the first reading of all pages, and may raise before more is read.

    Raises:
        DataError: the program changed while it was read over a clean line.
        LineError: no two readings over a bad line agree, or no answer for a page.
        PlcRefused: the PLC refuses its program.
    """
    if known is not None:
        status = plc.detailed_status()
        if known.fits(status.system.ladder_words):
            found = _KnownReading(plc, known, status, progress, phase).read(after_first)
            if found is not None:
                return found
    return read_program_twice(plc, progress, phase=phase, after_first=after_first)


class _KnownReading:
    """One reading of a program of which pages are on file."""

    def __init__(
        self, plc: Plc, known: KnownPages, status: DetailedStatus, progress: Progress, phase: str
    ) -> None:
        self._plc = plc
        self._known = known
        self._status = status
        self._progress = progress
        self._phase = phase
        self._expected = known.programs[0]
        self._pages: list[bytes] = []
        self._pages_read = 0

    def read(self, after_first: Callable[[ProgramReading], None] | None) -> ProgramReading | None:
        """The program, or None if it has not as many pages as the one on file."""
        trouble = line_trouble(self._plc)
        others = self._read_once()
        if others is None:
            return None
        if after_first is not None:
            after_first(self._reading(0))
        again = sorted({*others, *neighbours(others, len(self._pages))})
        if again:
            self._read_again(again, trouble)
            now = self._plc.detailed_status()
            require_same_status(self._status, now)
            self._status = now
        return self._reading(len(again))

    def _read_once(self) -> list[int] | None:
        """Read every page; the numbers of those not proven, None if the PLC has more or fewer pages."""
        order = self._known.order
        separated = set(after_an_equal(order, self._expected.pages))
        try:
            answers = self._read(order, separated)
        except PlcRefused:
            return None
        count = len(order)
        if count < self._expected.pages_asked_for and gives_page(self._plc, count):
            return None
        by_number = dict(zip(order, answers, strict=True))
        self._pages = [by_number[number] for number in range(count)]
        doubtful = {order[place] for place in after_an_equal(order, self._pages) if place not in separated}
        return [
            number
            for number, page in enumerate(self._pages)
            if number in doubtful or not self._known.has(number, page)
        ]

    def _read_again(self, numbers: Sequence[int], trouble: int) -> None:
        """Read pages until two readings in a row agree; ``trouble`` is the line's before the first."""
        for _ in range(2, MOST_PASSES + 1):
            between = line_trouble(self._plc)
            found = dict(zip(numbers, self._read(numbers), strict=True))
            numbers = [number for number, page in found.items() if self._pages[number] != page]
            if not numbers:
                return
            if line_trouble(self._plc) == trouble:
                raise DataError(
                    "the program changed while it was read: two readings without line errors differ in page "
                    f"{ranges(numbers)}",
                    hint="check that nobody loads a program and that the PLC was not replaced, then run "
                    "it again",
                )
            for number, page in found.items():
                self._pages[number] = page
            trouble = between
        raise LineError(
            f"{self._plc.target}: no two of {MOST_PASSES} readings of page {ranges(numbers)} agree: "
            "the line has too many errors",
            hint="check shield and termination; use a lower baud rate or a shorter cable",
        )

    def _read(self, numbers: Sequence[int], separated: set[int] | None = None) -> list[bytes]:
        total = len(numbers)
        progress = one_of_several(self._progress, self._pages_read)
        progress(self._phase, 0, total)
        found = self._plc.read_pages(
            numbers, lambda done: progress(self._phase, done, total), separated=separated or ()
        )
        self._pages_read += total
        return found

    def _reading(self, read_twice: int) -> ProgramReading:
        program = Program(self._expected.ladder_words, tuple(self._pages))
        proof = Proof(self._known.source, len(self._pages) - read_twice, read_twice)
        return ProgramReading(self._status, program, 1, proof)
