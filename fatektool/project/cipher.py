"""Decryption of a project's memories, with a key found from the file itself.

Byte i is XORed with K[i mod 256] and k[i mod 5]; K and k differ from file to file. Erased memory is FF. So if
FF is the most frequent byte of the memory, the most frequent byte at each place is the key XOR FF. If much of
the memory is used, the words that every image has in its first four pages decide, FFFF in most of them::

    1  for each residue of i modulo 1280 (the period of both), the bytes are counted, known words with more
    weight 2  the same K[j] occurs with each of the five k: the most frequent difference in 1280 pairs is k 3
    with k removed, all bytes at the same place modulo 256 are counted for K

Only K XOR k matters, so k[0] is 0 here. The caller checks the key by the sums.
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
        memories: encrypted, each from the start of the key; the first one has the known bytes.
        known: place in the first memory -> the known byte, and its weight.
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
    """Decrypt, or encrypt, which is the same."""
    whole = (key * (len(data) // len(key) + 1))[: len(data)]
    return (int.from_bytes(data, "big") ^ int.from_bytes(whole, "big")).to_bytes(len(data), "big")


def _votes(memories: Sequence[bytes], residue: int) -> Counter[int]:
    found: Counter[int] = Counter()
    for memory in memories:
        found.update(memory[residue::PERIOD])
    return found


def _short_key(votes: Sequence[Counter[int]]) -> list[int]:
    """The five k, from the differences for the same K[j]."""
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
    """The most frequent value; of two the smaller, so that a file always has the same key."""
    return min(votes, key=lambda value: (-votes[value], value), default=_ERASED)
