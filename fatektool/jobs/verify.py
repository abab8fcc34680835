"""Is the program in the PLC the one on file?"""

from __future__ import annotations

from dataclasses import replace
from typing import TYPE_CHECKING

from fatektool.jobs.progress import Progress, no_progress
from fatektool.jobs.reading import read_program
from fatektool.program.compare import Comparison, compare

if TYPE_CHECKING:
    from fatektool.client import Plc
    from fatektool.program.image import Program


def verify(plc: Plc, program: Program, *, progress: Progress = no_progress) -> Comparison:
    """Compare a program (``a``) with the one in the PLC (``b``).

    What seems to differ is read again before it is said, so that no error on the line is taken for a change.

    Args:
        plc: the PLC; it may run.
        program: what is on file.
        progress: told of each page.

    Raises:
        LineError: a page found no answer.
        PlcRefused: the PLC does not give its program away.
    """
    status = plc.detailed_status()
    if status.system.ladder_words != program.ladder_words:
        status = plc.detailed_status()
    size = status.system.ladder_words
    if size != program.ladder_words:
        return Comparison(program.ladder_words, size, ())
    found = read_program(plc, "verifying", progress, status).program
    different = compare(program, found).page_numbers
    if different:
        pages = list(found.pages)
        total = len(different)
        again = plc.read_pages(different, lambda done: progress("reading again", done, total))
        for number, page in zip(different, again, strict=True):
            pages[number] = page
        found = replace(found, pages=tuple(pages))
    return compare(program, found)
