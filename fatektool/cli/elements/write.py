"""``write``: elements of any kind."""

from __future__ import annotations

from typing import TYPE_CHECKING

import click

from fatektool.cli.elements.documents import write_document
from fatektool.cli.elements.values import shown, warn_of
from fatektool.cli.shared.addressee import look
from fatektool.cli.shared.broadcast import broadcast_option, means_all, send_to_all
from fatektool.cli.shared.connection_options import connection_options
from fatektool.cli.shared.modbus_map import modbus_map_option
from fatektool.cli.shared.options import completing, yes_option
from fatektool.counts import counted
from fatektool.errors import PlcError
from fatektool.jobs.elements.assignment import parse_assignments, write_assignments
from fatektool.jobs.elements.items import value_of
from fatektool.planner import plan_writes

if TYPE_CHECKING:
    from fatektool.cli.shared.connection import Connection
    from fatektool.cli.shared.output import Voice
    from fatektool.jobs.elements.selection import Item
    from fatektool.jobs.elements.writes import NotTaken


@click.command("write", epilog="Example: fatektool write R12=4261 WM8=0x5555 DR2=-1 D4:f32=1.5 Y0=on -p sim:")
@click.argument(
    "assignments",
    nargs=-1,
    shell_complete=completing("complete_elements"),
    required=True,
    metavar="ELEMENT=VALUE…",
)
@broadcast_option
@yes_option
@connection_options
@modbus_map_option
def write_command(
    assignments: tuple[str, ...], connection: Connection, voice: Voice, *, broadcast: bool, yes: bool
) -> int:
    """Write elements of any kind, and read them back.

    A value that the PLC does not keep is reported (exit 4): of a disabled discrete, of a read-only register,
    of a register that the program writes too. A range gets one value for all its elements, or one for each:
    R0:3=1,2,3.

    There is no question, except before a broadcast.
    """
    pairs = parse_assignments(assignments)
    if means_all(connection, broadcast=broadcast):
        requests = plan_writes([(item.element, raw) for item, raw in pairs], connection.address.codec)
        send_to_all(connection, voice, "write", requests, yes=yes)
        return 0
    items = {item.element: item for item, _ in pairs}
    with connection.open(voice, writes=True) as plc:
        failed = write_assignments(plc, pairs)
        here = look(plc)
        document = write_document(plc, here, items, failed)
    taken = len(pairs) - len(failed)
    lines = [f"{taken} of {counted(len(pairs), 'element')} written and read back", here.line]
    voice.show(document, lines)
    warn_of({items[each.element].key: _words(items[each.element], each) for each in failed}, voice)
    return PlcError.exit_code if failed else 0


def _words(item: Item, each: NotTaken) -> str:
    return each.words(lambda raw: shown(value_of(item, raw)))
