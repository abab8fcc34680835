"""What a restore of data will write: what differs, and what of it may be written.

A PLC that is to hold the data of a file gets the values of what it keeps without power and of what it loses,
and the same discretes are disabled, in the same states. Settings (special registers of ports and modem) are
written only if that is asked for. Inputs, outputs, the clock, commands and states of the PLC are not written.
"""

from __future__ import annotations

from dataclasses import dataclass
from typing import TYPE_CHECKING

from fatektool.errors import DataError
from fatektool.jobs.elements.planned import RegisterChange
from fatektool.jobs.elements.reads import turnaround
from fatektool.planner import plan_reads, plan_writes
from fatektool.program.data.compare import compare_values, elements_in
from fatektool.program.data.uses import SYMBOLS, WRITTEN, Use
from fatektool.protocol.elements import Element, Stretch

if TYPE_CHECKING:
    from collections.abc import Mapping

    from fatektool.client import Plc
    from fatektool.program.data.part import DataPart


@dataclass(frozen=True, slots=True)
class DataPlan:
    """What will be written.

    Attributes:
        wanted: the data on file.
        present: the data in the PLC.
        values: values that differ, but for those of discretes in ``hold``.
        enable: discretes that are disabled, and are not on file.
        hold: discretes that will be disabled, True for on; they are not, or are in the other state.
        settings: settings that differ and will be written.
        left: what differs and is not written, by use.
        moving: settings that differ and changed while one of both was read; they are not written.
        missing: what has a value on file and none in the PLC.
    """

    wanted: DataPart
    present: DataPart
    values: tuple[RegisterChange, ...]
    enable: tuple[Element, ...]
    hold: Mapping[Element, bool]
    settings: tuple[RegisterChange, ...]
    left: Mapping[Use, tuple[Element, ...]]
    moving: tuple[Element, ...]
    missing: tuple[Element, ...]

    @property
    def changes(self) -> int:
        """How many values, disabled discretes and settings will be written."""
        return len(self.values) + len(self.enable) + len(self.hold) + len(self.settings)

    @property
    def equal(self) -> int:
        """How many values are as on file already."""
        total = sum(value is not None for values in self.wanted.values.values() for value in values)
        left = sum(map(len, self.left.values())) + len(self.moving) + len(self.missing)
        return total - len(self.values) - len(self.settings) - left

    def exchanges(self, plc: Plc) -> int:
        """About how many exchanges it takes to write, to read all back, and to look at what is disabled."""
        codec, turn = plc.link.codec, turnaround(plc)
        values = [(change.element, change.after) for change in self.values]
        whole = [Stretch(Element(symbol, 0), count) for symbol, count in self.wanted.counts.items() if count]
        requests = len(plan_writes(values, codec, turnaround=turn)) + len(plan_reads(whole, codec))
        return requests + len(self.enable) + 2 * len(self.hold) + 2 * len(self.settings) + 20


def require_data_fits(wanted: DataPart, counts: Mapping[str, int]) -> None:
    """Refuse data of a PLC that has more than this one.

    Args:
        wanted: the data on file.
        counts: how many elements of each kind this PLC has.

    Raises:
        DataError: it has fewer of a kind.
    """
    for symbol in SYMBOLS:
        if wanted.counts[symbol] > counts[symbol]:
            raise DataError(
                f"the data do not fit this PLC: expected at most {counts[symbol]} {symbol}, "
                f"got {wanted.counts[symbol]} in the file",
                hint="restore a backup of this model; or the program alone, without --data",
            )


def plan_data(wanted: DataPart, present: DataPart, *, settings: bool) -> DataPlan:
    """Find what will be written.

    Args:
        wanted: the data on file.
        present: the data in the PLC.
        settings: write settings too.
    """
    held = {Element.parse(name): on for name, on in wanted.disabled.items()}
    now = {Element.parse(name): on for name, on in present.disabled.items()}
    unsteady = elements_in(wanted.moving) | elements_in(present.moving)
    values, special, moving, missing = [], [], [], []
    left: dict[Use, list[Element]] = {}
    for element, use, on_file, there in compare_values(wanted, present):
        if on_file is None or element in held:
            continue
        if there is None:
            missing.append(element)
        elif use in WRITTEN:
            values.append(RegisterChange(element, there, on_file))
        elif use is Use.SETTING and element in unsteady:
            moving.append(element)
        elif use is Use.SETTING and settings:
            special.append(RegisterChange(element, there, on_file))
        else:
            left.setdefault(use, []).append(element)
    return DataPlan(
        wanted,
        present,
        tuple(values),
        tuple(element for element in now if element not in held),
        {element: on for element, on in held.items() if now.get(element) is not on},
        tuple(special),
        {use: tuple(elements) for use, elements in left.items()},
        tuple(moving),
        tuple(missing),
    )


def are_data_between(present: DataPart, old: DataPart, wanted: DataPart) -> bool:
    """True if each value that a restore may write is that of a safety copy, or that on file.

    The copy of a PLC in RUN shows nothing: its values changed after it was made, up to STOP.
    """
    if old.running:
        return True
    before = {each.element: each for each in compare_values(old, present)}
    after = {each.element for each in compare_values(wanted, present)}
    unsteady = elements_in(old.moving)
    return all(
        each.use not in WRITTEN or each.element not in after or each.element in unsteady
        for each in before.values()
    )
