"""Comparison of two programs: their pages, and their networks.

A project has only the image, in its own byte order: pages after the image are not compared, and if the other
program has the two bytes of each word swapped, they are put into the same order first. Two backups are
compared as they are.
"""

from __future__ import annotations

from dataclasses import dataclass
from typing import TYPE_CHECKING, Final

from fatektool.errors import DataError
from fatektool.ladder.differences import NetworkChange, compare_code, summary
from fatektool.ladder.image import code_of
from fatektool.program.compare import compare, compare_images
from fatektool.program.headers.header import PAGE_BYTES, PAGE_WORDS, swapped
from fatektool.program.image import Program

if TYPE_CHECKING:
    from collections.abc import Sequence

    from fatektool.ladder.networks import Code
    from fatektool.program.compare import Comparison
    from fatektool.project.program_file import ProgramFile


_ERASED: Final = b"\xff" * PAGE_BYTES


@dataclass(frozen=True)
class ProgramComparison:
    """The comparison of two programs.

    Attributes:
        a: the first, as compared.
        b: the second, as compared; None if it was not read.
        pages: the comparison of the pages.
        networks: the networks that differ; None if one of them has no mnemonics.
        code: the code of the second; None if there is none.
    """

    a: Program
    b: Program | None
    pages: Comparison
    networks: tuple[NetworkChange, ...] | None
    code: Code | None

    @property
    def same(self) -> bool:
        """True if all compared bytes are identical."""
        return self.pages.same

    @property
    def same_code(self) -> bool:
        """True if both have mnemonics, and they are identical."""
        return self.networks == ()

    @property
    def networks_summary(self) -> str | None:
        """``N0009 changed, N0031 added``, or ``same code``; None without mnemonics."""
        if self.networks is None:
            return None
        return summary(self.networks) or "same code"


def compare_programs(a: Program, b: Program) -> ProgramComparison:
    """Compare two programs as they are."""
    return compared(a, b, compare(a, b), code_of(a), code_of(b))


def compare_files(a: ProgramFile, b: ProgramFile) -> ProgramComparison:
    """Compare two programs from files, each a backup or a project."""
    if a.project is None and b.project is None:
        return compared(a.program, b.program, compare(a.program, b.program), a.code, b.code)
    here, there = a.program.pages[: a.page_count], b.program.pages[: b.page_count]
    more = a.project is not None and b.project is None and len(there) > len(here)
    if b.project is None:
        there = there[: len(here)]
    if a.project is None:
        here = here[: len(there)]
    one, other = program_of(trimmed(here, len(there))), program_of(trimmed(there, len(here)))
    return compared(*_side_by_side(one, in_order_of(one, other), more=more), a.code, b.code)


def compare_with_pages(a: ProgramFile, pages: Sequence[bytes]) -> ProgramComparison:
    """Compare a project with pages of a PLC: as many as its image has, or all that the PLC has."""
    other = program_of(pages)
    one = in_order_of(other, program_of(trimmed(a.program.pages[: a.page_count], len(pages))))
    return compared(*_side_by_side(one, other), a.code, code_of(other))


def _side_by_side(a: Program, b: Program, *, more: bool = False) -> tuple[Program, Program, Comparison]:
    return a, b, compare_images(a, a.ladder_words, b.pages, b_has_more=more)


def compared(
    a: Program, b: Program, pages: Comparison, code: Code | None, other: Code | None
) -> ProgramComparison:
    """A comparison of pages, with that of networks."""
    changes = None if code is None or other is None else compare_code(code, other)
    return ProgramComparison(a, b, pages, changes, other)


def program_of(pages: Sequence[bytes]) -> Program:
    """Pages as a program of exactly their size."""
    return Program((len(pages) - 1) * PAGE_WORDS, tuple(pages))


def trimmed(pages: Sequence[bytes], count: int) -> Sequence[bytes]:
    """Pages without erased ones at the end, down to ``count``: memory that a smaller PLC does not have."""
    end = len(pages)
    while end > count and pages[end - 1] == _ERASED:
        end -= 1
    return pages[:end]


def in_order_of(example: Program, program: Program) -> Program:
    """A program in the byte order of another, if both headers show it."""
    orders = example.header.byte_order, program.header.byte_order
    if None in orders or orders[0] == orders[1]:
        return program
    return Program(program.ladder_words, tuple(map(swapped, program.pages)))


def program_or_none(ladder_words: int, pages: Sequence[bytes]) -> Program | None:
    """Pages as a program; None if they are not a program."""
    try:
        return Program(ladder_words, tuple(pages))
    except DataError:
        return None
