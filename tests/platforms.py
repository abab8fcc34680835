"""Tests that are for some systems alone say so, with the reason."""

from __future__ import annotations

import os
import sys

import pytest


def under_wine() -> bool:
    """True in a Python of Windows that runs under Wine."""
    if sys.platform != "win32":
        return False
    import ctypes

    return hasattr(ctypes.windll.ntdll, "wine_get_version")


def posix(reason: str) -> pytest.MarkDecorator:
    """For POSIX systems alone.

    Args:
        reason: what is there and not on Windows: ``fork``, modes of files.
    """
    return pytest.mark.skipif(os.name != "posix", reason=f"POSIX alone: {reason}")


def not_in_wine(reason: str) -> pytest.MarkDecorator:
    """For all systems, but Wine does it otherwise than Windows.

    Args:
        reason: what it does.
    """
    return pytest.mark.skipif(under_wine(), reason=f"not in Wine: {reason}")
