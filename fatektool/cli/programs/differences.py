"""Two programs' differences, printed by ``diff`` and ``history diff``; in words for ``verify`` too."""

from __future__ import annotations

from itertools import chain
from typing import TYPE_CHECKING, Final

from fatektool.cli.programs.data_differences import comparison_document, comparison_lines
from fatektool.cli.programs.documents import diff_document
from fatektool.cli.shared.colour import diff_line, joined, word
from fatektool.cli.shared.report import write_report
from fatektool.counts import counted
from fatektool.files.times import utc
from fatektool.program.image import page_ranges, ranges

if TYPE_CHECKING:
    from collections.abc import Iterable, Iterator, Mapping
    from pathlib import Path

    from fatektool.cli.shared.output import Voice
    from fatektool.ladder.differences import NetworkChange
    from fatektool.program.compare import Comparison, PageDifference
    from fatektool.program.data.compare import DataComparison
    from fatektool.project.comparison import ProgramComparison

_COLUMNS: Final = 4
_WHOLE: Final = 40
_CONTEXT: Final = 3


def show_differences(
    a: tuple[str, str],
    b: tuple[str, str],
    found: ProgramComparison,
    voice: Voice,
    report: Path | None = None,
    *,
    comments: Mapping[str, str] | None = None,
    data: DataComparison | None = None,
) -> int:
    """Print what differs between two programs; give the exit code.

    Args:
        a: name and hash of the first.
        b: name and hash of the second.
        found: the comparison.
        voice: prints.
        report: the page to write; None for none.
        comments: of elements, shown beside the instructions.
        data: the comparison of their data; None if they are not compared.
    """
    document = diff_document(a, b, found, comments)
    if data is not None:
        document |= {"same": found.same and data.same, "data": comparison_document(data)}
    code = ", same code" if found.same_code else ""
    same = f"same: {len(found.a.pages)} pages{code}"
    if report is not None and found.b is not None:
        from fatektool.report.program import diff_report

        networks = found.networks or ()
        html = diff_report(document, found.a, found.b, time=utc(), changes=networks, comments=comments)
        write_report(report, html)
    lines = program_lines(found, same, (a[0], b[0]), comments, words=voice.verbose)
    data_lines = () if data is None else comparison_lines(data, (a[0], b[0]))
    voice.show(document, chain(lines, data_lines))
    say_how_to_see_words(found, voice)
    return 0 if document["same"] else 1


def difference_lines(found: Comparison, same: str, a: str, b: str, *, words: bool) -> Iterator[str]:
    """What differs between the pages of two programs; one line if nothing does.

    Args:
        found: the comparison.
        same: the line for two programs that are the same.
        a: what the first is called.
        b: what the second is called.
        words: also show the words that differ, page by page.
    """
    if found.same:
        yield joined(word(same[:4]), same[4:])
        return
    if found.a_ladder_words != found.b_ladder_words:
        yield joined(
            word("differs"),
            f": ladder size {found.a_ladder_words} words in {a}, {found.b_ladder_words} in {b}",
        )
    if found.pages:
        yield joined(word("differs"), f": {_extent(found)} ({a} -> {b})")
    in_both = [page.page for page in found.pages if page.a is not None and page.b is not None]
    if in_both:
        yield page_ranges(in_both)
    for name, only in (
        (a, [page.page for page in found.pages if page.b is None]),
        (b, [page.page for page in found.pages if page.a is None]),
    ):
        if only:
            yield f"{page_ranges(only)}: only in {name}"
    if words:
        for page in found.pages:
            yield from _word_lines(page)


def _word_lines(page: PageDifference) -> Iterator[str]:
    """The words of a page that differ, in columns; nothing for a page that only one side has."""
    if not page.words:
        return
    yield f"page {page.page}, {counted(len(page.words), 'word')}: {ranges(word.word for word in page.words)}"
    shown = [f"{word.word:>3}: {word.a:04X} -> {word.b:04X}" for word in page.words]
    for first in range(0, len(shown), _COLUMNS):
        yield f"  {'  '.join(shown[first : first + _COLUMNS])}"


def program_lines(
    found: ProgramComparison,
    same: str,
    sides: tuple[str, str],
    comments: Mapping[str, str] | None = None,
    *,
    words: bool,
) -> Iterator[str]:
    """What differs between two programs: the pages, then the networks as a unified diff of instructions.

    Args:
        found: the comparison.
        same: the line for two programs that are the same.
        sides: what the first and the second are called.
        comments: of elements, shown beside the instructions.
        words: also show the words that differ, page by page.
    """
    yield from difference_lines(found.pages, same, *sides, words=words)
    if found.networks is None:
        return
    if found.same_code:
        if not found.same and found.code is not None:
            code = found.code
            size = f"{counted(len(code.words), 'word')} in {counted(len(code.networks), 'network')}"
            exchanged = found.b is not None and found.a.header.byte_order != found.b.header.byte_order
            why = "the two bytes of each word are exchanged" if exchanged else "what differs is not code"
            yield f"same code: {size}; {why}"
        return
    yield f"networks: {found.networks_summary}"
    yield diff_line(f"--- {sides[0]}")
    yield diff_line(f"+++ {sides[1]}")
    yield from change_lines(found.networks, comments)


def say_how_to_see_words(found: ProgramComparison, voice: Voice) -> None:
    """Name the option that shows the words, if some differ and are not shown."""
    if found.pages.word_count and not voice.verbose and not voice.json:
        voice.say("-v shows the words of each page that differs")


def change_lines(
    changes: Iterable[NetworkChange], comments: Mapping[str, str] | None = None
) -> Iterator[str]:
    """Networks that differ, a hunk each."""
    for change in changes:
        yield from _network_lines(change, comments or {})


def _network_lines(change: NetworkChange, comments: Mapping[str, str]) -> Iterator[str]:
    """A network as a hunk: all of it, or of a long one what is near a difference."""
    here, there = (network.name if network is not None else "" for network in (change.a, change.b))
    moved = f"{here} -> {there}" if here and there and here != there else here or there
    yield diff_line(f"@@ {moved} {change.change} @@")
    near = {
        near
        for number, line in enumerate(change.diff)
        if line.sign != " "
        for near in range(number - _CONTEXT, number + _CONTEXT + 1)
    }
    left_out = False
    for number, line in enumerate(change.diff):
        is_shown = len(change.diff) <= _WHOLE or number in near
        if is_shown:
            remark = beside(line.elements, comments)
            yield diff_line(f"{line!s:<30}  {remark}" if remark else str(line))
        elif not left_out:
            yield " ..."
        left_out = not is_shown


def beside(elements: tuple[str, ...], comments: Mapping[str, str]) -> str:
    """The comments of an instruction's elements, as they are shown beside it."""
    known = [(element, comments[element]) for element in elements if element in comments]
    if len(elements) == 1:
        return known[0][1] if known else ""
    return ", ".join(f"{element}: {comment}" for element, comment in known)


def size_of(found: ProgramComparison) -> str:
    """How much differs, in words: ``N0009 changed, 3 words in 1 page``."""
    pages = found.pages
    if pages.a_ladder_words != pages.b_ladder_words:
        return f"ladder size {pages.a_ladder_words} words, and {pages.b_ladder_words}"
    networks = found.networks_summary
    return _extent(pages) if networks is None else f"{networks}, {_extent(pages)}"


def _extent(found: Comparison) -> str:
    return f"{counted(found.word_count, 'word')} in {counted(len(found.pages), 'page')}"
