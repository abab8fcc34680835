"""A project's memories are enciphered; the key comes out of the file itself.

Byte i is XORed with K[i mod 256] and k[i mod 5]; K and k differ from file to file. Erased memory is FF, so at
each place the most frequent byte is the key XOR FF wherever FF is the most frequent byte of the memory. Where
much of it is in use, the words that every image has in its first four pages decide, FFFF in most of them::

    1  each residue of i modulo 1280 (the period of both) votes with its bytes, known words with more weight
    2  the same K[j] meets each of the five k: what their guesses differ by, voted by 1280 pairs, is k
    3  with k taken out, all bytes at the same place modulo 256 vote for K

Only K XOR k matters, so k[0] is 0 here. Whether the key is right is for the caller to prove, by the sums.
"""

from __future__ import annotations

from collections import Counter
from typing import TYPE_CHECKING, Final

if TYPE_CHECKING:
    from collections.abc import Mapping, Sequence

_LONG: Final = 256
_SHORT: Final = 5
PERIOD: Final = _LONG * _SHORT
_ERASED: Final = 0xFF


def solve(memories: Sequence[bytes], known: Mapping[int, tuple[int, int]]) -> bytes:
    """Find the key: a period of 1280 bytes.

    Args:
        memories: enciphered, each from the key's start; the first is the one with known bytes.
        known: place in the first memory -> the byte that is there, and how many votes that is worth.
    """
    votes = [_votes(memories, residue) for residue in range(PERIOD)]
    for place, (byte, weight) in known.items():
        if place < len(memories[0]):
            votes[place % PERIOD][memories[0][place] ^ byte ^ _ERASED] += weight
    short = _short_key(votes)
    key = bytearray(PERIOD)
    for place in range(_LONG):
        together: Counter[int] = Counter()
        residues = range(place, PERIOD, _LONG)
        for residue in residues:
            for byte, count in votes[residue].items():
                together[byte ^ short[residue % _SHORT]] += count
        long = _most(together) ^ _ERASED
        for residue in residues:
            key[residue] = long ^ short[residue % _SHORT]
    return bytes(key)


def decipher(data: bytes, key: bytes) -> bytes:
    """Take the key out; put it in, which is the same."""
    whole = (key * (len(data) // len(key) + 1))[: len(data)]
    return (int.from_bytes(data, "big") ^ int.from_bytes(whole, "big")).to_bytes(len(data), "big")


def _votes(memories: Sequence[bytes], residue: int) -> Counter[int]:
    found: Counter[int] = Counter()
    for memory in memories:
        found.update(memory[residue::PERIOD])
    return found


def _short_key(votes: Sequence[Counter[int]]) -> list[int]:
    """The five k, from what the guesses for the same K[j] differ by."""
    steps: list[Counter[int]] = [Counter() for _ in range(_SHORT)]
    sure = [max(each.values(), default=0) for each in votes]
    for residue in range(PERIOD):
        other = (residue + _LONG) % PERIOD  # the same K, and the next k
        difference = _most(votes[residue]) ^ _most(votes[other])
        steps[residue % _SHORT][difference] += min(sure[residue], sure[other])
    short = [0]
    for step in steps[:-1]:
        short.append(short[-1] ^ _most(step))
    return short


def _most(votes: Counter[int]) -> int:
    """The value with the most votes, of two the smaller, so that the same file always gives the same key."""
    return min(votes, key=lambda value: (-votes[value], value), default=_ERASED)
