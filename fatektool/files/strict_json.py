"""JSON with one meaning: no key twice in an object, no NaN and no Infinity.

Of a key that is there twice some readers take the last, others the first: a file that two
readers understand in two ways is refused.
"""

from __future__ import annotations

import json
import reprlib
from typing import Any

from fatektool.files.plain_text import plain_text


def read_json(data: bytes) -> Any:
    """Read a document.

    Raises:
        ValueError: it is not JSON, is too deep, or has two meanings.
    """
    if not data.strip(b"\0\t\n\r "):
        raise ValueError("only NUL bytes, as after a power cut" if b"\0" in data else "the file is empty")
    try:
        return json.loads(plain_text(data), object_pairs_hook=_once_each, parse_constant=_no_number)
    except RecursionError as error:
        raise ValueError("too deep") from error


def _once_each(items: list[tuple[str, Any]]) -> dict[str, Any]:
    found: dict[str, Any] = {}
    for key, value in items:
        if key in found:
            raise ValueError(f"the key {reprlib.repr(key)} occurs twice")
        found[key] = value
    return found


def _no_number(text: str) -> float:
    raise ValueError(f"{text} is not JSON")
