"""The callback of a caller who wants to be told nothing."""

from __future__ import annotations


def ignore(*_: object) -> None:
    """Do nothing with what is told."""
