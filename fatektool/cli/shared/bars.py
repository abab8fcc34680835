"""Bars of text, of the characters that the terminal can show: blocks, else ASCII."""

from __future__ import annotations

import sys
from typing import Final

from fatektool.ladder.drawing.text.letters import Letters

_LEVELS: Final = ("▁▂▃▄▅▆▇█", "_.-=+*#@")
_EIGHTHS: Final = "▏▎▍▌▋▊▉█"


def levels(encoding: str | None = None) -> str:
    """Eight characters for a small chart, the lowest first.

    Args:
        encoding: of the terminal; by default that of standard output.
    """
    blocks, plain = _LEVELS
    return blocks if _letters(encoding).has(blocks) else plain


def bar(eighths: int, encoding: str | None = None) -> str:
    """A bar of a length in eighths of a character, rounded up where there are no such characters.

    Args:
        eighths: at least 0.
        encoding: as for ``levels``.
    """
    whole, rest = divmod(eighths, 8)
    if _letters(encoding).has(_EIGHTHS):
        return _EIGHTHS[-1] * whole + (_EIGHTHS[rest - 1] if rest else "")
    return "#" * (whole + (rest > 0))


def _letters(encoding: str | None) -> Letters:
    out = getattr(sys.stdout, "rich_proxied_file", sys.stdout)  # rich's has no encoding
    return Letters(encoding or out.encoding or "ascii")
