"""The memory of simulated PLCs in a file, kept after the process ends.

A JSON document; values that are zero, off or enabled, and empty pages (all FF), are omitted::

    {"schema": "fatektool.simulator/1",
     "plcs": [{"station": 1, "model": "fbe-28mc", "ladder_words": 13184,
               "flags": ["running"],                    in the order of plc.FLAGS
               "on": {"Y": [0, 3]},                     discretes that are on
               "disabled": {"X": [16]},
               "inputs": [50],                          terminals that are on
               "registers": {"R": {"12": 4261}},
               "page_count": 512,                       if it is not the model's
               "pages": {"0": "4642 .."}}]}             256 hex digits each

A file is read completely, or refused with one line with its name and the fault. It is written under another
name and renamed, so a process that is killed at any moment leaves the state before or after. It is not synced
to the disk: it is a PLC's memory in a test, not a backup, and a restore writes it some two hundred times.
"""

from __future__ import annotations

import json
import os
import re
from dataclasses import replace
from pathlib import Path
from typing import TYPE_CHECKING, Any, NoReturn

from fatektool.errors import DataError
from fatektool.simulator.models import MAX_LADDER_WORDS, MODELS, PAGE_BYTES
from fatektool.simulator.plc import FLAGS, MAX_STATION, SimulatedPlc
from fatektool.system.renaming import replace_file

if TYPE_CHECKING:
    from collections.abc import Iterable, Mapping

    from fatektool.simulator.models import Model

SCHEMA = "fatektool.simulator/1"
_MAX_FILE = 64 << 20  # some hundred kilobytes for each PLC, at most 254 PLCs
_EMPTY_PAGE = b"\xff" * PAGE_BYTES
_PAGE = re.compile(f"[0-9A-Fa-f]{{{2 * PAGE_BYTES}}}")
_PLC_KEYS = ("station", "model", "ladder_words", "flags", "on", "disabled", "inputs", "registers", "pages")


def dump_state(plcs: Iterable[SimulatedPlc]) -> str:
    """The document of these PLCs."""
    document = {"schema": SCHEMA, "plcs": [_plc_to_json(plc) for plc in plcs]}
    return json.dumps(document, separators=(",", ":")) + "\n"


def parse_state(text: str | bytes, name: str) -> list[SimulatedPlc]:
    """The PLCs of a document; ``name`` is for errors."""
    return _Reader(name).plcs(text)


class StateFile:
    """The file with the PLCs of a simulator.

    Args:
        path: the file; it need not exist.
    """

    def __init__(self, path: str | os.PathLike[str]) -> None:
        self.path = Path(path)
        self._saved_revision: tuple[int, ...] | None = None

    def load(self) -> list[SimulatedPlc] | None:
        """The PLCs in the file; None if there is none yet."""
        try:
            with self.path.open("rb") as file:
                content = file.read(_MAX_FILE + 1)
        except FileNotFoundError:
            return None
        except OSError as error:
            raise DataError(f"{self.path}: cannot be read: {error.strerror}") from error
        if len(content) > _MAX_FILE:
            raise DataError(f"{self.path}: expected at most {_MAX_FILE} bytes, got more")
        plcs = parse_state(content, str(self.path))
        self._saved_revision = tuple(plc.revision for plc in plcs)
        return plcs

    def save_if_changed(self, plcs: Mapping[int, SimulatedPlc]) -> bool:
        """Write the file unless it has exactly this state; True if it was written."""
        revision = tuple([plc.revision for plc in plcs.values()])
        if revision == self._saved_revision:
            return False
        # A link to the file is kept; the temporary file is in the folder of its target.
        target = self.path.resolve()
        temporary = target.with_name(f".{target.name}.{os.getpid()}.tmp")
        try:
            try:
                with open(temporary, "w", encoding="ascii", opener=_private) as file:
                    file.write(dump_state(plcs.values()))
                replace_file(temporary, target)
            except BaseException:
                temporary.unlink(missing_ok=True)
                raise
        except OSError as error:
            raise DataError(f"{self.path}: cannot be written: {error.strerror}") from error
        self._saved_revision = revision
        return True


def _private(path: str, flags: int) -> int:
    """It may contain a program: only owner and group can read it, as a backup."""
    return os.open(path, flags, 0o640)


def _plc_to_json(plc: SimulatedPlc) -> dict[str, Any]:
    memory = plc.memory
    return {
        "station": plc.station,
        "model": plc.model.name,
        "ladder_words": plc.model.ladder_words,
        **({} if plc.model.pages is None else {"page_count": plc.model.pages}),
        "flags": [flag for flag in FLAGS if getattr(plc, flag)],
        "on": _addresses(memory.status),
        "disabled": _addresses(memory.disabled),
        "inputs": [address for address, value in enumerate(memory.inputs) if value],
        "registers": {
            area: {str(address): value for address, value in enumerate(table) if value}
            for area, table in memory.registers.items()
            if any(table)
        },
        "pages": {
            str(number): page.hex().upper() for number, page in enumerate(plc.pages) if page != _EMPTY_PAGE
        },
    }


def _addresses(tables: Mapping[str, bytearray]) -> dict[str, list[int]]:
    return {
        area: [address for address, value in enumerate(table) if value]
        for area, table in tables.items()
        if any(table)
    }


def _once_each(items: list[tuple[str, Any]]) -> dict[str, Any]:
    """An object; a key that occurs twice is refused."""
    found = dict(items)
    if len(found) != len(items):
        raise ValueError
    return found


class _Reader:
    """Checks a document part by part; every error has the name of the file."""

    def __init__(self, name: str) -> None:
        self._name = name

    def plcs(self, text: str | bytes) -> list[SimulatedPlc]:
        try:
            document = json.loads(text, object_pairs_hook=_once_each)
        except (ValueError, RecursionError):
            self._fail("is not a JSON document")
        if not isinstance(document, dict) or document.get("schema") != SCHEMA:
            self._fail(f"is not a simulator state: expected the schema {SCHEMA}")
        self._keys(document, ("schema", "plcs"), "the document")
        if not isinstance(document["plcs"], list) or not document["plcs"]:
            self._fail("plcs is not a list of at least one PLC")
        plcs: dict[int, SimulatedPlc] = {}
        for part in document["plcs"]:
            plc = self._plc(part)
            if plc.station in plcs:
                self._fail(f"station {plc.station} occurs twice")
            plcs[plc.station] = plc
        return list(plcs.values())

    def _plc(self, part: Any) -> SimulatedPlc:
        if not isinstance(part, dict):
            self._fail("a PLC is not an object")
        self._keys(part, (*_PLC_KEYS, *(["page_count"] if "page_count" in part else [])), "a PLC")
        station = self._number(part["station"], range(1, MAX_STATION + 1), "station")
        model = MODELS.get(part["model"]) if isinstance(part["model"], str) else None
        if model is None:
            self._fail(f"station {station}: unknown model {part['model']!r:.60}")
        model = self._sized(model, part)
        pages = [_EMPTY_PAGE] * model.page_count
        for number, text in self._table(part["pages"], len(pages), f"station {station}: pages"):
            pages[number] = self._page(text, number)
        plc = SimulatedPlc(station, model, pages=pages)
        if not isinstance(part["flags"], list) or not all(flag in FLAGS for flag in part["flags"]):
            self._fail(f"station {station}: flags is not a list of {', '.join(FLAGS)}")
        for flag in part["flags"]:
            setattr(plc, flag, True)
        for key, tables in (("on", plc.memory.status), ("disabled", plc.memory.disabled)):
            for area, table in self._areas(part[key], tables, f"station {station}: {key}"):
                self._switch_on(area, table, f"station {station}: {key}")
        self._switch_on(part["inputs"], plc.memory.inputs, f"station {station}: inputs")
        for values, registers in self._areas(
            part["registers"], plc.memory.registers, f"station {station}: registers"
        ):
            for address, value in self._table(values, len(registers), f"station {station}: registers"):
                registers[address] = self._number(value, range(0x10000), "a register")
        return plc

    def _sized(self, model: Model, part: dict[str, Any]) -> Model:
        words = self._number(part["ladder_words"], range(1, MAX_LADDER_WORDS + 1), "ladder_words")
        model = replace(model, ladder_words=words)
        if "page_count" not in part:
            return model
        most = replace(model, image=None).page_count
        return replace(model, pages=self._number(part["page_count"], range(1, most + 1), "page_count"))

    def _areas(self, part: Any, tables: Mapping[str, Any], what: str) -> list[tuple[Any, Any]]:
        if not isinstance(part, dict) or not part.keys() <= tables.keys():
            self._fail(f"{what} is not an object of {', '.join(tables)}")
        return [(values, tables[area]) for area, values in part.items()]

    def _table(self, part: Any, size: int, what: str) -> list[tuple[int, Any]]:
        if not isinstance(part, dict):
            self._fail(f"{what}: not an object")
        entries = []
        for key, value in part.items():
            # Only the usual form, so that one address cannot occur twice.
            if not (key.isascii() and key.isdigit() and len(key) <= len(str(size)) and str(int(key)) == key):
                self._fail(f"{what}: {key!r:.60} is not an address")
            entries.append((self._number(int(key), range(size), what), value))
        return entries

    def _switch_on(self, addresses: Any, table: bytearray, what: str) -> None:
        if not isinstance(addresses, list):
            self._fail(f"{what}: not a list of addresses")
        for address in addresses:
            table[self._number(address, range(len(table)), what)] = 1

    def _page(self, text: Any, number: int) -> bytes:
        if not isinstance(text, str) or not _PAGE.fullmatch(text):
            self._fail(f"page {number}: expected {2 * PAGE_BYTES} hex digits")
        return bytes.fromhex(text)

    def _number(self, value: Any, allowed: range, what: str) -> int:
        # True is an int in Python, but not a number in a document.
        if not isinstance(value, int) or isinstance(value, bool) or value not in allowed:
            self._fail(f"{what}: expected {allowed.start} to {allowed.stop - 1}, got {value!r:.60}")
        return value

    def _keys(self, part: Mapping[str, Any], expected: tuple[str, ...], what: str) -> None:
        if part.keys() != set(expected):
            found = ", ".join(f"{key!r:.40}" for key in list(part)[: len(expected) + 1]) or "none"
            self._fail(f"{what}: expected the keys {', '.join(expected)}, got {found}")

    def _fail(self, fault: str) -> NoReturn:
        raise DataError(f"{self._name}: {fault}", file=self._name)
