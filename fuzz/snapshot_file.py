"""Snapshot files: read, and either written back unchanged or refused in one plain line."""

from __future__ import annotations

from fatektool.errors import DataError
from fatektool.jobs.snapshots.snapshot import parse_snapshot, raw_of
from fuzz.documents import json_of
from fuzz.words import require_plain
from tests.plant import snapshot_of

GOOD = snapshot_of("R0-R1", "DR4:f32", "X3", "M0:16", "D7:i16").document()


def one_input(data: bytes) -> None:
    """Read; every element that is taken has bits that fit it."""
    try:
        found = parse_snapshot(json_of(GOOD, data), "a.json")
    except DataError as error:
        require_plain(error)
        return
    for element, raw in raw_of(found).values():
        assert raw is None or 0 <= raw < 1 << element.kind.bits
