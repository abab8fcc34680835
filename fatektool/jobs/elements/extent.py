"""How many elements of each kind a PLC has, by its status (53)."""

from __future__ import annotations

from typing import TYPE_CHECKING

from fatektool.errors import DataError, NoAnswer, PlcError
from fatektool.jobs.elements.selection import places_of
from fatektool.protocol.commands import Command

if TYPE_CHECKING:
    from collections.abc import Iterable, Iterator, Mapping

    from fatektool.client import Plc
    from fatektool.protocol.elements import Element
    from fatektool.protocol.status import System

NEAR = 64
"""Elements fewer addresses apart are neighbours: so many registers one request of FACON holds."""


def limits(system: System) -> dict[str, int]:
    """How many discretes and registers of each kind the PLC says it has, by symbol."""
    return {
        "X": system.discrete_inputs,
        "Y": system.discrete_outputs,
        "M": system.m_relays,
        "S": system.s_relays,
        "T": system.timers,
        "C": system.counters,
        "RT": system.timers,
        "RC": system.counters,
        "R": system.r_registers,
        "D": system.d_registers,
    }


def ask_limits(plc: Plc) -> dict[str, int]:
    """Ask the PLC how many it has (53); empty if its answer has no documented layout.

    Raises:
        LineError: the line failed.
    """
    if Command.DETAILED_STATUS not in plc.link.codec.commands:
        return {}
    try:
        status = plc.detailed_status()
    except (PlcError, DataError, NoAnswer):
        return {}
    return {} if status.assumed else limits(status.system)


def excluded(element: Element, has: Mapping[str, int]) -> bool:
    """True if a discrete or register of this element is past what the PLC says it has."""
    return any(address >= has[symbol] for symbol, address in places_of(element) if symbol in has)


def extent_of(element: Element, has: Mapping[str, int]) -> str:
    """What the PLC says it has of an element's kind, in words: ``R0 to R8071``."""
    symbol, _ = places_of(element)[0]
    return f"{symbol}0 to {symbol}{has[symbol] - 1}" if has[symbol] else f"no {symbol}"


def near(before: Element, element: Element) -> bool:
    """True if an element is a neighbour of one before it."""
    return before.symbol == element.symbol and element.address - before.address < NEAR * element.kind.stride


def neighbours(elements: Iterable[Element]) -> Iterator[list[Element]]:
    """Elements in order, in groups of neighbours."""
    group: list[Element] = []
    for element in elements:
        if group and not near(group[-1], element):
            yield group
            group = []
        group.append(element)
    if group:
        yield group
