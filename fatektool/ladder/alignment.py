"""Alignment of two sequences, as git aligns lines: equal, inserted and removed parts.

::

    1  equal parts at the beginning and end are removed
    2  items that occur once in both, in the same order, are anchors (patience); the gaps are aligned
    separately 3  a gap without anchors is aligned by difflib, in quadratic time; if too large, it is one
    replacement
"""

from __future__ import annotations

from bisect import bisect_left
from collections import Counter
from difflib import SequenceMatcher
from typing import TYPE_CHECKING, Final, NamedTuple

if TYPE_CHECKING:
    from collections.abc import Hashable, Iterator, Sequence

_LARGEST_GAP: Final = 1_000_000
_DEEPEST: Final = 50


class AlignedBlock(NamedTuple):
    """A part of both: ``a[a_first:a_end]`` and ``b[b_first:b_end]``, which are equal or not."""

    equal: bool
    a_first: int
    a_end: int
    b_first: int
    b_end: int


class _Gap(NamedTuple):
    """A part of both that is to be aligned, and its depth."""

    a_first: int
    a_end: int
    b_first: int
    b_end: int
    depth: int = 0


def align(a: Sequence[Hashable], b: Sequence[Hashable]) -> list[AlignedBlock]:
    """Align two sequences; the blocks, in order, are both sequences; equal and unequal blocks alternate."""
    found: list[AlignedBlock] = []
    for block in _lay(a, b, _Gap(0, len(a), 0, len(b))):
        if block.a_first == block.a_end and block.b_first == block.b_end:
            continue
        if found and found[-1].equal == block.equal:
            last = found.pop()
            found.append(AlignedBlock(block.equal, last.a_first, block.a_end, last.b_first, block.b_end))
        else:
            found.append(block)
    return found


def _lay(a: Sequence[Hashable], b: Sequence[Hashable], gap: _Gap) -> Iterator[AlignedBlock]:
    i, m, j, n, depth = gap
    head = 0
    while i + head < m and j + head < n and a[i + head] == b[j + head]:
        head += 1
    yield AlignedBlock(True, i, i + head, j, j + head)  # noqa: FBT003  # a value as the others
    i, j = i + head, j + head
    tail = 0
    while i < m - tail and j < n - tail and a[m - tail - 1] == b[n - tail - 1]:
        tail += 1
    yield from _middle(a, b, _Gap(i, m - tail, j, n - tail, depth))
    yield AlignedBlock(True, m - tail, m, n - tail, n)  # noqa: FBT003


def _middle(a: Sequence[Hashable], b: Sequence[Hashable], gap: _Gap) -> Iterator[AlignedBlock]:
    i, m, j, n, depth = gap
    anchors = _anchors(a[i:m], b[j:n]) if i < m and j < n and depth < _DEEPEST else []
    if anchors:
        here, there = i, j
        for x, y in anchors:
            yield from _lay(a, b, _Gap(here, i + x, there, j + y, depth + 1))
            yield AlignedBlock(True, i + x, i + x + 1, j + y, j + y + 1)  # noqa: FBT003
            here, there = i + x + 1, j + y + 1
        yield from _lay(a, b, _Gap(here, m, there, n, depth + 1))
    elif i < m and j < n and (m - i) * (n - j) <= _LARGEST_GAP:
        for tag, x, x_end, y, y_end in SequenceMatcher(None, a[i:m], b[j:n], autojunk=False).get_opcodes():
            yield AlignedBlock(tag == "equal", i + x, i + x_end, j + y, j + y_end)
    else:
        yield AlignedBlock(False, i, m, j, n)  # noqa: FBT003


def _anchors(a: Sequence[Hashable], b: Sequence[Hashable]) -> list[tuple[int, int]]:
    """Items that occur once in both: the longest sequence of them with the same order in both."""
    in_a, in_b = Counter(a), Counter(b)
    places = {item: place for place, item in enumerate(b) if in_b[item] == 1}
    pairs = [(x, places[item]) for x, item in enumerate(a) if in_a[item] == 1 and item in places]
    ends: list[int] = []  # of rows of each length, the smallest place in b that one ends with
    last: list[int] = []
    before: list[int] = []
    for number, (_, y) in enumerate(pairs):
        length = bisect_left(ends, y)
        before.append(last[length - 1] if length else -1)
        ends[length : length + 1] = [y]
        last[length : length + 1] = [number]
    row = []
    number = last[-1] if last else -1
    while number >= 0:
        row.append(pairs[number])
        number = before[number]
    return row[::-1]
