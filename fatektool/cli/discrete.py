"""``discrete``: single discretes, enabled, disabled, set and reset (42), and listed (43, 44)."""

from __future__ import annotations

from typing import TYPE_CHECKING

import click

from fatektool.batch import ask_all
from fatektool.cli.documents import where
from fatektool.cli.options import Connection, connection_options
from fatektool.errors import PlcError, UsageError
from fatektool.jobs.registers import read_elements
from fatektool.jobs.selection import parse_items
from fatektool.protocol.commands import Control, ControlDiscrete, ReadDisabled

if TYPE_CHECKING:
    from fatektool.cli.output import Voice
    from fatektool.client import Plc
    from fatektool.protocol.elements import Element


@click.group("discrete", epilog="Example: fatektool discrete disable X16 -p /dev/ttyUSB0")
def discrete_command() -> None:
    """Enable, disable, set and reset single discretes, and list their state.

    A disabled discrete keeps its state, whatever the program or the terminal says, until it is enabled again.
    """


def _control(name: str, control: Control, text: str) -> None:
    @discrete_command.command(name, help=text, epilog=f"Example: fatektool discrete {name} X16 Y0-Y3 -p sim:")
    @click.argument("elements", nargs=-1, required=True)
    @connection_options
    def command(elements: tuple[str, ...], connection: Connection, voice: Voice) -> None:
        wanted = _discretes(elements)
        with connection.open(voice) as plc:
            for element in wanted:
                plc.link.ask(ControlDiscrete(control, element))
            states = _states(plc, wanted)
            document = {"schema": "fatektool.discrete/1", **where(plc), "discretes": states}
        voice.show(document, _lines(states))


_control("enable", Control.ENABLE, "Give discretes back to the program.")
_control("disable", Control.DISABLE, "Hold discretes as they are, whatever the program does.")
_control("set", Control.SET, "Switch discretes on.")
_control("reset", Control.RESET, "Switch discretes off.")


@discrete_command.command("list", epilog="Example: fatektool discrete list Y10-Y16 -p sim:")
@click.argument("elements", nargs=-1, required=True)
@connection_options
def list_command(elements: tuple[str, ...], connection: Connection, voice: Voice) -> None:
    """Show which discretes are on, and which are disabled."""
    wanted = _discretes(elements)
    with connection.open(voice) as plc:
        states = _states(plc, wanted)
        document = {"schema": "fatektool.discrete/1", **where(plc), "discretes": states}
    voice.show(document, _lines(states))


def _discretes(texts: tuple[str, ...]) -> list[Element]:
    elements = [item.element for item in parse_items(texts)]
    for element in elements:
        if element.kind.bits != 1:
            raise UsageError(f"{element} is no discrete: expected X, Y, M, S, T or C")
    return elements


def _states(plc: Plc, elements: list[Element]) -> dict[str, dict[str, bool]]:
    """On and disabled, by element; what the PLC refuses ends it."""
    on = read_elements(plc, elements)
    for element, error in on.errors.items():
        raise PlcError(f"{element}: {error}", hint="'fatektool status' shows how many this PLC has")
    requests = [ReadDisabled(first, count) for first, count in _runs(elements)]
    disabled: dict[Element, bool] = {}
    for request, answer in zip(requests, ask_all(plc.link, requests), strict=True):
        disabled |= {request.first.after(place): bit for place, bit in enumerate(answer)}
    return {
        str(element): {"on": bool(on.values[element]), "disabled": disabled[element]} for element in elements
    }


def _runs(elements: list[Element]) -> list[tuple[Element, int]]:
    """Neighbours together, 256 at most."""
    runs: list[tuple[Element, int]] = []
    for element in sorted(set(elements)):
        if runs:
            first, count = runs[-1]
            if count < 256 and (element.symbol, element.address) == (first.symbol, first.address + count):
                runs[-1] = (first, count + 1)
                continue
        runs.append((element, 1))
    return runs


def _lines(states: dict[str, dict[str, bool]]) -> list[str]:
    width = max(map(len, states), default=0)
    held = {True: "DISABLED", False: "enabled"}
    return [
        f"{name:<{width}}  {'on' if state['on'] else 'off':<3}  {held[state['disabled']]}"
        for name, state in states.items()
    ]
