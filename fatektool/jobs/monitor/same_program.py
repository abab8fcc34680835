"""Is the PLC's program the one in a file? As cheaply as it can be told.

Two pages of an FBs header have the length of the code and its checksum of 16 bits; beside them the pages with
the networks that are looked at are compared word for word. What else differs in the code shows in the
checksum, but for one change in 65536. Settings are not compared. ``verify`` compares all.
"""

from __future__ import annotations

from contextlib import suppress
from dataclasses import dataclass, field
from enum import StrEnum
from typing import TYPE_CHECKING, Final

from fatektool.errors import NoAnswer, PlcRefused
from fatektool.ladder.image import words_of_image
from fatektool.program.headers.header import FBS, PAGE_WORDS, SWAPPED
from fatektool.protocol.commands import Command

if TYPE_CHECKING:
    from collections.abc import Iterable, Sequence

    from fatektool.client import Plc
    from fatektool.ladder.networks import Network
    from fatektool.project.program_file import ProgramFile

_LENGTHS_AND_SUM: Final = (101, 131, 134, 135)
"""The header's words of the code: its checksum, its length, the ends of main and sub units."""


class Sameness(StrEnum):
    """What is known of two programs."""

    SAME = "same"
    DIFFERENT = "different"
    UNKNOWN = "not compared"


@dataclass
class SameProgram:
    """The comparison, as far as it has gone.

    Args:
        plc: the PLC.
        file: the program on file.

    Attributes:
        pages: the pages that were compared.
        different: those of them that differ.
        reason: why nothing, or no more, is compared; None if there is no reason.
    """

    plc: Plc
    file: ProgramFile
    pages: list[int] = field(default_factory=list)
    different: list[int] = field(default_factory=list)
    reason: str | None = None

    def __post_init__(self) -> None:
        header = self.file.header
        self._header_pages = sorted({word // PAGE_WORDS for word in _LENGTHS_AND_SUM})
        if header.family != FBS:
            self._header_pages = []
        self._here = words_of_image(self.file.program.data, swapped=header.byte_order == SWAPPED)
        self._there: dict[int, bytes] = {}
        codec = self.plc.link.codec
        if Command.READ_PAGE not in codec.commands:
            self.reason = f"{codec.name} has no command that reads a program"

    @property
    def sameness(self) -> Sameness:
        """What is known so far."""
        if self.different:
            return Sameness.DIFFERENT
        return Sameness.SAME if self.pages else Sameness.UNKNOWN

    @property
    def is_certain(self) -> bool:
        """True if all that was to be compared is the same."""
        return self.sameness is Sameness.SAME and self.reason is None

    @property
    def has_sums(self) -> bool:
        """True if length and checksum of the whole code have been compared."""
        return bool(self._header_pages) and all(page in self._there for page in self._header_pages)

    def missing(self, networks: Iterable[Network]) -> list[int]:
        """The pages that are still to be compared for these networks, the header's first."""
        if self.reason is not None:
            return []
        wanted = dict.fromkeys(self._header_pages)
        for network in networks:
            wanted |= dict.fromkeys(pages_of(network))
        return [page for page in wanted if page not in self._there]

    def compare(self, pages: Sequence[int]) -> None:
        """Compare these pages too. One that seems to differ is read twice.

        Raises:
            LineError: the PLC answers nothing at all.
        """
        for page in pages:
            try:
                self._there[page] = self.plc.read_page(page)
                if page in self._differing():
                    self._there[page] = self.plc.read_page(page)
            except PlcRefused as refusal:
                self._there.pop(page, None)
                self.reason = f"the PLC refuses page {page} of its program (4F): {refusal.message}"
                break
            except NoAnswer as silence:
                self._there.pop(page, None)
                self._require_answers()
                self.reason = (
                    f"the PLC does not answer the request for page {page} of its program (4F): "
                    f"{silence.message}"
                )
                break
        self.pages, self.different = sorted(self._there), self._differing()

    def _require_answers(self) -> None:
        """Read the brief status: a PLC that answers this, and not 4F, can be monitored all the same.

        Raises:
            LineError: no answer to that, too.
        """
        with suppress(PlcRefused):
            self.plc.brief_status()

    def _differing(self) -> list[int]:
        """The pages that differ, in the order of bytes in which fewer do."""
        orders = [
            [page for page, data in sorted(self._there.items()) if not self._is_same(page, data, swapped)]
            for swapped in (False, True)
        ]
        return min(orders, key=len)

    def _is_same(self, page: int, data: bytes, swapped: bool) -> bool:
        first = page * PAGE_WORDS
        here = self._here[first : first + PAGE_WORDS]
        there = words_of_image(data, swapped=swapped)
        if page in self._header_pages:
            places = [word - first for word in _LENGTHS_AND_SUM if word // PAGE_WORDS == page]
            return [here[place] for place in places] == [there[place] for place in places]
        return here == there[: len(here)]


def pages_of(network: Network) -> range:
    """The pages that a network's words are in."""
    last = network.place + max(len(network.words), 1) - 1
    return range(network.place // PAGE_WORDS, last // PAGE_WORDS + 1)
