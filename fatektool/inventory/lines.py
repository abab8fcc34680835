"""The line of each key in a TOML document, which tomllib does not give.

tomllib has read the document before, so it is valid. Only what separates statements matters here: strings,
comments, brackets, line ends.
"""

from __future__ import annotations

import re
import tomllib
from typing import TYPE_CHECKING, Any, Final

if TYPE_CHECKING:
    from collections.abc import Iterator

_TOKEN: Final = re.compile(
    r'"""(?:\\.|[^\\])*?"{3,5}'  # strings of many lines
    r"|'''.*?'{3,5}"
    r'|"(?:\\.|[^"\\\n])*"'  # strings of one line
    r"|'[^'\n]*'"
    r"|#[^\n]*|\n|[\[\]{}]|[^\"'#\n\[\]{}]+",
    re.DOTALL,
)
_KEY: Final = re.compile(r"""(?:"(?:\\.|[^"\\])*"|'[^']*'|[^="'])+(?==)""", re.DOTALL)
_HEADER: Final = re.compile(r"^\[+[ \t]*|[ \t]*\]+$")

KeyPath = tuple[str, ...]


def key_lines(text: str) -> dict[KeyPath, int]:
    """The line of each table and key, by its full path: ``("plc", "press", "target")``.

    Keys in an inline table are not included.

    Args:
        text: a valid TOML document.
    """
    found: dict[KeyPath, int] = {}
    table: KeyPath = ()
    for line, statement in _statements(text):
        key = _KEY.match(statement)
        if statement.startswith("["):
            table = path = _path(_HEADER.sub("", statement))
        elif key is not None:
            path = table + _path(key[0])
        else:
            continue
        for end in range(1, len(path) + 1):  # a.b = 1 begins the table a, too
            found.setdefault(path[:end], line)
    return found


def line_of(lines: dict[KeyPath, int], *path: str) -> int | None:
    """The line of a key, or of the innermost table around it that has a line; None if there is none."""
    while path:
        if path in lines:
            return lines[path]
        path = path[:-1]
    return None


def _statements(text: str) -> Iterator[tuple[int, str]]:
    """Each table header and each key with its value: its first line, and its text without comments."""
    depth, line, began, parts = 0, 1, 1, list[str]()
    for piece in _TOKEN.findall(text + "\n"):
        if piece == "\n" and depth == 0:
            statement = "".join(parts).strip()
            if statement:
                yield began, statement
            parts = []
        elif not piece.startswith("#") and (parts or piece.strip()):
            if not parts:
                began = line
            depth += {"[": 1, "{": 1, "]": -1, "}": -1}.get(piece, 0)
            parts.append(piece)
        line += piece.count("\n")


def _path(key: str) -> KeyPath:
    """The parts of a dotted key; tomllib parses it."""
    found: Any = tomllib.loads(f"{key} = 0")
    path: KeyPath = ()
    while isinstance(found, dict):
        ((name, found),) = found.items()
        path += (name,)
    return path
