"""A callback that does nothing."""

from __future__ import annotations


def ignore(*_: object) -> None:
    """Do nothing."""
