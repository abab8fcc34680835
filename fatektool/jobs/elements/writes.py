"""Writing elements of any kind: in the fewest bytes, read back, with a reason for each value not kept."""

from __future__ import annotations

from dataclasses import dataclass
from typing import TYPE_CHECKING

from fatektool.errors import PlcRefused, UsageError
from fatektool.jobs.elements.disabled import read_disabled
from fatektool.jobs.elements.division import Division, Refusals
from fatektool.jobs.elements.ledger import Ledger
from fatektool.jobs.elements.reads import by_request, named, parts_of, read_elements, turnaround
from fatektool.jobs.elements.selection import overlapping
from fatektool.planner import plan_writes
from fatektool.planner.atoms import atoms_of
from fatektool.protocol.commands import (
    Request,
    WriteDiscretes,
    WriteRegisters,
)
from fatektool.protocol.elements import Element

if TYPE_CHECKING:
    from collections.abc import Callable, Sequence

    from fatektool.client import Plc


@dataclass(frozen=True, slots=True)
class NotTaken:
    """A value that the PLC did not keep, or that could not be read back.

    Attributes:
        element: which.
        wanted: what was written, raw.
        got: what was read back, raw; None if it cannot be read.
        reason: why, as far as that is known.
        acknowledged: False if the PLC refused the write, or it was not tried.
    """

    element: Element
    wanted: int
    got: int | None
    reason: str
    acknowledged: bool = True

    def words(self, shown: Callable[[int], str], place: str = "") -> str:
        """The failure in words.

        Args:
            shown: a raw value as the user reads it.
            place: the element, where it is shown under another name.
        """
        wanted = shown(self.wanted) + (f" in {place}" if place else "")
        if self.got is not None:
            return f"not kept: expected {wanted}, read back {shown(self.got)}: {self.reason}"
        if self.acknowledged:  # the refusal is of the read-back, which nobody asked for
            return f"written and acknowledged, but it cannot be read back: {self.reason}"
        return f"not written: expected {wanted}: {self.reason}"


def write_elements(
    plc: Plc, items: Sequence[tuple[Element, int]], ledger: Ledger | None = None
) -> list[NotTaken]:
    """Write elements of any kind, read all back, and report what was not kept.

    Args:
        plc: the PLC.
        items: elements with raw, unsigned values.
        ledger: keeps account of what was written, should it end half way.

    Raises:
        UsageError: two of them share a discrete or register; nothing was sent.
        LineError: no answer; some of them may be written.
    """
    both = overlapping(element for element, _ in items)
    if both is not None:
        raise UsageError(f"{both[0]} and {both[1]} overlap: expected each discrete and register once")
    refused = send_elements(plc, items, ledger or Ledger())
    found = read_elements(plc, [element for element, _ in items])
    failed = [
        (element, wanted)
        for element, wanted in items
        if found.values.get(element) != wanted or element in refused
    ]
    acknowledged = [
        (element, wanted ^ found.values[element])
        for element, wanted in failed
        if element not in refused and element in found.values
    ]
    reasons = found.errors | _why(plc, acknowledged) | refused
    return [
        NotTaken(
            element, wanted, found.values.get(element), reasons[element], acknowledged=element not in refused
        )
        for element, wanted in failed
    ]


def send_elements(plc: Plc, items: Sequence[tuple[Element, int]], ledger: Ledger) -> dict[Element, str]:
    """Write elements of any kind, and read nothing back.

    Args:
        plc: the PLC.
        items: elements with raw, unsigned values; no discrete or register twice.
        ledger: keeps account of what was written, should it end half way.

    Returns:
        The PLC's error for each element that it refuses, or why it was not tried.

    Raises:
        LineError: no answer; some of them may be written.
    """
    return _Writer(plc, dict(items), ledger).write()


class _Writer:
    """Writes, and finds the elements that are refused."""

    def __init__(self, plc: Plc, values: dict[Element, int], ledger: Ledger) -> None:
        self._plc = plc
        self._values = values
        self._ledger = ledger
        self._failed: list[Request[None]] = []

    def write(self) -> dict[Element, str]:
        """Write all; the PLC's error for each element that it refuses, or why it was not tried."""
        wanted = sorted(self._values)
        left = self._write_together(wanted)
        if not left:
            return {}
        groups = by_request(left, self._failed)
        unread = read_elements(self._plc, left).errors  # what cannot be read is not tried alone
        refusals = Refusals(
            {element: f"refused, and it cannot be read either: {said}" for element, said in unread.items()}
        )
        division = Division(wanted, self._write_together, self._write_alone, refusals)
        for group in groups:
            writable = [element for element in group if element not in unread]
            if len(writable) < len(group):
                writable = self._write_together(writable)
            division.divide(writable)
        return refusals.errors

    def _write_together(self, elements: Sequence[Element]) -> list[Element]:
        self._failed = []
        for request in _plan(self._plc, [(element, self._values[element]) for element in elements]):
            try:
                self._ask(request)
            except PlcRefused:
                self._failed.append(request)
        if not self._failed:
            return []
        groups = by_request(elements, self._failed)
        if len(groups) > len(self._failed):
            groups.pop()  # those whose requests were not refused
        return sorted(element for group in groups for element in group)

    def _write_alone(self, element: Element) -> str | None:
        value = self._values[element]
        one = element.kind.bits == 1
        try:
            self._ask(WriteDiscretes(element, (bool(value),)) if one else WriteRegisters(element, (value,)))
        except PlcRefused as error:
            return error.message
        return None

    def _ask(self, request: Request[None]) -> None:
        with self._ledger.entry(parts_of(request)):
            self._plc.link.ask(request)


def _plan(plc: Plc, items: list[tuple[Element, int]]) -> list[Request[None]]:
    return plan_writes(items, plc.link.codec, turnaround=turnaround(plc))


def _why(plc: Plc, failed: list[tuple[Element, int]]) -> dict[Element, str]:
    """Why values of acknowledged writes were not kept.

    Args:
        plc: the PLC.
        failed: elements, and the bits that are not as they were written.
    """
    suspects: dict[Element, list[Element]] = {}
    for element, wrong in failed:
        atoms = atoms_of(element)
        if element.kind.bits == len(atoms):
            suspects[element] = [Element(*atom) for place, atom in enumerate(atoms) if wrong >> place & 1]
    flags, _ = read_disabled(plc, [each for some in suspects.values() for each in some])
    reasons = {}
    for element, _ in failed:
        held = [each for each in suspects.get(element, ()) if flags.get(each)]
        if held:
            names = "it is" if held == [element] else f"{named(map(str, held))} {'are' if held[1:] else 'is'}"
            reasons[element] = (
                f"{names} disabled: 'fatektool discrete set' and 'reset' still switch it, "
                f"'discrete enable' enables it"
            )
        elif element.symbol.endswith("X"):
            reasons[element] = "an input follows its terminal unless it is disabled"
        else:
            reasons[element] = (
                "acknowledged, but another value was read back: read-only, or the program writes it too"
            )
    return reasons
