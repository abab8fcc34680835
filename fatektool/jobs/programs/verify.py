"""Is the program in the PLC the one on file?"""

from __future__ import annotations

from dataclasses import dataclass
from typing import TYPE_CHECKING

from fatektool.callbacks import ignore
from fatektool.jobs.programs.reading import gives_page, read_all_pages
from fatektool.program.compare import Comparison, compare_images
from fatektool.program.image import page_count

if TYPE_CHECKING:
    from fatektool.client import Plc
    from fatektool.jobs.progress import Progress
    from fatektool.program.image import Program
    from fatektool.project.comparison import ProgramComparison
    from fatektool.project.program_file import ProgramFile


def verify(plc: Plc, program: Program, *, progress: Progress = ignore) -> Comparison:
    """Compare a program (``a``) with the one in the PLC (``b``), page by page.

    As many pages are read as ``program`` has. What seems to differ is read again before it is said, so that
    no error on the line is taken for a change.

    Args:
        plc: the PLC; it may run.
        program: what is on file.
        progress: called for each page.

    Raises:
        LineError: no answer for a page.
        PlcRefused: the PLC refuses its program.
    """
    return _verify(plc, program, progress)[0]


def verify_file(plc: Plc, file: ProgramFile, *, progress: Progress = ignore) -> ProgramComparison:
    """Compare the program in a file (``a``), a backup or a project, with the one in the PLC (``b``).

    As ``verify``, and the networks that differ. Of a project the image is compared, in the PLC's order of
    bytes: the PLC's pages past it are not read.

    Args:
        plc: the PLC; it may run.
        file: what is on file.
        progress: called for each page.

    Raises:
        LineError: no answer for a page.
        PlcRefused: the PLC refuses its program.
    """
    from fatektool.ladder.image import code_of
    from fatektool.project.comparison import ProgramComparison, compared, program_or_none

    if file.project is not None:
        return _verify_project(plc, file, progress)
    pages, found = _verify(plc, file.program, progress)
    other = program_or_none(pages.b_ladder_words, found)
    if other is None:
        return ProgramComparison(file.program, None, pages, None, None)
    return compared(file.program, other, pages, file.code, file.code if pages.same else code_of(other))


@dataclass(frozen=True, slots=True)
class VerifyResult:
    """The program in a file against the one in the PLC.

    Attributes:
        file: what is on file.
        found: the comparison; ``a`` is the file.
        duration_s: how long reading and comparing took.
    """

    file: ProgramFile
    found: ProgramComparison
    duration_s: float


def compare_with_plc(plc: Plc, file: ProgramFile, *, progress: Progress = ignore) -> VerifyResult:
    """``verify_file``, with the time that it took; arguments and errors are the same."""
    clock = plc.link.transport.clock
    began = clock()
    found = verify_file(plc, file, progress=progress)
    return VerifyResult(file, found, clock() - began)


def _verify_project(plc: Plc, file: ProgramFile, progress: Progress) -> ProgramComparison:
    from fatektool.project.comparison import compare_with_pages

    size = plc.detailed_status().system.ladder_words
    found = read_all_pages(plc, size, "verifying", progress, min(file.page_count, page_count(size)))
    first = compare_with_pages(file, found)
    if not first.same:
        _read_again(plc, first.pages, found, progress)
    return first if first.same else compare_with_pages(file, found)


def _verify(plc: Plc, program: Program, progress: Progress) -> tuple[Comparison, list[bytes]]:
    """The comparison, and the PLC's pages as far as they were read."""
    status = plc.detailed_status()
    if status.system.ladder_words != program.ladder_words:
        status = plc.detailed_status()
    size = status.system.ladder_words
    if size != program.ladder_words:
        return Comparison(program.ladder_words, size, ()), []
    count = len(program.pages)
    found = read_all_pages(plc, size, "verifying", progress, count)
    _read_again(plc, compare_images(program, size, found), found, progress)
    has_more = count < program.pages_asked_for and len(found) == count and gives_page(plc, count)
    return compare_images(program, size, found, b_has_more=has_more), found


def _read_again(plc: Plc, different: Comparison, found: list[bytes], progress: Progress) -> None:
    """Read the pages again that seem to differ."""
    again = [number for number in different.page_numbers if number < len(found)]
    if again:
        total = len(again)
        pages = plc.read_pages(again, lambda done: progress("reading again", done, total))
        for number, page in zip(again, pages, strict=True):
            found[number] = page
