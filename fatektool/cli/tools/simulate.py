"""``simulate``: simulated PLCs, to test clients with."""

from __future__ import annotations

import re
import signal
import sys
from contextlib import suppress
from typing import TYPE_CHECKING, Any

import click

from fatektool.address import DEFAULT_FORMATS
from fatektool.cli.shared.options import PATH, completing, voice_options
from fatektool.cli.shared.output import print_json
from fatektool.cli.shared.pairs import apart, given, together
from fatektool.cli.tools.documents import simulate_document
from fatektool.cli.tools.start_values import StartValue, set_values, start_values
from fatektool.errors import UsageError
from fatektool.protocols import DEFAULT, PROTOCOLS
from fatektool.simulator.build import build_simulation
from fatektool.simulator.faults import PROBABILITY_KINDS
from fatektool.simulator.listen.servers import Server
from fatektool.simulator.models import MODELS
from fatektool.simulator.plc import FLAGS
from fatektool.simulator.slaves.registry import SLAVES
from fatektool.transport.base import LineSettings
from fatektool.transport.discovery import MODULE_PORT

if TYPE_CHECKING:
    from pathlib import Path

    from fatektool.cli.shared.output import Voice
    from fatektool.simulator.listen.base import Lines

_ADDRESS = re.compile(r"(?:\[([^\]]+)\]|([^:]*)):(\d{1,5})|(\d{1,5})", re.ASCII)

_DEFAULT_MODELS = ", ".join(f"{slave.model} with {name}" for name, slave in SLAVES.items())


@click.command(
    "simulate",
    epilog="Example: fatektool simulate --tcp 127.0.0.1:5000 --pty /tmp/plc --baud 9600 --fault drop=0.01",
)
@click.option("--tcp", multiple=True, metavar="HOST:PORT", help="Listen on TCP; port 0 selects a free one.")
@click.option("--udp", multiple=True, metavar="HOST:PORT", help="Listen on UDP.")
@click.option(
    "--discovery",
    multiple=True,
    metavar="HOST[:PORT]",
    help="Answer 'scan --network' as an Ethernet module does; the port is 111 unless named.",
)
@click.option(
    "--pty",
    multiple=True,
    metavar="LINK",
    help="Open a serial port (pty), with the symbolic link LINK to it.",
)
@click.option("--protocol", type=click.Choice(list(PROTOCOLS)), default=DEFAULT, show_default=True)
@click.option(
    "--station",
    multiple=True,
    type=click.IntRange(1, 254),
    metavar="N",
    help="Station of a PLC; repeat for more.",
)
@click.option(
    "--model",
    type=click.Choice(list(MODELS)),
    help=f"Model of the PLCs.  [default: {_DEFAULT_MODELS}]",
)
@click.option(
    "--ladder-words", type=click.IntRange(1, 65535), metavar="N", help="Size of the program memory."
)
@click.option("--program", type=PATH, metavar="BACKUP", help="Program of the PLCs.")
@click.option(
    "--program-seed",
    type=int,
    default=1,
    show_default=True,
    metavar="N",
    help="Seed of the demonstration program, without --program.",
)
@click.option(
    "--swap-program", is_flag=True, help="Exchange the bytes of each word of an FBs demonstration program."
)
@click.option("--state", type=PATH, metavar="FILE", help="Keep the PLCs' memory in FILE.")
@click.option(
    "--set",
    "states",
    multiple=True,
    type=StartValue(),
    help=f"Start with this value, such as R0=4660, or state: {', '.join(FLAGS)}. Repeat for more.",
)
@click.option("--memory", type=PATH, metavar="FILE", help="Start with the values in FILE, a snapshot.")
@click.option(
    "--baud",
    type=click.IntRange(50, 4_000_000),
    shell_complete=completing("complete_baud"),
    metavar="N",
    help="Baud rate: answers take their time on such a line.",
)
@click.option(
    "--strict-baud", is_flag=True, help="Understand a client of a pty only at the baud rate of --baud."
)
@click.option(
    "--line",
    "line_format",
    shell_complete=completing("complete_line"),
    metavar="7E1",
    help=f"Bits per character, for --baud.  [default: {DEFAULT_FORMATS}]",
)
@click.option("--format", "old_format", hidden=True)
@click.option(
    "--scan-ms", type=click.FloatRange(0, 60_000), default=0.0, metavar="MS", help="Time to answer."
)
@click.option(
    "--fault",
    multiple=True,
    metavar="KIND=P",
    shell_complete=completing("complete_fault"),
    help=f"A fault with probability P: {', '.join(PROBABILITY_KINDS)}; bit-errors=P, for each byte;"
    " power-cut=N, at the N-th write of a page.",
)
@click.option("--seed", type=int, default=0, show_default=True, metavar="N", help="Seed of the faults.")
@click.option(
    "--replay", type=PATH, metavar="TRACE", help="Answer as the PLC in TRACE, which --trace recorded."
)
@click.option(
    "--replay-speed",
    type=click.FloatRange(0, 1_000_000),
    metavar="N",
    help="10 for a tenth of the recorded delays, 0 for none.  [default: 1]",
)
@click.option(
    "--latency-timer",
    type=click.FloatRange(0, 10_000),
    default=0.0,
    metavar="MS",
    help="Send answers only every MS ms, as a USB adapter does (16).",
)
@click.option("--no-program-commands", is_flag=True, help="Refuse 4F and 50, as an FBs may.")
@click.option(
    "--no-error-character",
    is_flag=True,
    help="Answer 4F and 53 without the error character, as in the paper's figures.",
)
@voice_options
def simulate_command(
    voice: Voice,
    *,
    tcp: tuple[str, ...],
    udp: tuple[str, ...],
    discovery: tuple[str, ...],
    pty: tuple[str, ...],
    protocol: str,
    station: tuple[int, ...],
    model: str | None,
    ladder_words: int | None,
    program: Path | None,
    program_seed: int,
    swap_program: bool,
    state: Path | None,
    states: tuple[str, ...],
    memory: Path | None,
    baud: int | None,
    strict_baud: bool,
    line_format: str | None,
    old_format: str | None,
    scan_ms: float,
    fault: tuple[str, ...],
    seed: int,
    replay: Path | None,
    replay_speed: float | None,
    latency_timer: float,
    no_program_commands: bool,
    no_error_character: bool,
) -> None:
    """Simulate one or more PLCs with memory, to test clients with.

    Prints one line 'listening …' for each address, and ends on SIGTERM or Ctrl-C. Listens on 127.0.0.1 unless
    another host is given.

    Some faults are those of a line: wrong-line is noise instead of an answer, as with a wrong baud rate or
    format; twins are two PLCs with one station; bit-errors are in single bytes, so that longer answers have
    more of them. The same seed gives the same faults; docs/simulator.md describes each.
    """
    if not (tcp or udp or pty or discovery):
        raise UsageError(
            "no address to listen on", hint="give --tcp HOST:PORT, --udp HOST:PORT or --pty LINK"
        )
    addresses = [("tcp", address) for address in tcp] + [("udp", address) for address in udp]
    addresses += [
        ("discovery", address if ":" in address else f"{address}:{MODULE_PORT}") for address in discovery
    ]
    if replay is not None:
        from fatektool.cli.tools.replay import open_replay, tell_unknown

        speed = 1.0 if replay_speed is None else replay_speed
        recorded = open_replay(replay, protocol, speed, click.get_current_context(), voice)
        try:
            _serve(recorded, voice, addresses, pty)
        finally:
            tell_unknown(recorded, voice)
        return
    _require_effects(protocol, baud, fault)
    if strict_baud and (baud is None or not pty):
        raise UsageError("--strict-baud needs --pty and --baud")
    if replay_speed is not None:
        raise UsageError("--replay-speed needs --replay TRACE")
    values = start_values([each for each in states if each not in FLAGS], memory)
    simulation = build_simulation(
        station or None,
        model,
        protocol=protocol,
        **_program(program, ladder_words, state, voice),
        program_seed=program_seed,
        program_swapped=swap_program,
        program_commands=not no_program_commands,
        error_character=not no_error_character,
        state=state,
        faults=fault,
        seed=seed,
        baud=baud,
        bits_per_char=_bits_per_char(line_format or old_format),
        scan_ms=scan_ms,
        latency_timer_ms=latency_timer,
    )
    for plc in simulation.plcs.values():
        for state_name in states:
            if state_name in FLAGS:
                setattr(plc, state_name, True)
        set_values(plc, values)
    try:
        _serve(simulation, voice, addresses, pty, baud if strict_baud else None)
    finally:
        simulation.save_if_changed()


def _program(
    program: Path | None, ladder_words: int | None, state: Path | None, voice: Voice
) -> dict[str, Any]:
    """The program in the PLCs, as the options say."""
    if state is not None and state.exists():
        for name in ("program", "program_seed", "swap_program", "ladder_words"):
            if option := given(name):
                voice.warn(f"{option} only applies to a new file: the program in {state} is used")
    if program is None:
        return {} if ladder_words is None else {"ladder_words": ladder_words}
    from fatektool.program.archive import load_backup

    image = load_backup(program).program
    if ladder_words not in {None, image.ladder_words}:
        raise UsageError(f"--ladder-words {ladder_words}: the program has {image.ladder_words}")
    return {"program": image.pages, "ladder_words": image.ladder_words}


def _require_effects(protocol: str, baud: int | None, faults: tuple[str, ...]) -> None:
    """Refuse what would have no effect."""
    apart("program", "program_seed", "swap_program", why="they are for the demonstration program")
    apart("line_format", "old_format")
    for name in ("line_format", "old_format"):
        together(name, holds=baud is not None, needs="--baud")
    together("seed", holds=bool(faults), needs="--fault")
    together("no_error_character", holds=protocol == "facon", needs="--protocol facon")


def _serve(
    lines: Lines,
    voice: Voice,
    addresses: list[tuple[str, str]],
    links: tuple[str, ...],
    pty_baud: int | None = None,
) -> None:
    server = Server(lines)
    signal.signal(signal.SIGTERM, lambda *_: server.stop())
    try:
        make = {"tcp": server.open_tcp, "udp": server.open_udp, "discovery": server.open_discovery}
        opened = [make[kind](*_host_and_port(text)) for kind, text in addresses]
        opened += [server.open_pty(link, pty_baud) for link in links]
        if voice.json:
            print_json(simulate_document(listener.address for listener in opened))
        else:
            for listener in opened:
                click.echo(f"listening {listener.address}")
        sys.stdout.flush()
        with suppress(KeyboardInterrupt):  # the one way to end it by hand
            server.serve_until()
    finally:
        server.close()


def _bits_per_char(line_format: str | None) -> float | None:
    if line_format is None:
        return None
    line = LineSettings(9600, line_format.upper())
    return line.byte_time_s * line.baud


def _host_and_port(text: str) -> tuple[str, int]:
    match = _ADDRESS.fullmatch(text)
    if match is None or int(match[3] or match[4]) > 65535:
        raise UsageError(f"address {text[:60]!r}: expected HOST:PORT, such as 127.0.0.1:5000")
    return match[1] or match[2] or "127.0.0.1", int(match[3] or match[4])
