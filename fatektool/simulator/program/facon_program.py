"""A demonstration program: pages like those of a ladder program, the same for the same seed.

::

    page 0   46 42 33 30 hi lo FF .. FF    'F' 'B' two digits, ladder size in words, rest FF
    page 1   code ...
    ...      code ...                      about three quarters of the ladder is used
    page N   FF .. FF                      unused memory is FF; N = words / 64, rounded up

The content is not FATEK instruction code, which no public paper describes. It has what is needed for tests:
no two equal pages, 00 and FF bytes inside, empty pages at the end, and a last page that may belong only
partly to the ladder (FACON paper, section 4.2, command 4F).
"""

from __future__ import annotations

from random import Random

from fatektool.simulator.models import MAX_LADDER_WORDS, PAGE_BYTES

_SIGNATURES = ("FB", "FM")
_CONTACTS = bytes((0x00, 0x10, 0x11, 0x12, 0x20, 0x28, 0x40, 0x48, 0x80, 0xA0, 0xC1, 0xFF))


def header_page(ladder_words: int, *, signature: str = "FB", digits: str = "30") -> bytes:
    """Page 0 of a program of ``ladder_words``."""
    if signature not in _SIGNATURES or len(digits) != 2 or not digits.isdecimal():
        raise ValueError(f"a header begins with FB or FM and two digits, not {signature + digits!r}")
    start = (signature + digits).encode("ascii") + ladder_words.to_bytes(2, "big")
    return start.ljust(PAGE_BYTES, b"\xff")


def demonstration_program(
    ladder_words: int, *, seed: int = 1, signature: str = "FB", digits: str = "30"
) -> list[bytes]:
    """Pages 0..N of a program for a ladder of 1 to 65535 words."""
    if not 1 <= ladder_words <= MAX_LADDER_WORDS:
        raise ValueError(f"a ladder has 1 to {MAX_LADDER_WORDS} words, not {ladder_words}")
    random = Random(f"ladder {seed} {ladder_words}")  # noqa: S311 - a repeatable pattern is wanted
    used = max(1, ladder_words * 3 // 4)
    code = bytearray()
    network = 0
    while len(code) < 2 * used:
        code += (0x8000 | network & 0x0FFF).to_bytes(2, "big")
        for _ in range(random.randrange(2, 12)):
            code += bytes((random.choice(_CONTACTS), random.randrange(256)))
        network += 1
    del code[2 * used :]
    pages = -(-ladder_words // (PAGE_BYTES // 2))
    image = bytes(code).ljust(pages * PAGE_BYTES, b"\xff")
    header = header_page(ladder_words, signature=signature, digits=digits)
    return [header, *(image[at : at + PAGE_BYTES] for at in range(0, len(image), PAGE_BYTES))]
