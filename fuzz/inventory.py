"""Inventories: PLCs and faults, never an exception, and no name that could be a path or a word of a shell."""

from __future__ import annotations

import re
from pathlib import Path

from fatektool.errors import DataError
from fatektool.inventory.entries import parse_inventory
from fuzz.words import require_plain

NAME = re.compile(r"\w[\w.-]*")


def one_input(data: bytes) -> None:
    """Read; the PLCs that are taken have names to make files of."""
    found = parse_inventory(data, Path("fatek.toml"))
    for name, entry in found.plcs.items():
        assert NAME.fullmatch(name)
        assert ".." not in Path(f"{name}.json").parts
        assert entry.address.station in entry.address.codec.stations
        assert entry.address.timeout_s > 0
    assert all(fault.line is None or fault.line >= 1 for fault in found.faults)
    try:
        found.require_whole()
    except DataError as error:
        require_plain(error)
