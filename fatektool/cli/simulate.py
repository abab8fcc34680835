"""``simulate``: a PLC for others to test against."""

from __future__ import annotations

import re
import signal
import sys
from typing import TYPE_CHECKING, Any

import click

from fatektool.cli.options import PATH, PROTOCOLS, voice_options
from fatektool.cli.output import print_json
from fatektool.errors import UsageError
from fatektool.simulator.build import build_simulation
from fatektool.simulator.faults import PROBABILITY_KINDS
from fatektool.simulator.models import DEFAULT_MODEL, MODELS
from fatektool.simulator.plc import FLAGS
from fatektool.simulator.servers import Server
from fatektool.transport.base import LineSettings

if TYPE_CHECKING:
    from pathlib import Path

    from fatektool.cli.output import Voice
    from fatektool.simulator.build import Simulation

_DOOR = re.compile(r"(?:\[([^\]]+)\]|([^:]*)):(\d{1,5})|(\d{1,5})", re.ASCII)


@click.command(
    "simulate",
    epilog="Example: fatektool simulate --tcp 127.0.0.1:5000 --pty /tmp/plc --baud 9600 --fault drop=0.01",
)
@click.option("--tcp", multiple=True, metavar="HOST:PORT", help="Listen on TCP; port 0 picks a free one.")
@click.option("--udp", multiple=True, metavar="HOST:PORT", help="Listen on UDP.")
@click.option("--pty", multiple=True, metavar="LINK", help="Be a serial port: a pty, LINK leads to it.")
@click.option("--protocol", type=click.Choice(PROTOCOLS), default="facon", show_default=True)
@click.option("--station", multiple=True, type=click.IntRange(1, 254), help="A station; may be repeated.")
@click.option(
    "--model", type=click.Choice(list(MODELS)), help=f"What the PLCs are.  [default: {DEFAULT_MODEL}]"
)
@click.option("--ladder-words", type=click.IntRange(1, 65535), help="Another size of the program memory.")
@click.option("--program", type=PATH, metavar="BACKUP", help="The program in the PLCs.")
@click.option(
    "--program-seed",
    type=int,
    default=1,
    show_default=True,
    help="Which demonstration program, without BACKUP.",
)
@click.option("--state", type=PATH, metavar="FILE", help="Keep the PLCs' memory in FILE.")
@click.option(
    "--set", "flags", multiple=True, type=click.Choice(FLAGS), help="A state of the PLCs; repeat for more."
)
@click.option("--baud", type=click.IntRange(50, 4_000_000), help="Pace the line.")
@click.option(
    "--format", "line_format", default="7E1", show_default=True, help="Bits a character, for the pace."
)
@click.option("--scan-ms", type=click.FloatRange(0, 60_000), default=0.0, help="Time to answer.")
@click.option(
    "--fault",
    multiple=True,
    metavar="KIND=P",
    help=f"Go wrong with probability P: {', '.join(PROBABILITY_KINDS)}; power-cut=N.",
)
@click.option("--seed", type=int, default=0, show_default=True, help="Of the faults.")
@click.option("--no-program-commands", is_flag=True, help="Refuse 4F and 50, as some FBs units do.")
@click.option("--no-error-character", is_flag=True, help="Answer 4F and 53 as the paper's figures draw them.")
@voice_options
def simulate_command(
    voice: Voice,
    *,
    tcp: tuple[str, ...],
    udp: tuple[str, ...],
    pty: tuple[str, ...],
    protocol: str,  # noqa: ARG001  # one protocol so far; the option is the contract's
    station: tuple[int, ...],
    model: str | None,
    ladder_words: int | None,
    program: Path | None,
    program_seed: int,
    state: Path | None,
    flags: tuple[str, ...],
    baud: int | None,
    line_format: str,
    scan_ms: float,
    fault: tuple[str, ...],
    seed: int,
    no_program_commands: bool,
    no_error_character: bool,
) -> None:
    """Be one or more PLCs with memory, for clients to be tested against.

    Prints one line 'listening …' for each door, and ends on SIGTERM or Ctrl-C. Binds to 127.0.0.1 unless told
    otherwise.
    """
    if not (tcp or udp or pty):
        raise UsageError("no door named", hint="give --tcp HOST:PORT, --udp HOST:PORT or --pty LINK")
    wanted: dict[str, Any] = {}
    if program is not None:
        from fatektool.program.archive import load_backup

        image = load_backup(program).program
        if ladder_words not in {None, image.ladder_words}:
            raise UsageError(f"--ladder-words {ladder_words}: the program has {image.ladder_words}")
        wanted = {"program": image.pages, "ladder_words": image.ladder_words}
    elif ladder_words is not None:
        wanted = {"ladder_words": ladder_words}
    simulation = build_simulation(
        station or None,
        model,
        **wanted,
        program_seed=program_seed,
        program_commands=not no_program_commands,
        error_character=not no_error_character,
        state=state,
        faults=fault,
        seed=seed,
        baud=baud,
        bits_per_char=LineSettings(9600, line_format.upper()).byte_time_s * 9600,
        scan_ms=scan_ms,
    )
    for plc in simulation.plcs.values():
        for flag in flags:
            setattr(plc, flag, True)
    _serve(simulation, voice, [("tcp", door) for door in tcp] + [("udp", door) for door in udp], pty)


def _serve(
    simulation: Simulation, voice: Voice, doors: list[tuple[str, str]], links: tuple[str, ...]
) -> None:
    server = Server(simulation)
    signal.signal(signal.SIGTERM, lambda *_: server.stop())
    try:
        opened = [
            (server.open_tcp if kind == "tcp" else server.open_udp)(*_host_and_port(text))
            for kind, text in doors
        ]
        opened += [server.open_pty(link) for link in links]
        if voice.json:
            addresses = [door.address for door in opened]
            print_json({"schema": "fatektool.simulate/1", "listening": addresses})
        else:
            for door in opened:
                click.echo(f"listening {door.address}")
        sys.stdout.flush()
        server.serve_until()
    finally:
        server.close()
        simulation.save_if_changed()


def _host_and_port(text: str) -> tuple[str, int]:
    match = _DOOR.fullmatch(text)
    if match is None or int(match[3] or match[4]) > 65535:
        raise UsageError(f"door {text[:60]!r}: expected HOST:PORT, such as 127.0.0.1:5000")
    return match[1] or match[2] or "127.0.0.1", int(match[3] or match[4])
