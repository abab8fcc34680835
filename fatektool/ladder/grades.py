"""The certainty of what is read from a program.

The vendor publishes nothing about the words of a program. The tables here were derived from public project
files and from printouts of the vendor's software, and each row has its evidence::

    A   printed by the vendor's software, or all checked files agree
    B   found from its use in one or a few files: comments, file names, number of operands
    C   assumed, without contradiction
"""

from __future__ import annotations

from enum import StrEnum
from typing import TYPE_CHECKING

if TYPE_CHECKING:
    from collections.abc import Iterable


class Grade(StrEnum):
    """The certainty: A is the vendor's own print, C is assumed."""

    A = "A"
    B = "B"
    C = "C"


def worst(grades: Iterable[Grade]) -> Grade:
    """The least certain of them; A if there are none."""
    return max(grades, default=Grade.A)
