"""``verify`` and ``diff``: a map of the pages, what changed, and the words of both sides in hex.

The numbers are those of the document. It does not have the unchanged words, so the first program is given
too; the second follows from both, except pages that the first does not have.
"""

from __future__ import annotations

import struct
from typing import TYPE_CHECKING, Any, Final

from fatektool.counts import counted
from fatektool.program.headers.header import PAGE_WORDS
from fatektool.program.image import page_count, ranges
from fatektool.report.markup import DASH, Html, figure, table, tag, when
from fatektool.report.networks import changed_networks
from fatektool.report.page import Report, Verdict, code, note, render, section
from fatektool.report.page_map import page_map

if TYPE_CHECKING:
    from collections.abc import Mapping, Sequence

    from fatektool.ladder.differences import NetworkChange
    from fatektool.program.image import Program

MOST_PAGES: Final = 64
_ROW: Final = 8


def verify_report(
    document: Mapping[str, Any],
    program: Program,
    changes: Sequence[NetworkChange] = (),
    comments: Mapping[str, str] | None = None,
) -> str:
    """The comparison of the PLC's program with a backup.

    Args:
        document: ``fatektool.verify/1``.
        program: of the backup.
        changes: the networks that differ, for the drawings.
        comments: of elements.
    """
    where = f"station {document['station']} on {document['target']}"
    facts = [
        ("Backup", code(document["file"])),
        ("SHA-256 of the backup's program", code(document["sha256"])),
        ("PLC", f"{where}, {document['protocol']}"),
        ("Time", when(document["time"])),
    ]
    title, what = "Program on file and in the PLC", f"{document['file']} and {where}"
    sides = ("file", "PLC")
    networks = changed_networks(document["networks"] or (), changes, comments or {}, sides)
    names = (title, what, document["time"])
    return _report(document, (program, None), sides, names, facts, networks=networks)


def diff_report(
    document: Mapping[str, Any],
    a: Program,
    b: Program,
    *,
    time: str,
    changes: Sequence[NetworkChange] = (),
    comments: Mapping[str, str] | None = None,
) -> str:
    """The comparison of two backups.

    Args:
        document: ``fatektool.diff/1``.
        a: the first program.
        b: the second.
        time: the present, UTC, RFC 3339.
        changes: the networks that differ, for the drawings.
        comments: of elements.
    """
    facts: list[tuple[str, object]] = []
    for side in ("a", "b"):
        facts += [
            (f"Backup {side.upper()}", code(document[side]["file"])),
            (f"SHA-256 of {side.upper()}'s program", code(document[side]["sha256"])),
        ]
    what = f"{document['a']['file']} (A) and {document['b']['file']} (B)"
    sides = ("A", "B")
    networks = changed_networks(document["networks"] or (), changes, comments or {}, sides)
    return _report(document, (a, b), sides, ("Two programs", what, time), facts, networks=networks)


def _report(
    document: Mapping[str, Any],
    programs: tuple[Program, Program | None],
    sides: tuple[str, str],
    names: tuple[str, str, str],
    facts: Sequence[tuple[str, object]],
    *,
    networks: Html,
) -> str:
    """The report.

    Args:
        document: either.
        programs: the first, and the second if it is known.
        sides: the names of the two.
        names: title, subject and time.
        facts: the first ones, before the sizes.
        networks: the section with those that differ.
    """
    title, what, time = names
    sizes = document["a_ladder_words"], document["b_ladder_words"]
    sized = [
        (f"Ladder size, {side}", figure(size, unit="words")) for side, size in zip(sides, sizes, strict=True)
    ]
    counts = [
        ("Pages that differ", _differing(document)),
        ("Words that differ", figure(document["words_differ"])),
    ]
    pages = _pages(document, programs)
    sections = [_map(document, pages)]
    if document["networks"]:
        sections.append(networks)
    if document["differences"]:
        sections += [_changes(document, sides), _words(document, programs, sides)]
    return render(
        Report(
            title,
            what,
            _verdict(document, sides, pages),
            [*facts, *sized, *counts],
            sections,
            document["schema"],
            time,
        )
    )


def _verdict(document: Mapping[str, Any], sides: tuple[str, str], pages: int) -> Verdict:
    if document["same"]:
        said = f"The two programs are equal, all {pages} pages of them."
        if document["b_has_more_pages"]:
            said = f"All {pages} pages of the {sides[0]} are equal. The {sides[1]} has more."
        return Verdict("Same", said, good=True)
    sizes = document["a_ladder_words"], document["b_ladder_words"]
    parts = []
    if sizes[0] != sizes[1]:
        parts.append(f"The ladder size is {sizes[0]} words ({sides[0]}) and {sizes[1]} words ({sides[1]}).")
    if document["differences"]:
        words = counted(document["words_differ"], "word")
        parts.append(f"{words} in {counted(document['pages_differ'], 'page')} of {pages}.")
    return Verdict("Different", " ".join(parts), good=False)


def _pages(document: Mapping[str, Any], programs: tuple[Program, Program | None]) -> int:
    """The number of pages of the larger one."""
    a, b = programs
    if b is not None:
        return max(len(a.pages), len(b.pages))
    sizes = document["a_ladder_words"], document["b_ladder_words"]
    return len(a.pages) if sizes[0] == sizes[1] else page_count(max(sizes))


def _map(document: Mapping[str, Any], pages: int) -> Html:
    if not document["differences"] and not document["same"]:
        return section(
            "Map of the pages",
            note("The ladder sizes differ, so the program is another one: the PLC's pages were not read."),
        )
    changed = {page["page"]: len(page["words"]) or None for page in document["differences"]}
    said = "The program's header comes first. A page is 64 words."
    drawn = page_map("map", "The program's pages", pages, changed)
    return section("Map of the pages", tag("p", said), tag("figure", drawn))


def _differing(document: Mapping[str, Any]) -> object:
    """The number of pages that differ, and which."""
    numbers = [page["page"] for page in document["differences"]]
    count = figure(document["pages_differ"])
    return tag("span", count, f": {ranges(numbers)}") if len(numbers) > 1 else count


def _changes(document: Mapping[str, Any], sides: tuple[str, str]) -> Html:
    """A row for each page, or for consecutive pages in which the same words differ."""
    rows = []
    position = 0
    for run in _runs(document["differences"]):
        first, last = run[0], run[-1]["page"]
        shown = figure(first["page"]) if first["page"] == last else tag("span", f"{first['page']}-{last}")
        name = tag("a", shown, href=f"#page-{first['page']}") if position < MOST_PAGES else shown
        places = _places(first)
        rows.append(
            (name, figure(len(places)) if places else DASH, ranges(places) or "only in one of the two")
        )
        position += len(run)
    return section(
        "Pages that differ",
        table(f"From {sides[0]} to {sides[1]}", ("Page", "Words", "Which words"), rows, numeric=(0, 1)),
    )


def _runs(pages: Sequence[Mapping[str, Any]]) -> list[list[Mapping[str, Any]]]:
    """Consecutive pages in which the same words differ, as groups."""
    runs: list[list[Mapping[str, Any]]] = []
    for page in pages:
        last = runs[-1][-1] if runs else None
        if last is not None and page["page"] == last["page"] + 1 and _places(page) == _places(last):
            runs[-1].append(page)
        else:
            runs.append([page])
    return runs


def _places(page: Mapping[str, Any]) -> list[int]:
    return [word["word"] for word in page["words"]]


def _words(
    document: Mapping[str, Any], programs: tuple[Program, Program | None], sides: tuple[str, str]
) -> Html:
    pages = document["differences"]
    said = [tag("p", "Words in hex. Those that differ are bold and underlined.")]
    if len(pages) > MOST_PAGES:
        left = len(pages) - MOST_PAGES
        said.append(
            note(
                f"The first {MOST_PAGES} pages that differ are shown. The other {left} are in the table; "
                f"their words are in the JSON document (--json)."
            )
        )
    return section("Side by side", *said, *(_page(page, programs, sides) for page in pages[:MOST_PAGES]))


def _page(page: Mapping[str, Any], programs: tuple[Program, Program | None], sides: tuple[str, str]) -> Html:
    number = page["page"]
    changed = {word["word"]: (word["a"], word["b"]) for word in page["words"]}
    one = _page_words(programs[0], number)
    other = _page_words(programs[1], number)
    if one is not None and changed:
        other = [changed[place][1] if place in changed else text for place, text in enumerate(one)]
    shown = [
        _side(f"Page {number}, {side}", words, changed)
        for side, words in zip(sides, (one, other), strict=True)
    ]
    heading = f"Page {number}" + (f", {counted(len(changed), 'word')} of {PAGE_WORDS}" if changed else "")
    return tag(
        "section",
        tag("h3", heading),
        tag("div", *shown, class_="sides"),
        _list(page, sides) if changed else "",
        id=f"page-{number}",
        class_="page",
    )


def _page_words(program: Program | None, number: int) -> list[str] | None:
    if program is None or number >= len(program.pages):
        return None
    return [f"{word:04X}" for word in struct.unpack(f">{PAGE_WORDS}H", program.pages[number])]


def _side(caption: str, words: Sequence[str] | None, changed: Mapping[int, Any]) -> Html:
    if words is None:
        return tag("p", f"{caption}: not in this program.")
    rows = [
        (start, *(tag("mark", words[place]) if place in changed else words[place] for place in places))
        for start, places in ((start, range(start, start + _ROW)) for start in range(0, PAGE_WORDS, _ROW))
    ]
    head = (tag("span", "word", class_="hidden"), *(f"+{place}" for place in range(_ROW)))
    return tag("div", table(caption, head, rows, scroll=False), class_="hex")


def _list(page: Mapping[str, Any], sides: tuple[str, str]) -> Html:
    """The changes, word by word: for readers who do not see the marks, and for copying."""
    rows = [(figure(word["word"]), tag("code", word["a"]), tag("code", word["b"])) for word in page["words"]]
    caption = f"Page {page['page']}, the words that differ"
    return tag("details", tag("summary", caption), table(caption, ("Word", *sides), rows, numeric=(0,)))
