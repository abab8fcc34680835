"""The characters that a loopback test sends: patterns that are hard for a line.

::

    ramp        every character in turn, each text begins with the next one: all characters are tested
    random      from a seed
    alternate   0101… and 1010… in turn: as many edges as a byte can have
    ones        all ones: no edges for as long as possible, where a receiver loses the clock
"""

from __future__ import annotations

from enum import Enum
from random import Random
from typing import TYPE_CHECKING

if TYPE_CHECKING:
    from collections.abc import Iterator, Sequence


class Pattern(Enum):
    """The name that ``--pattern`` takes."""

    RAMP = "ramp"
    RANDOM = "random"
    ALTERNATE = "alternate"
    ONES = "ones"


def payloads(
    sizes: Sequence[int], patterns: Sequence[Pattern], characters: bytes, seed: int
) -> Iterator[bytes]:
    """Without end: all sizes with the first pattern, then with the next, then from the first again.

    Args:
        sizes: characters of each.
        patterns: which, in this order.
        characters: what may be sent, in rising order.
        seed: of the random pattern.
    """
    random = Random(seed)  # noqa: S311  # a test pattern, the same for the same seed
    start = 0
    while True:
        for pattern in patterns:
            for size in sizes:
                yield _payload(pattern, size, characters, start, random)
                start += 1


def _payload(pattern: Pattern, size: int, characters: bytes, start: int, random: Random) -> bytes:
    if pattern is Pattern.RANDOM:
        return bytes(random.choices(characters, k=size))
    if pattern is Pattern.RAMP:
        begin = start % len(characters)
        return (characters * (size // len(characters) + 2))[begin : begin + size]
    mask = 0xFF if characters[-1] > 0x7F else 0x7F
    if pattern is Pattern.ONES:
        return _nearest(mask, characters) * size
    one, other = _nearest(0x55, characters), _nearest(0xAA & mask, characters)
    pair = one + other if start % 2 else other + one
    return (pair * (size // 2 + 1))[:size]


def _nearest(wanted: int, characters: bytes) -> bytes:
    """The character, or the one with the fewest other bits if it may not be sent."""
    return bytes([min(characters, key=lambda character: (character ^ wanted).bit_count())])
