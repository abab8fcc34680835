"""TOML in bounded time: no key of more parts than anybody writes, no nesting too deep to read.

tomllib's time grows with the square of a dotted key's parts: 200 kB of ``a.a.a…`` take it ten seconds.
"""

from __future__ import annotations

import re
from typing import Any, Final

MOST_PARTS: Final = 8
_LONG_KEY: Final = re.compile(
    rf"""(?<![\w-])(?:(?:[\w-]++|"[^"\n]*+"|'[^'\n]*+')[ \t]*+\.[ \t]*+){{{MOST_PARTS}}}"""
)


def read_toml(text: str) -> dict[str, Any]:
    """Read a document.

    Raises:
        ValueError: it is none, it is too deep, or a key has too many parts.
    """
    import tomllib

    if _LONG_KEY.search(text):
        raise ValueError(f"a key of more than {MOST_PARTS} parts")
    try:
        return tomllib.loads(text)
    except RecursionError as error:
        raise ValueError("too deep") from error
