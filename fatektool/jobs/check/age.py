"""Ages as a user writes and reads them: ``36h``, ``7d``."""

from __future__ import annotations

import re
from typing import Final

from fatektool.errors import UsageError

_AGE: Final = re.compile(r"(\d{1,9}(?:\.\d{1,3})?)([smhd])", re.ASCII)
_UNITS: Final = {"s": 1, "m": 60, "h": 3600, "d": 86400}


def parse_age(text: str) -> float:
    """Read ``36h``, ``90m``, ``7d`` or ``3600s``.

    Raises:
        UsageError: it is none.
    """
    match = _AGE.fullmatch(text.strip())
    if match is None:
        raise UsageError(f"--max-age {text!r}: expected a number and s, m, h or d, such as 36h")
    return float(match[1]) * _UNITS[match[2]]


def age_words(seconds: float) -> str:
    """An age in its largest whole unit: ``3 h``, ``2 d``."""
    for unit, size in reversed(_UNITS.items()):
        if seconds >= 2 * size or unit == "s":
            return f"{seconds / size:.0f} {unit}"
    raise AssertionError  # seconds fit always
