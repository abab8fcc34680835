"""Times as documents and file names have them: UTC."""

from __future__ import annotations

import time


def utc(seconds: float | None = None) -> str:
    """RFC 3339 to the second, ``2026-11-22T03:15:00Z``; the present by default."""
    return time.strftime("%Y-%m-%dT%H:%M:%SZ", time.gmtime(seconds))


def stamp(created: str) -> str:
    """The same for a file name: ``20261122T031500Z``."""
    return created.replace("-", "").replace(":", "")
