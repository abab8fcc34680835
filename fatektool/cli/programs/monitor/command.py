"""``monitor``: a program's networks beside what the PLC has now; why an element is on or off."""

from __future__ import annotations

import sys
from typing import TYPE_CHECKING, Final

import click

from fatektool.cli.programs.monitor.lines import print_rounds
from fatektool.cli.programs.monitor.screen import Screen
from fatektool.cli.programs.network_range import chosen
from fatektool.cli.programs.program_files import comments_at, comments_options, program_file, warn_of_code
from fatektool.cli.shared.connection_options import connection_options
from fatektool.cli.shared.options import PATH
from fatektool.cli.shared.pairs import apart
from fatektool.cli.shared.rounds import RoundTimes, failed_in_line, rounds_options
from fatektool.errors import FatektoolError, PlcError
from fatektool.jobs.monitor.live import LiveNetwork, Monitor

if TYPE_CHECKING:
    from pathlib import Path

    from fatektool.cli.shared.connection import Connection
    from fatektool.cli.shared.output import Voice


_INTERVAL_S: Final = 1.0
_INTERVAL_ON_SCREEN_S: Final = 0.25


@click.command("monitor", epilog="Example: fatektool monitor press.pdw --network 0-9 -p sim: --count 1")
@click.argument("file", type=PATH)
@click.option("--network", "wanted", multiple=True, metavar="N|N-M", help="Only these networks; repeat it.")
@click.option("--why", metavar="ELEMENT", help="Say why ELEMENT is on or off, once.")
@rounds_options("0.25 on a terminal, else 1")
@comments_options
@connection_options
def monitor_command(
    connection: Connection,
    voice: Voice,
    *,
    file: Path,
    wanted: tuple[str, ...],
    why: str | None,
    interval: float | None,
    count: int | None,
    comments: Path | None,
    encoding: str | None,
) -> int:
    """Show the networks of FILE, a backup or a WinProladder project, beside what the PLC has now.

    On a terminal the networks are drawn as a ladder: what carries is heavy, and elements and registers have
    their values. Arrows and PgUp, PgDn move between networks, / finds an element, q ends. Without a terminal,
    or with --json, it prints one NDJSON line a round.

    --why says in words why an element is on or off: what writes it, and which contacts on the way are open.

    The PLC is only read. A warning says so if its program is not the one in FILE, as far as that was
    compared: length and checksum of the code, and the pages with the networks that are shown.
    """
    apart("why", "wanted", "interval", "count", why="one element is asked for, once")
    found = program_file(file, voice, encoding)
    texts = comments_at(found, connection, comments, voice, encoding)
    networks = chosen(found.networks, wanted)
    warn_of_code(found, voice)
    if why is not None:
        from fatektool.cli.programs.monitor.why import explain
        from fatektool.jobs.monitor.why import Question

        is_whole = explain(connection, voice, found, Question(found.require_code(), why), texts.elements)
        return 0 if is_whole else PlcError.exit_code
    on_screen = sys.stdout.isatty() and not voice.json
    default_s = _INTERVAL_ON_SCREEN_S if on_screen else _INTERVAL_S
    pace = RoundTimes(default_s if interval is None else interval, count)
    live = [LiveNetwork(network) for network in networks]
    try:
        with connection.open(voice, lend=True) as plc:
            if on_screen:
                screen = Screen(plc, found, live, texts, pace)
                try:
                    screen.run()
                finally:
                    screen.say_of_program(voice)
                return 0
            monitor = Monitor(plc, found, live, live if wanted else ())
            is_whole = print_rounds(plc, monitor, pace, voice)
    except (FatektoolError, KeyboardInterrupt) as error:
        if not voice.json:
            raise
        return failed_in_line(error)
    return 0 if is_whole else PlcError.exit_code
