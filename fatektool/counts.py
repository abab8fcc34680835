"""A count with its noun, in the singular or the plural."""

from __future__ import annotations


def counted(count: int, noun: str, plural: str = "") -> str:
    """``1 page``, ``2 pages``, ``3 tries``.

    Args:
        count: how many.
        noun: the singular; "other request" and the like are nouns too.
        plural: empty for the singular with an s.
    """
    return f"{count} {noun if count == 1 else plural or f'{noun}s'}"
