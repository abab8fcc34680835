"""Text in registers: two characters of one byte in each, the first in its low or in its high byte.

A text ends at the first character 0. Bytes are Latin-1, so that each is a character and the other way round.
"""

from __future__ import annotations

from typing import TYPE_CHECKING, Literal

from fatektool.errors import UsageError

if TYPE_CHECKING:
    from collections.abc import Iterable, Sequence

Order = Literal["little", "big"]
"""Which byte of a register has the first character: ``little`` for the low one."""


def characters(raw: int, bits: int, order: Order) -> str:
    """The characters in one element, without zeros at the end."""
    return raw.to_bytes(bits // 8, order).rstrip(b"\0").decode("latin-1")


def text_of(words: Iterable[tuple[int, int]], order: Order) -> str:
    """The text in several elements.

    Args:
        words: the raw bits of each and its width.
        order: of the characters in one.
    """
    data = b"".join(raw.to_bytes(bits // 8, order) for raw, bits in words)
    return data.partition(b"\0")[0].decode("latin-1")


def text_bits(text: str, bits: int, order: Order) -> int:
    """A text as the bits of one element, the rest 0.

    Raises:
        UsageError: too many, or one that has no byte.
    """
    _require_room(text, bits)
    try:
        data = text.encode("latin-1")
    except UnicodeEncodeError:
        raise UsageError(f"text {text!r}: expected characters of Latin-1, one byte each") from None
    return int.from_bytes(data.ljust(bits // 8, b"\0"), order)


def divided(text: str, widths: Sequence[int]) -> list[str]:
    """A text divided among elements of these widths, in bits; what is left over is empty.

    Raises:
        UsageError: it is too long.
    """
    _require_room(text, sum(widths))
    parts, at = [], 0
    for bits in widths:
        parts.append(text[at : at + bits // 8])
        at += bits // 8
    return parts


def _require_room(text: str, bits: int) -> None:
    if len(text) > bits // 8:
        raise UsageError(f"text {text!r:.60}: expected at most {bits // 8} characters, got {len(text)}")
