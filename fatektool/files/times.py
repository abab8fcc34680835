"""Times: UTC in documents and file names, local time on a screen."""

from __future__ import annotations

import time


def utc(seconds: float | None = None) -> str:
    """RFC 3339 to the second, ``2026-11-22T03:15:00Z``; the present by default."""
    return time.strftime("%Y-%m-%dT%H:%M:%SZ", time.gmtime(seconds))


def stamp(created: str) -> str:
    """The same for a file name: ``20261122T031500Z``."""
    return created.replace("-", "").replace(":", "")


def local_clock(created: str) -> str:
    """The same moment on this computer's clock, for a screen: ``04:15:00``."""
    return time.strftime("%H:%M:%S", time.localtime(_seconds(created)))


def local(created: str) -> str:
    """The same moment on this computer's clock, with its distance from UTC: ``2026-11-22 04:15:00 +0100``.

    What is no time of this form, and all of it where the clock is UTC, stays as it is.
    """
    try:
        here = time.localtime(_seconds(created))
    except (ValueError, OverflowError, OSError):
        return created
    return created if not here.tm_gmtoff else time.strftime("%Y-%m-%d %H:%M:%S %z", here)


def _seconds(created: str) -> int:
    from calendar import timegm  # which few commands need

    return timegm(time.strptime(created, "%Y-%m-%dT%H:%M:%SZ"))
