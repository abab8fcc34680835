"""The library for other programs: a PLC with elements by name, and ``connect``.

::

    with fatektool.connect("hall-1") as plc:       # a port, an address, or a name of the inventory
        plc.read("R12", "D4:f32", "X0-X7")         # {"R12": -5, "D4": 1.5, "X0": True, ...}
        plc.write({"R12": 5, "Y0": True})          # written, and read back

Elements and types are written as on the command line.
"""

from __future__ import annotations

from collections.abc import Mapping
from functools import partial
from typing import TYPE_CHECKING, Final

from fatektool import client
from fatektool.address import READ_ONLY_VARIABLE, PlcAddress
from fatektool.callbacks import ignore
from fatektool.connection import connect as open_plc
from fatektool.errors import PlcError, UsageError

if TYPE_CHECKING:
    import os
    from collections.abc import Callable, Iterable, Sequence
    from typing import Unpack

    from fatektool.address import Settings
    from fatektool.jobs.elements.selection import Item
    from fatektool.protocol.commands import Command
    from fatektool.protocol.elements import Element
    from fatektool.protocol.values import Value

_YES: Final = frozenset(("1", "true", "t", "yes", "y", "on"))
_NO: Final = frozenset(("", "0", "false", "f", "no", "n", "off"))


class Plc(client.Plc):
    """A PLC: elements are read and written by name; and a method for each command of the protocol.

    ``connect`` makes one. It is used in one thread at a time.
    """

    def read(self, *elements: str | Element) -> dict[str, Value]:
        """Read elements of any kind, in the fewest bytes.

        Args:
            elements: ``"R12"``, a range ``"R0-R99"`` or ``"X0-X7"``, a count ``"R0:100"``, each with a type
                if need be: ``"R12:u16"``, ``"D4:f32"``, ``"R0:8:bcd"``.

        Returns:
            Values by the element's short name, in the order asked for. A discrete is a bool, a register a
            signed int, a float with ``:f32``, text with ``:hex``.

        Raises:
            UsageError: an argument is not an element; nothing was sent.
            PlcError: the PLC refuses elements, or their bits are not a value of that type. ``details`` has
                ``errors`` and ``values`` by name.
            LineError: no answer.
        """
        from fatektool.jobs.elements.items import read_items
        from fatektool.jobs.elements.selection import parse_items

        items = parse_items(_text(each, f"read: argument {n}") for n, each in enumerate(elements, 1))
        if not items:
            raise UsageError("read: expected elements, such as 'R12' or 'X0-X7', got none")
        found = read_items(self, items)
        if found.errors:
            raise PlcError(_first(found.errors), errors=found.errors, values=found.values)
        return {key: value for key, value in found.values.items() if value is not None}

    def write(self, values: Mapping[str, Value | Sequence[Value]]) -> None:
        """Write elements of any kind, in the fewest bytes, and read them back.

        Args:
            values: by element, as ``read`` takes them: ``{"R12": 5, "Y0": True, "D4:f32": 1.5}``. A range
                takes one value for all of it, or one each: ``{"R0-R2": [1, 2, 3]}``. Text is read as on the
                command line: ``"0x5555"``, ``"on"``.

        Raises:
            UsageError: a key is not an element, or a value does not fit it; nothing was sent.
            PlcError: values that the PLC refused or did not keep. ``details["errors"]`` has each by name.
            LineReadOnly: the line is read-only; nothing was sent.
            LineError: no answer; some of the values may have been written.
        """
        from fatektool.jobs.elements.assignment import assigned, write_assignments

        if not values or not isinstance(values, Mapping):
            raise UsageError(f"write: expected values by element, such as {{'R12': 5}}, got {values!r:.80}")
        pairs = assigned({_text(key, "write"): value for key, value in values.items()})
        items = {item.element: item for item, _ in pairs}
        errors = {}
        for each in write_assignments(self, pairs):
            item = items[each.element]
            errors[item.key] = each.words(partial(_value, item))
        if errors:
            raise PlcError(_first(errors), errors=errors)


def _text(element: str | Element, argument: str) -> str:
    from fatektool.protocol.elements import Element

    if isinstance(element, str | Element):
        return str(element)
    raise UsageError(f"{argument}: expected an element such as 'R12', got {element!r:.80}")


def _value(item: Item, raw: int) -> str:
    from fatektool.jobs.elements.items import value_of

    return repr(value_of(item, raw))


def _first(errors: Mapping[str, str]) -> str:
    key, reason = next(iter(errors.items()))
    more = f"; and {len(errors) - 1} more: see details" if len(errors) > 1 else ""
    return f"{key}: {reason}{more}"


def connect(
    target: str | PlcAddress,
    *,
    inventory: str | os.PathLike[str] | None = None,
    needs: Iterable[Command] = (),
    lend: bool = False,
    note: Callable[[str], None] = ignore,
    waiting: Callable[[str], None] = ignore,
    warn: Callable[[str], None] = ignore,
    **settings: Unpack[Settings],
) -> Plc:
    """Open the line to a PLC. Nothing is sent yet, but for ``modbus_map="custom"``.

    With ``FATEKTOOL_READ_ONLY=1`` in the environment the line is read-only, whatever ``settings`` say.

    Args:
        target: ``"/dev/ttyUSB0"``, ``"tcp://192.168.2.3"`` and others, as of ``PlcAddress``; a name of the
            inventory, whose settings it then has; or a whole ``PlcAddress``.
        inventory: the file; None for the usual one: ``FATEKTOOL_INVENTORY``, ``./fatek.toml``, or that in the
            user's configuration folder.
        needs: commands that the protocol must have.
        lend: True to let other processes use the line between two rounds, with ``Plc.lend``.
        note: gets details, as with ``-v``.
        waiting: gets a message with the process that has the line, if it must be waited for.
        warn: gets a message, once, if answers are received later than ``timeout_s``.
        settings: the other fields of ``PlcAddress``: ``station=3``, ``protocol="mseries"``, ``timeout_s=2``.

    Raises:
        UsageError: a setting or ``FATEKTOOL_READ_ONLY`` has a wrong value; a name is not in the inventory;
            the protocol does not have one of ``needs``.
        DataError: the inventory has faults.
        LineError: the port or gateway cannot be opened; ``PortBusy`` among them.
    """
    address = target if isinstance(target, PlcAddress) else _address(target, inventory)
    if _is_read_only():
        address = address.changed(read_only=True)
    opened = open_plc(
        address.changed(**settings), needs=needs, lend=lend, note=note, waiting=waiting, warn=warn
    )
    return Plc.of(opened)


def _is_read_only() -> bool:
    """What the environment says, in the same words as for the command line."""
    import os

    text = os.environ.get(READ_ONLY_VARIABLE, "")
    word = text.strip().lower()
    if word not in _YES | _NO:
        raise UsageError(f"{READ_ONLY_VARIABLE}: expected 1 or 0, got {text!r:.80}")
    return word in _YES


def _address(target: str, inventory: str | os.PathLike[str] | None) -> PlcAddress:
    """The address of a port, or of a PLC of the inventory."""
    from fatektool.inventory.find import may_be_name, plc_named

    address = PlcAddress(target)
    if not may_be_name(target):
        return address
    from pathlib import Path

    entry = plc_named(target, None if inventory is None else Path(inventory))
    if entry is None or entry.modbus_map is None:
        return address if entry is None else entry.address
    from fatektool.jobs.snapshots.modbus_map import with_entry_map

    return with_entry_map(entry.address, entry.modbus_map)
