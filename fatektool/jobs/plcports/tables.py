"""Reading a communication table out of a PLC, and planning to write one.

In RUN an instruction may use the table while it is half old and half new.
"""

from __future__ import annotations

from typing import TYPE_CHECKING, Final

from fatektool.errors import DataError, PlcError, UsageError
from fatektool.jobs.elements.planned import RegisterChange
from fatektool.jobs.elements.reads import named
from fatektool.jobs.elements.selection import Item
from fatektool.jobs.plcports.ports import read_words, require_register
from fatektool.jobs.snapshots.snapshot import raw_of, snapshot_and_status
from fatektool.jobs.snapshots.spec import SpecItem
from fatektool.jobs.snapshots.write_values import ValuesPlan
from fatektool.plcports.tables import Table, parse_table, table_words
from fatektool.protocol.elements import Element
from fatektool.protocol.values import ValueType

if TYPE_CHECKING:
    from collections.abc import Sequence

    from fatektool.client import Plc
    from fatektool.plcports.kinds import TableKind

_READINGS: Final = 3


def parse_start(text: str, operand: str) -> Element:
    """Read operand SR or WR as people write it.

    Raises:
        UsageError: it is no register.
    """
    element = Element.parse(text)
    require_register(element, operand)
    return element


def read_table(plc: Plc, start: Element, kind: TableKind) -> Table:
    """Read a table.

    Args:
        plc: the PLC.
        start: operand SR.
        kind: which instruction and mode it is for; the words do not say.

    Raises:
        UsageError: no register.
        PlcError: the PLC refused a register.
        DataError: its length changes from one reading to the next.
        LineError: no answer.
    """
    require_register(start, "SR")
    words = read_words(plc, start, kind.head_words)
    for _ in range(_READINGS):
        count = table_words(kind, words)
        if count == len(words):
            return parse_table(kind, words)
        words = read_words(plc, start, count)
        if table_words(kind, words) == count:
            return parse_table(kind, words)
    raise DataError(
        f"the table at {start} changes its length while it is read: expected the same {_READINGS} times",
        hint="STOP the PLC, or read it again",
    )


def plan_write(plc: Plc, start: Element, words: Sequence[int]) -> ValuesPlan:
    """Read what is there now and find what differs. Changes nothing.

    Args:
        plc: the PLC.
        start: operand SR.
        words: what shall be there.

    Raises:
        UsageError: no register, or the words go past the last one.
        PlcError: the PLC refused a register.
        LineError: no answer.
    """
    require_register(start, "SR")
    if start.address + len(words) - 1 > start.kind.last:
        raise UsageError(f"{len(words)} registers from {start} go past {start.symbol}{start.kind.last}")
    elements = [start.after(place) for place in range(len(words))]
    items = [SpecItem(Item(str(element), element, ValueType.HEX)) for element in elements]
    present, status = snapshot_and_status(plc, items)
    if present.errors:
        said = next(iter(present.errors.values()))
        raise PlcError(
            f"the PLC refused {named(present.errors)}: {said}", hint="choose another place for the table"
        )
    now = (raw for _, raw in raw_of(present).values())
    changes = tuple(
        RegisterChange(element, before, after)
        for element, before, after in zip(elements, now, words, strict=True)
        if before is not None and before != after
    )
    return ValuesPlan(
        "the table was not written completely", present, status, changes, len(words) - len(changes)
    )
