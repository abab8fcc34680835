"""The program image of an FBs, as in project files: a header of four pages, code, labels, ROR.

::

    page 0       46 42 53 34 30 30 30 33 FF ..     FBS4 and four digits
    page 1-3     sums, sizes and addresses, settings, 55 AA 00 FF at the end
    page 4 ..    code: main units, FFFF, sub units; then FF
    byte A7FE    labels, downwards; none here
    byte A800    ROR registers

A word has its low byte first; ``swapped`` swaps the bytes, because their order on the line is not known. How
much of the image a real unit returns with 4F is not known either.
"""

from __future__ import annotations

import struct
from dataclasses import dataclass
from random import Random

from fatektool.simulator.program.fbs_code import random_code

PAGE_WORDS = 64
CODE = 256
_ERASED = 0xFFFF
_ROR = 0xA800 // 2
_ROR_WORDS = 12


@dataclass(frozen=True, slots=True)
class FbsImage:
    """The program image of a model.

    Args:
        digits: after ``FBS4`` in the header.
        capacity: space for code, in words.
        pages: the number of pages that can be read; further pages are refused.
    """

    digits: str
    capacity: int
    pages: int


def fbs_program(
    image: FbsImage, pages: int, *, seed: int = 1, code: list[int] | None = None, swapped: bool = False
) -> list[bytes]:
    """The pages of a program.

    Args:
        image: of the model.
        pages: their number.
        seed: varies the code.
        code: words of the main units, instead of random ones.
        swapped: swap the two bytes of each word.
    """
    random = Random(f"fbs {seed} {image.capacity}")  # noqa: S311 - a repeatable pattern is wanted
    capacity = min(image.capacity, pages * PAGE_WORDS - CODE)
    if capacity < 1:
        raise ValueError(f"an FBs program has {CODE // PAGE_WORDS} pages of header and one more, not {pages}")
    if code is None:
        code = random_code(random, (capacity - 1) // 5)
    words = [_ERASED] * max(pages * PAGE_WORDS, _ROR + _ROR_WORDS)
    words[CODE : CODE + len(code)] = code
    words[_ROR : _ROR + _ROR_WORDS] = [random.randrange(1000) for _ in range(_ROR_WORDS)]
    _fill_header(words, image.digits, capacity, len(code), random)
    data = struct.pack(f"{'>' if swapped else '<'}{pages * PAGE_WORDS}H", *words[: pages * PAGE_WORDS])
    return [data[at : at + 2 * PAGE_WORDS] for at in range(0, len(data), 2 * PAGE_WORDS)]


def _fill_header(words: list[int], digits: str, capacity: int, used: int, random: Random) -> None:
    signature = ("FBS4" + digits).encode("ascii")
    for place in range(4):
        words[place] = int.from_bytes(signature[2 * place : 2 * place + 2], "little")
    words[64] = 0x6944
    words[128:130] = [0x0143, 0x0040]
    words[130] = capacity
    words[131] = used
    words[132] = capacity - 1 - used
    words[133] = 2 * CODE
    words[134] = words[135] = 2 * CODE + 2 * (used + 1)
    words[138] = 0xA800
    words[139:141] = [0xA800, 0xBFFF]
    words[141] = words[143] = 0xC000
    words[237:239] = [random.randrange(0x100), random.randrange(0x100)]
    words[239] = _ROR_WORDS
    words[254:256] = [0xAA55, 0xFF00]
    words[100] = sum(words[104:256]) & 0xFFFF
    words[101] = sum(words[CODE : CODE + used + 1]) & 0xFFFF
    words[102] = _ERASED
    words[103] = sum(words[_ROR : _ROR + _ROR_WORDS]) & 0xFFFF
