"""``discrete``: single discretes, enabled, disabled, set and reset (42), and listed (43, 44).

Protocols without disabled discretes have set, reset and list.
"""

from __future__ import annotations

from typing import TYPE_CHECKING

import click

from fatektool.cli.elements.documents import discrete_document
from fatektool.cli.elements.values import warn_of
from fatektool.cli.shared.addressee import look
from fatektool.cli.shared.broadcast import broadcast_option, means_all, send_to_all
from fatektool.cli.shared.connection_options import connection_options
from fatektool.cli.shared.modbus_map import modbus_map_option
from fatektool.cli.shared.options import completing, yes_option
from fatektool.errors import PlcError
from fatektool.jobs.elements.discretes import SWITCHES, control_discretes, parse_discretes, read_discretes
from fatektool.protocol.commands import Command, Control, ControlDiscrete

if TYPE_CHECKING:
    from collections.abc import Mapping

    from fatektool.cli.shared.addressee import Addressee
    from fatektool.cli.shared.connection import Connection
    from fatektool.cli.shared.output import Voice
    from fatektool.client import Plc
    from fatektool.jobs.elements.discretes import DiscreteState, DiscreteStates


@click.group("discrete", epilog="Example: fatektool discrete disable X16 -p sim:")
def discrete_command() -> None:
    """Enable, disable, set and reset single discretes, and list their state.

    A disabled discrete keeps its state, whatever the program or the terminal does, until it is enabled again.
    """


def _control(name: str, control: Control, text: str) -> None:
    """Make one of the four commands; enable and disable need to read the state back (43)."""
    needs: tuple[Command, ...] = (Command.CONTROL_DISCRETE,)
    if control not in SWITCHES:
        needs += (Command.READ_DISABLED,)

    @discrete_command.command(name, help=text, epilog=f"Example: fatektool discrete {name} M16 Y0-Y3 -p sim:")
    @click.argument("elements", nargs=-1, shell_complete=completing("complete_elements"), required=True)
    @broadcast_option
    @yes_option
    @connection_options
    @modbus_map_option
    def command(
        elements: tuple[str, ...], connection: Connection, voice: Voice, *, broadcast: bool, yes: bool
    ) -> int:
        wanted = parse_discretes(elements)
        if means_all(connection, broadcast=broadcast):
            requests = [ControlDiscrete(control, element) for element in wanted]
            send_to_all(connection, voice, f"discrete {name}", requests, yes=yes)
            return 0
        with connection.open(voice, needs=needs, writes=True) as plc:
            found = control_discretes(plc, wanted, control)
            return _show(plc, found, voice, look(plc))


_control("enable", Control.ENABLE, "Enable discretes: the program or the terminal controls them again.")
_control(
    "disable",
    Control.DISABLE,
    "Disable discretes: they keep their state, whatever the program does; 'set' and 'reset' switch them.",
)
_control("set", Control.SET, "Switch discretes on.")
_control("reset", Control.RESET, "Switch discretes off.")


@discrete_command.command("list", epilog="Example: fatektool discrete list Y10-Y16 -p sim:")
@click.argument("elements", nargs=-1, shell_complete=completing("complete_elements"), required=True)
@connection_options
@modbus_map_option
def list_command(elements: tuple[str, ...], connection: Connection, voice: Voice) -> int:
    """Show which discretes are on, and which are disabled."""
    wanted = parse_discretes(elements)
    with connection.open(voice) as plc:
        return _show(plc, read_discretes(plc, wanted), voice)


def _show(plc: Plc, found: DiscreteStates, voice: Voice, here: Addressee | None = None) -> int:
    """Print the states, then what was refused and what had no effect.

    Args:
        plc: the PLC.
        found: the discretes.
        voice: prints.
        here: the PLC that was written to; None if nothing was written.
    """
    voice.show(
        discrete_document(plc, found, here),
        [*_lines(found.states), *([] if here is None else [here.line])],
    )
    warn_of({name: f"no effect: {why}" for name, why in found.not_taken.items()}, voice)
    warn_of(found.errors, voice, found.not_asked)
    return PlcError.exit_code if found.errors or found.not_taken else 0


def _lines(states: Mapping[str, DiscreteState]) -> list[str]:
    width = max(map(len, states), default=0)
    held = {True: "DISABLED", False: "enabled", None: ""}
    return [
        f"{name:<{width}}  {'on' if state.on else 'off':<3}  {held[state.disabled]}".rstrip()
        for name, state in states.items()
    ]
