"""Discretes enabled, disabled, set and reset (42), then read back: on or off (44), disabled or not (43)."""

from __future__ import annotations

from dataclasses import dataclass
from typing import TYPE_CHECKING

from fatektool.errors import PlcRefused, UsageError
from fatektool.jobs.elements.disabled import read_disabled
from fatektool.jobs.elements.reads import read_elements
from fatektool.jobs.elements.selection import parse_items
from fatektool.protocol.commands import Command, Control, ControlDiscrete

if TYPE_CHECKING:
    from collections.abc import Iterable, Sequence

    from fatektool.client import Plc
    from fatektool.protocol.elements import Element

SWITCHES = frozenset({Control.SET, Control.RESET})


@dataclass(frozen=True, slots=True)
class DiscreteState:
    """One discrete as it was read.

    Attributes:
        on: whether it is on.
        disabled: whether it is disabled; None where the protocol cannot say.
    """

    on: bool
    disabled: bool | None


@dataclass(frozen=True, slots=True)
class DiscreteStates:
    """Discretes as they were read, each by its name.

    Attributes:
        states: of those that could be read.
        not_taken: those on which the command had no effect, and why.
        errors: those that the PLC refused or that could not be read, and why.
        not_asked: those of ``errors`` that the PLC was not asked for.
    """

    states: dict[str, DiscreteState]
    not_taken: dict[str, str]
    errors: dict[str, str]
    not_asked: list[str]


def parse_discretes(texts: Iterable[str]) -> list[Element]:
    """Read which discretes a user names.

    Raises:
        UsageError: a text is no selection, or names registers.
    """
    elements = [item.element for item in parse_items(texts)]
    for element in elements:
        if element.kind.bits != 1:
            raise UsageError(f"{element} is not a discrete: expected X, Y, M, S, T or C")
    return elements


def control_discretes(plc: Plc, elements: Sequence[Element], control: Control) -> DiscreteStates:
    """Enable, disable, set or reset discretes one by one, and read them back.

    Args:
        plc: the PLC.
        elements: discretes.
        control: what is done to each.

    Raises:
        LineError: no answer; some of them may be done.
    """
    refused = {}
    for element in elements:
        try:
            plc.link.ask(ControlDiscrete(control, element))
        except PlcRefused as error:
            refused[str(element)] = error.message
    return _read(plc, elements, refused, control)


def read_discretes(plc: Plc, elements: Sequence[Element]) -> DiscreteStates:
    """Read which discretes are on, and which are disabled.

    Args:
        plc: the PLC.
        elements: discretes.

    Raises:
        LineError: no answer.
    """
    return _read(plc, elements, {}, None)


def _read(
    plc: Plc, elements: Sequence[Element], refused: dict[str, str], control: Control | None
) -> DiscreteStates:
    on = read_elements(plc, elements)
    flags, held = read_disabled(plc, on.values)
    knows_disabled = Command.READ_DISABLED in plc.link.codec.commands
    state_alone = control in SWITCHES or not knows_disabled  # disabled or not is only shown beside it
    errors = {str(element): error for element, error in on.errors.items()}
    if not state_alone:
        errors |= {str(element): error for element, error in held.errors.items()}
    if control is not None:
        errors = {
            name: f"acknowledged, but it cannot be read back: {error}" for name, error in errors.items()
        }
    missing = on.not_asked if state_alone else on.not_asked | held.not_asked
    states = {
        str(element): DiscreteState(bool(on.values[element]), flags.get(element))
        for element in elements
        if element in (on.values if state_alone else flags)
    }
    not_taken = {
        name: _why(name, state, control, knows_disabled=knows_disabled)
        for name, state in states.items()
        if control is not None and name not in refused and not _took(state, control)
    }
    not_asked = [name for name in map(str, sorted(missing)) if name not in refused]
    return DiscreteStates(states, not_taken, errors | refused, not_asked)


def _took(state: DiscreteState, control: Control) -> bool:
    if control in SWITCHES:
        return state.on == (control is Control.SET)
    return state.disabled == (control is Control.DISABLE)


def _why(name: str, state: DiscreteState, control: Control, *, knows_disabled: bool) -> str:
    """Why a command had no effect; ``knows_disabled`` if this protocol has 43."""
    if control not in SWITCHES or state.disabled:
        return "acknowledged, but nothing changed"
    if not knows_disabled:
        return "acknowledged, but nothing changed: it is disabled, an input, or the program writes it too"
    if name.startswith("X"):
        return f"an input follows its terminal; 'fatektool discrete disable {name}' holds it"
    return f"the program writes it too; 'fatektool discrete disable {name}' holds it"
