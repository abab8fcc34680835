"""Append a PLC to an inventory. The existing bytes of the file do not change."""

from __future__ import annotations

import json
import re
from typing import TYPE_CHECKING, Any, Final

from fatektool.errors import UsageError
from fatektool.inventory.entries import parse_inventory

if TYPE_CHECKING:
    from collections.abc import Mapping
    from pathlib import Path

_BARE: Final = re.compile(r"[A-Za-z0-9_-]+", re.ASCII)


def with_plc(data: bytes, file: Path, name: str, values: Mapping[str, Any]) -> bytes:
    """The bytes of the file with a new table ``[plc.NAME]`` at the end.

    Args:
        data: the bytes of the file; empty for a new file.
        file: the file, for messages.
        name: the name of the PLC.
        values: its keys with TOML values: strings, numbers, lists of strings.

    Raises:
        UsageError: the name exists already, or a value is not valid.
        DataError: the file has faults.
    """
    before = parse_inventory(data, file)
    before.require_whole()
    if name in before.plcs:
        raise UsageError(f"{name!r} is already in the inventory {file}", hint="choose another name")
    end = "\r\n" if b"\r\n" in data else "\n"
    gap = "" if not data else end if data.endswith(b"\n") else 2 * end
    lines = [f"[plc.{name if _BARE.fullmatch(name) else json.dumps(name, ensure_ascii=False)}]"]
    lines += [f"{key} = {json.dumps(value, ensure_ascii=False)}" for key, value in values.items()]
    made = data + (gap + end.join(lines) + end).encode()
    after = parse_inventory(made, file)
    if after.faults:
        raise UsageError(f"{name!r} cannot be added: {after.faults[0].message}")
    return made
