"""The phone number that a PLC's modem dials: R4140 to R4145 and back.

Six words, one character in each nibble, the low nibble of a word first (FBs link paper, section 13.1,
modem)::

    02-28082192     R4140=8220H R4141=1280H R4142=0E29H      0 2 2 8 · 0 8 2 1 · 9 2 E
    nibbles of 8220H from the low end: 0 2 2 8

    0 to 9    the digit              as text: itself
    A         pause                  ,
    B         hash                   #
    C         star                   *
    E         the end                -

The paper gives D and F no meaning. The PLC ignores what follows the end.
"""

from __future__ import annotations

import re
from typing import TYPE_CHECKING, Final

from fatektool.errors import DataError, UsageError

if TYPE_CHECKING:
    from collections.abc import Sequence

PHONE_WORDS: Final = 6
"""R4140 to R4145."""
MAX_PHONE: Final = 4 * PHONE_WORDS - 1
"""The longest number; the end needs one nibble too."""

_WRITTEN: Final = "0123456789,#*"
_END: Final = 0xE
_GROUPING: Final = re.compile(r"[ ()./-]")


def parse_phone_number(words: Sequence[int]) -> str:
    """The number in the registers.

    Args:
        words: R4140 to R4145, unsigned.

    Returns:
        Digits, ``,`` for a pause, ``#`` and ``*``; empty if the first nibble ends it.

    Raises:
        DataError: an invalid nibble, or no end.
    """
    number = ""
    for place in range(4 * len(words)):
        nibble = words[place // 4] >> 4 * (place % 4) & 0xF
        if nibble == _END:
            return number
        if nibble >= len(_WRITTEN):
            raise DataError(
                f"no phone number: nibble {place + 1}: expected a digit, A (pause), B (#), C (*) or E (end), "
                f"got {nibble:X}",
            )
        number += _WRITTEN[nibble]
    raise DataError(f"no phone number: no end (nibble E) in {4 * len(words)} nibbles")


def phone_number_words(number: str) -> tuple[int, ...]:
    """A phone number as the six words R4140 to R4145.

    Args:
        number: digits, ``,`` for a pause of about 2 s, ``#`` and ``*``. Spaces, ``-().`` and ``/`` between
            them are ignored.

    Raises:
        UsageError: another character, an empty number, or more than 23 characters.
    """
    written = _GROUPING.sub("", number)
    strange = next((character for character in written if character not in _WRITTEN), None)
    if strange is not None:
        raise UsageError(
            f"phone number {number!r:.60}: expected digits, ',' for a pause, '#' and '*', got {strange!r}"
        )
    if not 1 <= len(written) <= MAX_PHONE:
        raise UsageError(
            f"phone number {number!r:.60}: expected 1 to {MAX_PHONE} characters, got {len(written)}"
        )
    nibbles = [*map(_WRITTEN.index, written), _END]
    nibbles += [0] * (4 * PHONE_WORDS - len(nibbles))
    return tuple(
        sum(nibble << 4 * place for place, nibble in enumerate(nibbles[start : start + 4]))
        for start in range(0, len(nibbles), 4)
    )
