"""How much damage an 8-bit checksum lets through: pages that answers brought, spoiled by the thousand.

The damages::

    bit errors    each byte of the answer with a probability: one of its low 7 bits is wrong
    hex burst     a run of digits gives way to random digits, as where two answers mix
    byte burst    a run of bytes gives way to random ones

A damaged answer *passes* if the client's decoder takes it for a frame and its data for a page. It is *seen by
parity* if a byte of it has an odd number of wrong bits, which a receiver that checks parity (7E1) sees.
"""

from __future__ import annotations

from dataclasses import dataclass
from random import Random
from typing import TYPE_CHECKING

from fatektool.errors import FrameError, PlcRefused
from fatektool.protocol.commands import ReadPage
from fatektool.protocol.fatek.facon.codec import FACON
from tests.protocol.decoding import framed, frames

if TYPE_CHECKING:
    from collections.abc import Callable

    Damage = Callable[[bytes, Random], bytes]

DIGITS = b"0123456789ABCDEF"
PAGE = ReadPage(0)


def bit_errors(share: float) -> Damage:
    """One wrong bit in a byte, with this probability for each byte."""

    def damage(answer: bytes, random: Random) -> bytes:
        spoiled = bytearray(answer)
        for at in range(len(spoiled)):
            if random.random() < share:
                spoiled[at] ^= 1 << random.randrange(7)
        return bytes(spoiled)

    return damage


def burst(alphabet: bytes, longest: int) -> Damage:
    """A run of 2 bytes or more, anywhere between STX and ETX, becomes random bytes of the alphabet."""

    def damage(answer: bytes, random: Random) -> bytes:
        length = random.randint(2, longest)
        at = random.randrange(1, len(answer) - length)
        return answer[:at] + bytes(random.choices(alphabet, k=length)) + answer[at + length :]

    return damage


DAMAGES: dict[str, Damage] = {
    "bit errors, 1 in 1000": bit_errors(0.001),
    "bit errors, 1 in 200": bit_errors(0.005),
    "bit errors, 1 in 50": bit_errors(0.02),
    "hex burst, 2 to 64": burst(DIGITS, 64),
    "byte burst, 2 to 8": burst(bytes(range(256)), 8),
}


@dataclass
class Count:
    """What became of the answers.

    Attributes:
        damaged: answers that were spoiled.
        passed: of those, taken for a page, a wrong one.
        passed_twice: pages of which two damaged answers passed, one in each pass.
        same_twice: of those, with the same wrong page: what two passes would believe.
        unseen_by_parity: of those that passed, the ones that a receiver with parity would not have seen.
    """

    damaged: int = 0
    passed: int = 0
    passed_twice: int = 0
    same_twice: int = 0
    unseen_by_parity: int = 0


def count(damage: Damage, answers: int, seed: int) -> Count:
    """Spoil so many answers, in pairs: the first and the second pass over one page."""
    random = Random(seed)  # noqa: S311  # the same each time
    found = Count()
    while found.damaged < answers:
        page = random.randbytes(128)
        answer = framed(b"014F0" + page.hex().upper().encode())
        read = [_read(damage(answer, random), answer, page, found) for _ in range(2)]
        if None not in read:
            found.passed_twice += 1
            found.same_twice += read[0] == read[1]
    return found


def _read(spoiled: bytes, answer: bytes, page: bytes, found: Count) -> bytes | None:
    """The wrong page that this answer brings; None if it is refused, or right."""
    if spoiled == answer:
        return None
    found.damaged += 1
    for frame in frames([spoiled]):
        if (frame.station, frame.command) != (1, PAGE.command):
            continue
        try:
            read = FACON.parse_answer(PAGE, frame)
        except (FrameError, PlcRefused):
            continue
        if read != page:
            found.passed += 1
            pairs = zip(spoiled, answer, strict=False)
            found.unseen_by_parity += all((a ^ b).bit_count() % 2 == 0 for a, b in pairs)
            return read
    return None
