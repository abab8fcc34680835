"""Words and their text, from the two lists beside this file."""

from __future__ import annotations

from pathlib import Path
from typing import NamedTuple


class Vector(NamedTuple):
    words: tuple[int, ...]
    text: str


def _vectors(name: str) -> list[Vector]:
    lines = (Path(__file__).parent / name).read_text("utf-8").splitlines()
    return [
        Vector(tuple(int(word, 16) for word in line[:50].split()), line[50:].strip())
        for line in lines
        if not line.startswith("#")
    ]


PRINTED = _vectors("printed.txt")
READ = _vectors("read.txt")
