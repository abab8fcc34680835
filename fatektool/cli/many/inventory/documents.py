"""The JSON documents of ``inventory``."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

from fatektool.address import CHECKS

if TYPE_CHECKING:
    from collections.abc import Iterable
    from pathlib import Path

    from fatektool.inventory.entries import Inventory, PlcEntry


def check_document(path: Path, found: Inventory) -> dict[str, Any]:
    """``fatektool.inventory-check/1``."""
    return {
        "schema": "fatektool.inventory-check/1",
        "file": str(path),
        "plcs": len(found.plcs),
        "faults": [{"line": fault.line, "message": fault.message} for fault in found.faults],
    }


def inventory_document(found: Inventory, entries: Iterable[PlcEntry]) -> dict[str, Any]:
    """``fatektool.inventory/1`` of some of its PLCs."""
    return {
        "schema": "fatektool.inventory/1",
        "file": str(found.file),
        "backups": None if found.backups is None else str(found.backups),
        "history": None if found.history is None else str(found.history),
        "plcs": [_entry_document(entry) for entry in entries],
    }


def add_document(path: Path, added: Iterable[str]) -> dict[str, Any]:
    """``fatektool.inventory-add/1``: the names that were added."""
    return {"schema": "fatektool.inventory-add/1", "file": str(path), "added": list(added)}


def _entry_document(entry: PlcEntry) -> dict[str, Any]:
    return {
        "name": entry.name,
        **{key: getattr(entry.address, key) for key in CHECKS},
        "format": entry.address.line_settings.format,
        "tags": list(entry.tags),
        "spec": None if entry.spec is None else str(entry.spec),
        "reference": None if entry.reference is None else str(entry.reference),
        "project": None if entry.project is None else str(entry.project),
        "modbus_map": entry.modbus_map,
        "expect": entry.expect,
        "keep": list(entry.keep),
    }
