"""Reading a program whole, and twice: the part that backup and restore share.

Two passes must agree. Where they do not, the line's behaviour shows why:

- the line was clean in both: it is the PLC that gave two answers, somebody is loading a program, or it is not
  the same PLC any more. That is said, and nothing is kept.
- the line had errors: one may have slipped through its 8-bit checksum. Another pass is read, until two in a
  row agree.

A PLC may refuse pages that its ladder size asks for: past its end (error A or 2). What it gave is its whole
program if the header announces no more, or if the page that it refuses is the very last.
"""

from __future__ import annotations

from dataclasses import dataclass
from typing import TYPE_CHECKING, Final

from fatektool.callbacks import ignore
from fatektool.errors import DataError, LineError, PlcRefused
from fatektool.program.archive import Proof
from fatektool.program.compare import compare
from fatektool.program.image import Program, is_whole, page_count, ranges

if TYPE_CHECKING:
    from collections.abc import Callable

    from fatektool.client import Plc
    from fatektool.jobs.progress import Progress
    from fatektool.protocol.status import DetailedStatus

MOST_PASSES: Final = 5
PAST_THE_END: Final = {0x2, 0xA}
"""The error codes of a page that the PLC does not have: illegal value, illegal address."""

_PART_REFUSED: Final = (
    "it gave the pages before: somebody may be loading a program, or a part of it may have a password; run "
    "it again, or use the engineer's project file (.pdw), which 'fatektool listing' reads"
)


@dataclass(frozen=True, slots=True)
class ProgramReading:
    """A program that was read.

    Attributes:
        status: the answer to 53 of the last pass.
        program: the image.
        passes: how often it was read whole.
        proof: how its pages were proven.
    """

    status: DetailedStatus
    program: Program
    passes: int
    proof: Proof


def read_program(
    plc: Plc,
    phase: str = "reading",
    progress: Progress = ignore,
    status: DetailedStatus | None = None,
) -> ProgramReading:
    """Read 53 and all pages, once.

    Args:
        plc: the PLC.
        phase: what the progress calls it.
        progress: called for each page.
        status: the answer to 53, if it was read just now.

    Raises:
        LineError: no answer for a page.
        PlcRefused: the PLC refuses its program.
        DataError: the PLC's ladder size is 0.
    """
    if status is None:
        status = plc.detailed_status()
    words = status.system.ladder_words
    if not words:
        raise DataError(
            "the PLC's detailed status (53) has a ladder size of 0 words: there is nothing to read",
            hint="check the model with 'fatektool status'",
        )
    return ProgramReading(
        status, Program(words, tuple(read_all_pages(plc, words, phase, progress))), 1, Proof(None, 0, 0)
    )


def one_of_several(progress: Progress, before: int, *, passes: int = 1) -> Progress:
    """The progress of one pass as a part of that of all passes.

    Args:
        progress: of all passes.
        before: pages that were read in the passes before.
        passes: passes from this one on, as far as is known.
    """
    return lambda phase, done, total: progress(phase, before + done, before + passes * total)


def read_all_pages(
    plc: Plc, words: int, phase: str, progress: Progress, count: int | None = None
) -> list[bytes]:
    """Read the pages that a PLC has.

    Args:
        plc: the PLC.
        words: the ladder size that it says it has.
        phase: what the progress calls it.
        progress: called for each page.
        count: read no more than this many; None for all that the ladder size asks for.

    Raises:
        LineError: no answer for a page.
        PlcRefused: it refuses a page before its program's end.
    """
    last = page_count(words) - 1
    total = last + 1 if count is None else count

    progress(phase, 0, total)
    pages, refusal = plc.read_pages_until_refused(range(total), lambda done: progress(phase, done, total))
    if refusal is not None:
        past_the_end = refusal.code in PAST_THE_END and is_whole(pages, words)
        if not past_the_end or gives_page(plc, last):
            refusal.hint = _PART_REFUSED if pages else refusal.hint
            raise refusal
        progress(phase, len(pages), len(pages))
    return pages


def gives_page(plc: Plc, page: int) -> bool:
    """True if the PLC has this page."""
    try:
        plc.read_page(page)
    except PlcRefused as refused:
        if refused.code not in PAST_THE_END:
            raise
        return False
    return True


def read_program_twice(
    plc: Plc,
    progress: Progress = ignore,
    *,
    phase: str = "reading",
    after_first: Callable[[ProgramReading], None] | None = None,
) -> ProgramReading:
    """Read 53 and all pages until two passes in a row agree.

    Args:
        plc: the PLC.
        progress: called for each page.
        phase: what the progress calls it.
        after_first: looks at the first pass, and may raise before the second is read.

    Raises:
        DataError: two passes over a clean line differ.
        LineError: no two passes over a bad line agree.
        PlcRefused: the PLC refuses its program.
    """
    before = line_trouble(plc)
    last = read_program(plc, phase, one_of_several(progress, 0, passes=2))
    pages_read = len(last.program.pages)
    if after_first is not None:
        after_first(last)
    for number in range(2, MOST_PASSES + 1):
        between = line_trouble(plc)
        again = read_program(plc, phase, one_of_several(progress, pages_read))
        pages_read += len(again.program.pages)
        difference = _difference(last, again)
        if difference is None:
            proof = Proof(None, 0, len(again.program.pages))
            return ProgramReading(again.status, again.program, number, proof)
        if line_trouble(plc) == before:
            raise DataError(
                f"two passes without line errors read different programs: {difference}",
                hint="check that nobody loads a program and that the PLC was not replaced, then run it again",
            )
        before, last = between, again
    raise LineError(
        f"{plc.target}: no two of {MOST_PASSES} passes read the same program: the line has too many errors",
        hint="check shield and termination; use a lower baud rate or a shorter cable",
    )


def _difference(a: ProgramReading, b: ProgramReading) -> str | None:
    """What two passes differ in, in words."""
    changed = _status_difference(a.status, b.status)
    if changed is not None:
        return changed
    found = compare(a.program, b.program)
    return None if found.same else f"page {ranges(found.page_numbers)}"


def _status_difference(a: DetailedStatus, b: DetailedStatus) -> str | None:
    """What two answers to 53 differ in, in words."""
    if a.system == b.system:
        return None
    before, after = a.system.document(), b.system.document()
    changed = ", ".join(
        f"{name} {before[name]}, then {after[name]}" for name in before if before[name] != after[name]
    )
    return f"the detailed status (53) changed: {changed}"


def require_same_status(before: DetailedStatus, now: DetailedStatus) -> None:
    """Refuse a PLC whose size or model changed while its program was read.

    Raises:
        DataError: it did; says what.
    """
    changed = _status_difference(before, now)
    if changed is not None:
        raise DataError(
            f"the PLC changed while its program was read: {changed}",
            hint="check whether the PLC was replaced, then run it again",
        )


def line_trouble(plc: Plc) -> int:
    """The line's errors so far; the same twice means a clean line in between."""
    return plc.link.counters.trouble + plc.link.unsolicited
