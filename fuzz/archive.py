"""Backup files: read, and either right to the last byte or refused in one plain line."""

from __future__ import annotations

from fatektool.errors import DataError
from fatektool.program.archive import Backup
from fuzz.documents import json_of
from fuzz.words import require_plain
from tests.program.samples import document, program

GOOD = document(program(64))


def one_input(data: bytes) -> None:
    """Read; what is taken is written, read again and the same."""
    try:
        found = Backup.parse(json_of(GOOD, data), "press.json")
    except DataError as error:
        require_plain(error)
        return
    assert Backup.parse(found.to_bytes()) == found
