"""Is the program in the PLC the one on file?"""

from __future__ import annotations

from typing import TYPE_CHECKING

from fatektool.jobs.progress import Progress, no_progress
from fatektool.jobs.reading import gives_page, read_all_pages
from fatektool.program.compare import Comparison, compare_images

if TYPE_CHECKING:
    from fatektool.client import Plc
    from fatektool.program.image import Program


def verify(plc: Plc, program: Program, *, progress: Progress = no_progress) -> Comparison:
    """Compare a program (``a``) with the one in the PLC (``b``).

    As many pages are read as ``program`` has. What seems to differ is read again before it is said, so that
    no error on the line is taken for a change.

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
    count = len(program.pages)
    found = read_all_pages(plc, size, "verifying", progress, count)
    different = compare_images(program, size, found).page_numbers
    again = [number for number in different if number < len(found)]
    if again:
        total = len(again)
        pages = plc.read_pages(again, lambda done: progress("reading again", done, total))
        for number, page in zip(again, pages, strict=True):
            found[number] = page
    has_more = count < program.pages_asked_for and len(found) == count and gives_page(plc, count)
    return compare_images(program, size, found, b_has_more=has_more)
