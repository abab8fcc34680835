"""``discrete``: single discretes, enabled, disabled, set and reset (42), and listed (43, 44).

Over a protocol that cannot say what is disabled, they are switched and listed all the same.
"""

from __future__ import annotations

from typing import TYPE_CHECKING

import click

from fatektool.cli.elements.read import warn_of
from fatektool.cli.shared.addressee import look
from fatektool.cli.shared.broadcast import broadcast_option, means_all, send_to_all
from fatektool.cli.shared.documents import where
from fatektool.cli.shared.modbus_map import modbus_map_option
from fatektool.cli.shared.options import Connection, connection_options, yes_option
from fatektool.errors import PlcError, PlcRefused, UsageError
from fatektool.jobs.elements.disabled import read_disabled
from fatektool.jobs.elements.reads import read_elements
from fatektool.jobs.elements.selection import parse_items
from fatektool.protocol.commands import Command, Control, ControlDiscrete

if TYPE_CHECKING:
    from fatektool.cli.shared.output import Voice
    from fatektool.client import Plc
    from fatektool.protocol.elements import Element


@click.group("discrete", epilog="Example: fatektool discrete disable X16 -p /dev/ttyUSB0")
def discrete_command() -> None:
    """Enable, disable, set and reset single discretes, and list their state.

    A disabled discrete keeps its state, whatever the program or the terminal says, until it is enabled again.
    """


def _control(name: str, control: Control, text: str) -> None:
    """Make one of the four; what disables must be able to show it."""
    switches = control in {Control.SET, Control.RESET}
    needs = (Command.CONTROL_DISCRETE,) if switches else (Command.CONTROL_DISCRETE, Command.READ_DISABLED)

    @discrete_command.command(name, help=text, epilog=f"Example: fatektool discrete {name} X16 Y0-Y3 -p sim:")
    @click.argument("elements", nargs=-1, required=True)
    @broadcast_option
    @yes_option
    @connection_options
    @modbus_map_option
    def command(
        elements: tuple[str, ...], connection: Connection, voice: Voice, *, broadcast: bool, yes: bool
    ) -> int:
        wanted = _discretes(elements)
        if means_all(connection, broadcast=broadcast):
            requests = [ControlDiscrete(control, element) for element in wanted]
            send_to_all(connection, voice, f"discrete {name}", requests, yes=yes)
            return 0
        with connection.open(voice, needs=needs, writes=True) as plc:
            refused = {}
            for element in wanted:
                try:
                    plc.link.ask(ControlDiscrete(control, element))
                except PlcRefused as error:
                    refused[str(element)] = error.message
            return _show(plc, wanted, voice, refused, control)


_control("enable", Control.ENABLE, "Give discretes back to the program.")
_control(
    "disable",
    Control.DISABLE,
    "Hold discretes as they are, whatever the program does; 'set' and 'reset' still switch them.",
)
_control("set", Control.SET, "Switch discretes on.")
_control("reset", Control.RESET, "Switch discretes off.")


@discrete_command.command("list", epilog="Example: fatektool discrete list Y10-Y16 -p sim:")
@click.argument("elements", nargs=-1, required=True)
@connection_options
@modbus_map_option
def list_command(elements: tuple[str, ...], connection: Connection, voice: Voice) -> int:
    """Show which discretes are on, and which are disabled."""
    wanted = _discretes(elements)
    with connection.open(voice) as plc:
        return _show(plc, wanted, voice, {})


def _discretes(texts: tuple[str, ...]) -> list[Element]:
    elements = [item.element for item in parse_items(texts)]
    for element in elements:
        if element.kind.bits != 1:
            raise UsageError(f"{element} is no discrete: expected X, Y, M, S, T or C")
    return elements


def _show(
    plc: Plc, elements: list[Element], voice: Voice, refused: dict[str, str], control: Control | None = None
) -> int:
    """Read the discretes back, show them, and say what was refused and what did not take.

    Args:
        plc: the PLC.
        elements: discretes.
        voice: says it.
        refused: by name: what the PLC said to the control.
        control: what was asked of them; None for nothing.
    """
    on = read_elements(plc, elements)
    flags, held = read_disabled(plc, on.values)
    tells = Command.READ_DISABLED in plc.link.codec.commands
    switched = control in {Control.SET, Control.RESET}
    asked_itself = switched or not tells  # whether they are disabled is only shown beside it
    unread = {str(element): error for element, error in on.errors.items()}
    if not asked_itself:
        unread |= {str(element): error for element, error in held.errors.items()}
    if control is not None:
        unread = {
            name: f"acknowledged, but not proven: it cannot be read back: {error}"
            for name, error in unread.items()
        }
    missing = on.not_asked if asked_itself else on.not_asked | held.not_asked
    not_asked = [name for name in map(str, sorted(missing)) if name not in refused]
    states: dict[str, dict[str, bool | None]] = {
        str(element): {"on": bool(on.values[element]), "disabled": flags.get(element)}
        for element in elements
        if element in (on.values if asked_itself else flags)
    }
    not_taken = {
        name: _why(name, state["disabled"], control, holds=tells)
        for name, state in states.items()
        if control is not None and name not in refused and not _took(state, control)
    }
    unread |= refused
    here = look(plc) if control is not None else None
    document = {
        "schema": "fatektool.discrete/1",
        **where(plc),
        **({} if here is None else here.document()),
        "discretes": states,
        "not_taken": not_taken,
        "errors": unread,
        "not_asked": not_asked,
    }
    voice.show(document, [*_lines(states), *([] if here is None else [here.line])])
    warn_of({name: f"did not take: {why}" for name, why in not_taken.items()}, voice)
    warn_of(unread, voice, not_asked)
    return PlcError.exit_code if unread or not_taken else 0


def _took(state: dict[str, bool | None], control: Control) -> bool:
    if control in {Control.SET, Control.RESET}:
        return state["on"] == (control is Control.SET)
    return state["disabled"] == (control is Control.DISABLE)


def _why(name: str, disabled: bool | None, control: Control, *, holds: bool) -> str:
    """Why a discrete is not as it was asked to be; ``holds`` if this protocol could hold it."""
    if control not in {Control.SET, Control.RESET} or disabled:
        return "acknowledged, and nothing changed"
    if not holds:
        return "acknowledged, and nothing changed: it is disabled, an input, or the program writes it too"
    if name.startswith("X"):
        return f"an input follows its terminal; 'fatektool discrete disable {name}' holds it"
    return f"the program writes it too; 'fatektool discrete disable {name}' holds it"


def _lines(states: dict[str, dict[str, bool | None]]) -> list[str]:
    width = max(map(len, states), default=0)
    held = {True: "DISABLED", False: "enabled", None: ""}
    return [
        f"{name:<{width}}  {'on' if state['on'] else 'off':<3}  {held[state['disabled']]}".rstrip()
        for name, state in states.items()
    ]
