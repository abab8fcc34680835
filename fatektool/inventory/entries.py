"""From TOML to PLCs, and every fault with its line.

A value in ``[plc.NAME]`` overrides that in ``[defaults]``, and this the built-in default.
"""

from __future__ import annotations

import re
from dataclasses import dataclass, field
from difflib import get_close_matches
from pathlib import Path
from typing import TYPE_CHECKING, Any

from fatektool.errors import DataError, UsageError
from fatektool.files.plain_text import plain_text
from fatektool.files.portable_name import is_portable_name
from fatektool.files.strict_toml import read_toml
from fatektool.inventory.lines import key_lines, line_of
from fatektool.inventory.values import KEYS, KEYS_OF_ALL, KEYS_OF_ONE, PLACEHOLDER, address_of, take

if TYPE_CHECKING:
    from collections.abc import Sequence

    from fatektool.address import PlcAddress
    from fatektool.inventory.lines import KeyPath


@dataclass(frozen=True, slots=True)
class PlcEntry:
    """One PLC of the inventory, with the defaults filled in.

    Attributes:
        name: its name.
        address: of the PLC; a path in it is relative to the current folder, or absolute.
        tags: words for ``--select``.
        spec: the snapshot specification; None if there is none.
        reference: a backup or project with the expected program; None if there is none.
        project: the WinProladder project with the comments of its elements; None if there is none.
        modbus_map: ``standard``, ``custom``, a map, or a file with one; None for the standard map.
        expect: the expected mode: ``run``, ``stop`` or ``any``.
        keep: globs of the elements whose data ought to be constant; none for the default.
    """

    name: str
    address: PlcAddress
    tags: tuple[str, ...] = ()
    spec: Path | None = None
    reference: Path | None = None
    project: Path | None = None
    modbus_map: str | None = None
    expect: str = "run"
    keep: tuple[str, ...] = ()


@dataclass(frozen=True, slots=True)
class InventoryFault:
    """A fault in the file.

    Attributes:
        line: its line, from 1; None for the whole file.
        message: what is wrong.
    """

    line: int | None
    message: str

    def __str__(self) -> str:
        return f"line {self.line}: {self.message}" if self.line else self.message


@dataclass(slots=True)
class Inventory:
    """The contents of an inventory.

    Attributes:
        file: the file.
        plcs: the PLCs without faults by name, in the order of the file.
        faults: all faults, in the order of the file.
        backups: the folder of the last backups; None if there is none.
        history: the git repository with the programs as they changed; None if there is none.
    """

    file: Path
    plcs: dict[str, PlcEntry] = field(default_factory=dict)
    faults: list[InventoryFault] = field(default_factory=list)
    backups: Path | None = None
    history: Path | None = None

    def require_whole(self) -> None:
        """Raise DataError if there is a fault; its details have all of them."""
        if not self.faults:
            return
        from fatektool.system.shell import own_command_line

        more = f" (and {len(self.faults) - 1} more)" if len(self.faults) > 1 else ""
        check = own_command_line("inventory", "check", "--inventory", str(self.file))
        raise DataError(
            f"{self.file}: {self.faults[0]}{more}",
            hint=f"to see all of them run: {check}",
            file=str(self.file),
            faults=[str(fault) for fault in self.faults],
        )

    def named(self, name: str) -> PlcEntry:
        """The PLC of this name.

        Raises:
            UsageError: there is none; the message has similar names.
        """
        if name in self.plcs:
            return self.plcs[name]
        near = get_close_matches(name, self.plcs, 3, 0.6)
        meant = f"; did you mean {' or '.join(near)}?" if near else ""
        raise UsageError(
            f"no PLC {name!r} in the inventory {self.file}{meant}", hint="see 'fatektool inventory list'"
        )


def parse_inventory(data: bytes, file: Path) -> Inventory:
    """Parse an inventory. Never raises: faults are in its ``faults``.

    Args:
        data: the bytes of the file.
        file: the file: paths are relative to its folder.
    """
    try:
        text = plain_text(data).replace("\r\n", "\n")
        document = read_toml(text)
        lines = key_lines(text)
    except ValueError as error:  # UnicodeDecodeError and TOMLDecodeError among them
        place = re.search(r" \(at line (\d+), column \d+\)$", str(error))
        reason = str(error)[: place.start()] if place else str(error)
        return Inventory(
            file, faults=[InventoryFault(int(place[1]) if place else None, f"not valid TOML: {reason}")]
        )
    return _TableReader(Inventory(file), lines).read(document)


def _of_one(values: dict[str, Any], name: str, address: PlcAddress) -> dict[str, Any]:
    """The values of one PLC: its own reference, and a Modbus map only where its protocol is Modbus."""
    found = dict(values)
    if "reference" in found:
        found["reference"] = Path(str(found["reference"]).replace(PLACEHOLDER, name))
    if not address.protocol.startswith("modbus"):
        found.pop("modbus_map", None)
    return found


class _TableReader:
    """Reads the PLCs of a TOML document, and collects faults."""

    def __init__(self, inventory: Inventory, lines: dict[KeyPath, int]) -> None:
        self._found = inventory
        self._lines = lines

    def read(self, document: dict[str, Any]) -> Inventory:
        for key in document:
            if key not in {"defaults", "plc"}:
                self._fault("expected [defaults] and [plc.NAME] tables", key, got=key)
        allowed = [*(key for key in KEYS if key not in KEYS_OF_ONE), *KEYS_OF_ALL]
        defaults = self._table(document.get("defaults", {}), ("defaults",), allowed)
        for key in KEYS_OF_ALL:
            setattr(self._found, key, defaults.pop(key, None))
        self._check_reference(defaults)
        plcs = document.get("plc", {})
        if not isinstance(plcs, dict):
            self._fault("plc: expected [plc.NAME] tables", "plc")
            plcs = {}
        for name, table in plcs.items():
            self._plc(name, table, defaults)
        self._found.faults.sort(key=lambda fault: fault.line or 0)
        return self._found

    def _plc(self, name: str, table: object, defaults: dict[str, Any]) -> None:
        faults = len(self._found.faults)
        if not is_portable_name(name):
            self._fault(
                f"name of a PLC: expected up to 64 letters, digits, '_', '-' and '.', "
                f"not the name of a port, got {name!r}",
                "plc",
                name,
            )
        twin = next((other for other in self._found.plcs if other.lower() == name.lower()), None)
        if twin is not None:
            self._fault(f"{name!r} differs only in case from {twin!r}: expected another name", "plc", name)
        values = defaults | self._table(table, ("plc", name), KEYS)
        if "target" not in values and isinstance(table, dict) and "target" not in table:
            self._fault(
                f'plc.{name}: target is missing: expected for example target = "tcp://HOST"', "plc", name
            )
        if len(self._found.faults) > faults:
            return
        try:
            address = address_of(values)
        except UsageError as error:
            key = error.message.partition(" ")[0].rstrip(":")
            self._fault(f"plc.{name}: {error}", "plc", name, key if key in KEYS else "target")
            return
        self._found.plcs[name] = PlcEntry(name, address, **_of_one(values, name, address))

    def _check_reference(self, defaults: dict[str, Any]) -> None:
        reference = defaults.get("reference")
        if reference is not None and PLACEHOLDER not in str(reference):
            self._fault(
                f"defaults: reference: expected a file for each PLC, such as references/{PLACEHOLDER}.json",
                *("defaults", "reference"),
                got=str(reference),
            )

    def _table(self, table: object, path: tuple[str, ...], allowed: Sequence[str]) -> dict[str, Any]:
        """The valid values of a table."""
        if not isinstance(table, dict):
            self._fault(f"expected a table [{'.'.join(path)}]", *path)
            return {}
        found: dict[str, Any] = {}
        for key, value in table.items():
            if key not in allowed:
                near = get_close_matches(key, allowed, 1, 0.6)
                known = (
                    f"did you mean {near[0]}?" if near else f"expected one of {', '.join(sorted(allowed))}"
                )
                self._fault(f"{'.'.join(path)}: unknown key {key!r}: {known}", *path, key)
                continue
            try:
                found[key] = take(key, value, self._found.file.parent)
            except ValueError as error:
                self._fault(f"{'.'.join(path)}: {key}: {error}", *path, key)
            except UsageError as error:
                self._fault(f"{'.'.join(path)}: {error}", *path, key)
        return found

    def _fault(self, message: str, *path: str, got: str = "") -> None:
        reason = f"{message}, got {got!r}" if got else message
        self._found.faults.append(InventoryFault(line_of(self._lines, *path), reason))
