"""Tests that are for some systems alone say so, with the reason."""

from __future__ import annotations

import os
import sys
import tempfile
from pathlib import Path

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


def windows(reason: str) -> pytest.MarkDecorator:
    """For Windows alone.

    Args:
        reason: what is there and not on POSIX systems.
    """
    return pytest.mark.skipif(sys.platform != "win32", reason=f"Windows alone: {reason}")


def _links_work() -> bool:
    """True if a user may make symbolic links here, and they are followed."""
    with tempfile.TemporaryDirectory() as folder:
        link, target = Path(folder) / "link", Path(folder) / "target"
        try:
            link.symlink_to(target)
            return link.is_symlink() and Path(os.path.realpath(link)) == Path(os.path.realpath(target))
        except OSError:
            return False


symbolic_links = pytest.mark.skipif(
    os.name == "nt" and not _links_work(),
    reason="no symbolic links: on Windows they need a privilege, and Wine does not follow them",
)
"""For systems with symbolic links."""
