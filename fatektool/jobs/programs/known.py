"""Pages on file: a page that reads the same as a page on file is proven by one reading.

No damage makes exactly the page of yesterday. What could make it is the answer before it, received once more
in its place while its own is lost: that leaves no trace, and is harmful where both pages are equal on file.
So no page is proven by one reading whose content is also that of the answer before it:

- pages are read in an order in which neighbours differ on file (``apart``);
- where there is no such order, as most pages are blank, a short request (40) is put between two equal pages:
  the answer that came once more is then seen, as it is one to 4F.

Everything else is read again, until two readings in a row agree (``fatektool.jobs.programs.reading``).
"""

from __future__ import annotations

from collections import Counter
from dataclasses import dataclass
from itertools import pairwise
from typing import TYPE_CHECKING

from fatektool.callbacks import ignore
from fatektool.errors import FatektoolError
from fatektool.program.archive import load_backup

if TYPE_CHECKING:
    from collections.abc import Callable, Iterable, Iterator, Sequence
    from pathlib import Path

    from fatektool.program.image import Program


@dataclass(frozen=True, slots=True)
class KnownPages:
    """Programs on file that a PLC may still have.

    Attributes:
        programs: the programs, the likeliest first; at least one.
        source: where the first is from: a file's name or a revision of a history.
    """

    programs: tuple[Program, ...]
    source: str

    def fits(self, ladder_words: int) -> bool:
        """True if the likeliest is for a PLC of this ladder size."""
        return self.programs[0].ladder_words == ladder_words

    def has(self, number: int, page: bytes) -> bool:
        """True if a program on file has this page under this number."""
        return any(number < len(program.pages) and program.pages[number] == page for program in self.programs)

    @property
    def order(self) -> list[int]:
        """The numbers of the likeliest program's pages, neighbours different as far as there is an order."""
        return apart(self.programs[0].pages)


def known_in(path: Path) -> KnownPages:
    """The program in a backup file, as pages on file.

    Raises:
        UsageError: there is no such file.
        DataError: it is damaged or not a backup.
    """
    return KnownPages((load_backup(path).program,), str(path))


def first_known(paths: Iterable[Path | None], note: Callable[[str], None] = ignore) -> KnownPages | None:
    """The first of some backup files that is there and can be read.

    Args:
        paths: the files; None for none.
        note: gets the reason if one cannot be read; this is no fault, as everything is read twice then.
    """
    for path in paths:
        if path is not None and path.is_file():  # a pipe that is written to has nothing to read
            try:
                return known_in(path)
            except FatektoolError as error:
                note(f"{error.message}: it is not used, all pages are read twice")
    return None


def apart(pages: Sequence[bytes]) -> list[int]:
    """Put pages in an order in which no two neighbours are equal, as far as there is one.

    The content that most pages have goes to every second place, the others between. What is left over of it
    is at the end.

    Args:
        pages: their contents, by number.

    Returns:
        Their numbers; in order if no two neighbours are equal in order.
    """
    if all(a != b for a, b in pairwise(pages)):
        return list(range(len(pages)))
    frequency = Counter(pages)
    by_frequency = sorted(
        range(len(pages)), key=lambda number: (-frequency[pages[number]], pages[number], number)
    )
    most = frequency[pages[by_frequency[0]]]
    if 2 * most > len(pages):  # the others go one each between two of the most frequent
        first, others = by_frequency[:most], by_frequency[most:]
        between = [number for pair in zip(first, others, strict=False) for number in pair]
        return between + first[len(others) :]
    places = [*range(0, len(pages), 2), *range(1, len(pages), 2)]
    found = [0] * len(pages)
    for place, number in zip(places, by_frequency, strict=True):
        found[place] = number
    return found


def after_an_equal(order: Sequence[int], pages: Sequence[bytes]) -> Iterator[int]:
    """The places in an order whose page is equal to the one before."""
    for place in range(1, len(order)):
        if pages[order[place]] == pages[order[place - 1]]:
            yield place


def neighbours(changed: Sequence[int], count: int) -> set[int]:
    """The pages beside changed ones, which would be changed too if the change went on while they were read.

    An edit moves what follows it, so changed pages are side by side. For one changed page there are none.

    Args:
        changed: numbers of pages that differ from those on file.
        count: how many pages there are.
    """
    if len(changed) < 2:
        return set()
    beside = {number + step for number in changed for step in (-1, 1)}
    return {number for number in beside if 0 <= number < count} - set(changed)
