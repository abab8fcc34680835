"""The map of a program: a cell for each page, the header first; changed pages are filled and crossed."""

from __future__ import annotations

from typing import TYPE_CHECKING, Final

from fatektool.counts import counted
from fatektool.report.markup import NEWLINE, Html, join, tag
from fatektool.report.svg import WIDTH, canvas, label

if TYPE_CHECKING:
    from collections.abc import Mapping

_COLUMNS: Final = 32
_PITCH: Final = 15
_CELL: Final = 12
_LEFT: Final = WIDTH - _COLUMNS * _PITCH
_TOP: Final = 20
_LEGEND: Final = 26
_EVERY: Final = 8
_APART: Final = 130


def page_map(name: str, title: str, pages: int, changed: Mapping[int, int | None]) -> Html:
    """Draw the map.

    Args:
        name: its id.
        title: of the map.
        pages: the number of pages, including the header page.
        changed: the pages that differ, with the number of words; None for a page that only one side has.
    """
    rows = -(-pages // _COLUMNS)
    same = "".join(f"M{x} {y}{_box()}" for x, y in map(_place, range(pages)))
    drawn: list[Html] = [tag("path", d=same, class_="cell")]
    drawn += [
        label(_LEFT + column * _PITCH + _CELL / 2, _TOP - 6, column, anchor="middle")
        for column in range(0, min(pages, _COLUMNS), _EVERY)
    ]
    drawn += [
        label(_LEFT - 6, _TOP + row * _PITCH + _CELL - 2, row * _COLUMNS, anchor="end") for row in range(rows)
    ]
    for page, words in sorted(changed.items()):
        said = f"page {page}: {_words(words)}"
        drawn.append(_marked(*_place(page), said, lone=words is None))
    bottom = _TOP + rows * _PITCH
    legend = [
        _key(0, bottom, "same", tag("path", d=f"M{_LEFT} {bottom + 10}{_box()}", class_="cell")),
        _key(1, bottom, "differs", _marked(_LEFT + _APART, bottom + 10, "differs")),
    ]
    if None in changed.values():
        legend.append(
            _key(2, bottom, "in one only", _marked(_LEFT + 2 * _APART, bottom + 10, "one", lone=True))
        )
    said = f"{counted(pages, 'page')} in rows of {_COLUMNS}; {counted(len(changed), 'differs', 'differ')}."
    return canvas(name, title, said, bottom + _LEGEND, join([*drawn, *legend], NEWLINE))


def _place(page: int) -> tuple[int, int]:
    row, column = divmod(page, _COLUMNS)
    return _LEFT + column * _PITCH, _TOP + row * _PITCH


def _box() -> str:
    return f"h{_CELL}v{_CELL}h-{_CELL}z"


def _marked(x: int, y: int, said: str, *, lone: bool = False) -> Html:
    """A marked cell: filled with a cross in it, or only a slash."""
    if lone:
        shape = tag("path", d=f"M{x} {y}{_box()}M{x} {y + _CELL}l{_CELL} -{_CELL}")
        return tag("g", tag("title", said), shape, class_="lone")
    box = tag("path", d=f"M{x} {y}{_box()}", class_="box")
    arm = _CELL - 6
    cross = f"M{x + 3} {y + 3}l{arm} {arm}m0 -{arm}l-{arm} {arm}"
    return tag("g", tag("title", said), box, tag("path", d=cross, class_="cross"), class_="changed")


def _key(number: int, bottom: int, said: str, cell: Html) -> Html:
    """A line of the legend: a cell and its meaning."""
    return join([cell, label(_LEFT + number * _APART + _PITCH + 4, bottom + 10 + _CELL - 2, said)])


def _words(words: int | None) -> str:
    if words is None:
        return "only in one of the two"
    return counted(words, "word differs", "words differ")
