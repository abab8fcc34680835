"""Where the code is in a program's image.

::

    fbs   byte 0200: main units, FFFF, sub units, FFFF; their lengths in words 131, 134 and 135
    FBE   byte 2800: main units, FFFF, sub units, FFFF; ends before the settings at 6700 (one file seen)

Words of the image have their low byte first.
"""

from __future__ import annotations

import struct
from typing import TYPE_CHECKING, Final

from fatektool.ladder.decode import end_of
from fatektool.ladder.networks import Code
from fatektool.program.headers.header import FBS, SWAPPED

if TYPE_CHECKING:
    from collections.abc import Sequence

    from fatektool.program.image import Program

CODE_WORD: Final = 256
_USED: Final = 131
_MAIN_END: Final = 134
_FBE: Final = slice(0x2800, 0x6700)


def code_of(program: Program) -> Code | None:
    """The code of a program; None if its form is not known, or the header is invalid."""
    header = program.header
    if header.family != FBS or not header.valid:
        return None
    return fbs_code(words_of_image(program.data, swapped=header.byte_order == SWAPPED))


def words_of_image(image: bytes, *, swapped: bool = False) -> tuple[int, ...]:
    """An image as words.

    Args:
        image: its bytes.
        swapped: the two bytes of each word are swapped.
    """
    return struct.unpack(f"{'>' if swapped else '<'}{len(image) // 2}H", image[: len(image) // 2 * 2])


def fbs_code(words: Sequence[int]) -> Code:
    """The code of an image of the FBs family with a valid header."""
    used, main_end = words[_USED], words[_MAIN_END] // 2
    after = CODE_WORD + used + 1
    main = words[CODE_WORD : min(main_end, after) - 1]
    return Code.of(main, words[CODE_WORD + len(main) + 1 : after], places=(CODE_WORD, main_end))


def fbe_code(image: bytes) -> Code:
    """The code of an FBE's image, which has no length: up to FFFF instead of an instruction."""
    words = words_of_image(image[_FBE])
    first = _FBE.start // 2
    main = end_of(words, 0)
    sub = end_of(words, main + 1)
    return Code.of(words[:main], words[main + 1 : sub], places=(first, first + main + 1))
