"""Counts and times in words."""

from __future__ import annotations

from typing import Final

_SHORT_S: Final = 90


def counted(count: int, noun: str, plural: str = "") -> str:
    """A count with its noun: ``1 page``, ``2 pages``, ``3 tries``.

    Args:
        count: how many.
        noun: the singular; "other request" and the like are nouns too.
        plural: empty for the singular with an s.
    """
    return f"{count} {noun if count == 1 else plural or f'{noun}s'}"


def spent(seconds: float) -> str:
    """How long something takes: ``under 1 s``, ``57 s``, ``4 min``."""
    if seconds < 1:
        return "under 1 s"
    return f"{seconds:.0f} s" if seconds < _SHORT_S else f"{seconds / 60:.0f} min"
