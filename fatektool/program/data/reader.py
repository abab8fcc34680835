"""Reading the part ``data`` of a backup file: every line, count, name and the hash is checked."""

from __future__ import annotations

import re
from collections.abc import Mapping
from typing import TYPE_CHECKING, Any, Final

from fatektool.errors import UsageError
from fatektool.files.times import is_utc
from fatektool.program.data.part import NO_REGISTER, NO_RELAY, RELAYS, DataPart, Values, row_length
from fatektool.program.data.uses import SYMBOLS
from fatektool.protocol.elements import Element

if TYPE_CHECKING:
    from fatektool.program.checked_document import CheckedDocument

Table = Mapping[str, Values]
COUNTED_AS: Final = {
    "R": "r_registers",
    "D": "d_registers",
    "RT": "timers",
    "RC": "counters",
    "M": "m_relays",
    "S": "s_relays",
}
"""What 53 calls the number of each kind; it does not count file registers."""
_MOST: Final = 65536
_DISCRETES: Final = "XYMSTC"
_REGISTER: Final = re.compile(r"[0-9A-F]{4}|----")
_RELAY: Final = re.compile(r"[01-]")


def read_part(fields: CheckedDocument, document: dict[str, Any], system: Mapping[str, Any]) -> DataPart:
    """Read and check the part.

    Args:
        fields: takes it apart.
        document: the value of ``data``.
        system: what 53 said of the PLC, in the same file.

    Raises:
        DataError: something does not hold; says where.
    """
    time = fields.text(document, "time", "data.")
    if not is_utc(time):
        raise fields.fault("data.time: expected a UTC time such as 2026-11-22T03:15:00Z", time)
    running = document.get("running")
    if not isinstance(running, bool):
        raise fields.fault("data.running: expected true or false", running)
    values = _values(fields, document, _counts(fields, document, system))
    found = DataPart(
        time,
        running,
        values,
        _disabled(fields, document),
        _moving(fields, document, values),
        _errors(fields, document, values),
    )
    fields.same("data.sha256", found.sha256, fields.text(document, "sha256", "data.").lower(), "its values")
    return found


def _counts(fields: CheckedDocument, document: dict[str, Any], system: Mapping[str, Any]) -> dict[str, int]:
    part = fields.part(document, "counts", "data.")
    counts = {symbol: fields.number(part, symbol, 0, _MOST, "data.counts.") for symbol in SYMBOLS}
    for symbol, name in COUNTED_AS.items():
        most = Element(symbol, 0).kind.last + 1
        fields.same(f"data.counts.{symbol}", min(system[name], most), counts[symbol], f"plc.system.{name}")
    return counts


def _values(fields: CheckedDocument, document: dict[str, Any], counts: Mapping[str, int]) -> Table:
    part = dict(fields.part(document, "values", "data."))
    found = {}
    for symbol, count in counts.items():
        values: list[int | None] = []
        length = row_length(symbol)
        for first in range(0, count, length):
            name = f"{symbol}{first}"
            values += _row(fields, name, symbol, part.pop(name, None), min(length, count - first))
        found[symbol] = tuple(values)
    if part:
        raise fields.fault(
            f"data.values.{next(iter(part))}: expected no such line", next(iter(part.values()))
        )
    return found


def _row(fields: CheckedDocument, name: str, symbol: str, row: object, count: int) -> list[int | None]:
    relays = symbol in RELAYS
    expected = f"{count} relays, 0 or 1" if relays else f"{count} registers of 4 hex digits"
    parts = (list(row) if relays else row.split(" ")) if isinstance(row, str) else []
    shape = _RELAY if relays else _REGISTER
    if len(parts) != count or not all(map(shape.fullmatch, parts)):
        raise fields.fault(f"data.values.{name}: expected {expected}", row)
    return [None if each in {NO_REGISTER, NO_RELAY} else int(each, 16) for each in parts]


def _disabled(fields: CheckedDocument, document: dict[str, Any]) -> dict[str, bool]:
    part = fields.part(document, "disabled", "data.")
    for name, on in part.items():
        if not _is_element(name, _DISCRETES):
            raise fields.fault("data.disabled: expected names of discretes", name)
        if not isinstance(on, bool):
            raise fields.fault(f"data.disabled.{name}: expected true or false", on)
    return part


def _moving(fields: CheckedDocument, document: dict[str, Any], values: Table) -> tuple[str, ...]:
    moving = document.get("moving")
    if not isinstance(moving, list) or not all(isinstance(each, str) for each in moving):
        raise fields.fault("data.moving: expected a list of elements", moving)
    for span in moving:
        _addresses(fields, "data.moving", span, values)
    return tuple(moving)


def _errors(fields: CheckedDocument, document: dict[str, Any], values: Table) -> dict[str, str]:
    errors = fields.part(document, "errors", "data.")
    without = {
        (symbol, address)
        for symbol, each in values.items()
        for address, value in enumerate(each)
        if value is None
    }
    for span, text in errors.items():
        if not isinstance(text, str):
            raise fields.fault(f"data.errors.{span}: expected a text", text)
        symbol, addresses = _addresses(fields, "data.errors", span, values)
        for address in addresses:
            if (symbol, address) not in without:
                raise fields.fault(f"data.errors: expected no value of {symbol}{address}", span)
            without.remove((symbol, address))
    if without:
        symbol, address = min(without)
        raise fields.fault(f"data.errors: expected why {symbol}{address} has no value", None)
    return errors


def _addresses(fields: CheckedDocument, where: str, span: str, values: Table) -> tuple[str, range]:
    """The kind and the addresses of a span such as ``R0-R63``."""
    first, _, last = span.partition("-")
    if not all(_is_element(each, SYMBOLS) for each in (first, last or first)):
        raise fields.fault(f"{where}: expected elements such as R0-R63", span)
    begin, end = Element.parse(first), Element.parse(last or first)
    if begin.symbol != end.symbol or not begin.address <= end.address < len(values[begin.symbol]):
        raise fields.fault(f"{where}: expected elements that the PLC has", span)
    return begin.symbol, range(begin.address, end.address + 1)


def _is_element(text: str, symbols: str | tuple[str, ...]) -> bool:
    try:
        element = Element.parse(text)
    except UsageError:
        return False
    return element.symbol in symbols and str(element) == text
