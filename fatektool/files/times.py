"""Times: UTC in documents and file names, local time on a screen."""

from __future__ import annotations

import re
import time
from typing import Final

_UTC: Final = re.compile(r"\d{4}-\d\d-\d\dT\d\d:\d\d:\d\d(\.\d+)?(Z|[+-]00:00)", re.ASCII)


def utc(seconds: float | None = None) -> str:
    """RFC 3339 to the second, ``2026-11-22T03:15:00Z``; the present by default."""
    return time.strftime("%Y-%m-%dT%H:%M:%SZ", time.gmtime(seconds))


def is_utc(text: str) -> bool:
    """True for a time in UTC as RFC 3339 has it, also with a fraction, or ``+00:00`` for ``Z``."""
    from datetime import datetime  # which few commands need

    try:
        return bool(_UTC.fullmatch(text) and datetime.fromisoformat(text))
    except ValueError:  # month 13
        return False


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
