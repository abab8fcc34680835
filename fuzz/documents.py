"""Documents that are nearly right: a good one, and bytes that say where to spoil it and with what.

Plain bytes hardly ever get past a hash or a schema; these do.
"""

from __future__ import annotations

import copy
import json
from typing import Any

VALUES: list[Any] = [
    None,
    True,
    False,
    0,
    1,
    -1,
    254,
    65535,
    65536,
    1 << 64,
    10**400,
    0.5,
    -0.0,
    1e308,
    float("inf"),
    float("nan"),
    "",
    "0",
    "R0",
    "DR1",
    "../x",
    "$(id)",
    "a\nb",
    "\x1b[2J",
    "\ud800",
    "\u0660",
    "F" * 256,
    [],
    {},
    [[]],
    {"": 0},
]
MOST_CHANGES = 6


class _Choices:
    """Bytes as a row of choices; 0 when they run out."""

    def __init__(self, data: bytes) -> None:
        self._left = iter(data)
        self.more = bool(data)

    def below(self, count: int) -> int:
        byte = next(self._left, None)
        self.more = byte is not None
        return (byte or 0) % count


def spoiled(good: Any, data: bytes) -> Any:
    """A copy of a document, changed where and how the bytes say."""
    choices = _Choices(data)
    root = [copy.deepcopy(good)]
    for _ in range(MOST_CHANGES):
        if not choices.more:
            break
        _spoil(root, 0, choices)
    return root[0]


def _spoil(parent: Any, key: Any, choices: _Choices) -> None:
    value = parent[key]
    inside = (
        list(value) if isinstance(value, dict) else list(range(len(value))) if type(value) is list else []
    )
    place = choices.below(len(inside) + 1)
    if place < len(inside):
        _spoil(value, inside[place], choices)
        return
    what = choices.below(len(VALUES) + 3)
    if what < len(VALUES):
        parent[key] = copy.deepcopy(VALUES[what])
    elif what == len(VALUES) and isinstance(parent, dict):
        del parent[key]
    elif isinstance(value, str) and value:
        at = choices.below(len(value))
        parent[key] = value[:at] + chr(choices.below(256)) + value[at + 1 :]
    elif isinstance(value, dict):
        value[str(VALUES[choices.below(len(VALUES))])] = 0


def json_of(good: Any, data: bytes) -> bytes:
    """The bytes as they are; behind a zero byte, ``good`` as JSON, spoiled by the rest."""
    if data[:1] != b"\0":
        return data
    return json.dumps(spoiled(good, data[1:])).encode()
