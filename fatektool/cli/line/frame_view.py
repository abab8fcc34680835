"""Frames and bytes for people."""

from __future__ import annotations

from typing import TYPE_CHECKING

if TYPE_CHECKING:
    from collections.abc import Iterator

    from fatektool.protocol.explain import Explanation


def field_lines(explanation: Explanation, *, binary: bool) -> Iterator[str]:
    """The fields, one a line, and what is wrong; ``binary`` shows bytes as hex."""
    for field in explanation.fields:
        shown = field.raw.hex(" ").upper() if binary else characters(field.raw)
        cut = shown if len(shown) <= 24 else f"{shown[:20]}… ({len(field.raw)})"
        yield f"  {field.name:<16}  {cut:<24}  {field.meaning}".rstrip()
    if explanation.fault:
        yield f"  fault: {explanation.fault}"


def printable(data: bytes) -> str:
    """Bytes as a text of the same length, with a dot for each that is not printable."""
    return "".join(chr(byte) if 0x20 <= byte < 0x7F else "." for byte in data)


def characters(raw: bytes) -> str:
    """Bytes as the characters they are, others as <hex>."""
    return "".join(chr(byte) if 0x20 < byte < 0x7F else f"<{byte:02X}>" for byte in raw)
