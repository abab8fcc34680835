"""How sure a thing is that is read from a program.

The vendor publishes nothing on how a program's words are made. What stands here was worked out from public
project files and from printouts of the vendor's program, and each row of a table carries its evidence::

    A   the vendor's program printed it so, or every file checked agrees
    B   read from use in one or a few files: comments, file names, number of operands
    C   a guess that fits
"""

from __future__ import annotations

from enum import StrEnum
from typing import TYPE_CHECKING

if TYPE_CHECKING:
    from collections.abc import Iterable


class Grade(StrEnum):
    """How sure: A is the vendor's own print, C a guess that fits."""

    A = "A"
    B = "B"
    C = "C"


def worst(grades: Iterable[Grade]) -> Grade:
    """The least sure of them; A if there are none."""
    return max(grades, default=Grade.A)
