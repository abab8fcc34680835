"""``simulate --replay``: a recorded PLC, from the trace file to the messages at its end."""

from __future__ import annotations

from typing import TYPE_CHECKING, Final

from click.core import ParameterSource

from fatektool.counts import counted
from fatektool.errors import DataError, UsageError
from fatektool.files.atomic import read_bounded
from fatektool.protocols import PROTOCOLS
from fatektool.simulator.replay import Recorded, Replay
from fatektool.transport.trace import SENT
from fatektool.transport.trace_reader import read_trace

if TYPE_CHECKING:
    from pathlib import Path

    import click

    from fatektool.cli.shared.output import Voice
    from fatektool.simulator.slaves.base import RequestFrame

_MAX_TRACE = 256 << 20
_MOST_NAMED: Final = 3
OF_A_REPLAY: Final = {
    *("replay", "replay_speed", "tcp", "udp", "pty", "protocol"),
    *("as_json", "quiet", "verbose"),
}


def open_replay(path: Path, protocol: str, speed: float, context: click.Context, voice: Voice) -> Replay:
    """The PLC of a recording.

    Args:
        path: the trace file.
        protocol: that of the trace, if the trace does not name it or the user gives one.
        speed: see ``Replay``.
        context: of the command, to see what options were given.
        voice: prints requests that are not in the trace.

    Raises:
        UsageError: an option that only a simulated PLC has, or no such file.
        DataError: a damaged or foreign file, or no request in it.
    """
    for parameter in context.command.params:
        given = context.get_parameter_source(parameter.name or "")
        if parameter.name not in OF_A_REPLAY and given is not ParameterSource.DEFAULT:
            raise UsageError(
                f"{parameter.opts[0]} does not go with --replay: the PLC's settings are those of the trace",
                hint="leave one of them out",
            )
    trace = list(read_trace(read_bounded(path, _MAX_TRACE), str(path)))
    if context.get_parameter_source("protocol") is ParameterSource.DEFAULT:
        protocol = next((record.protocol for record in trace if record.protocol in PROTOCOLS), protocol)
    records = [Recorded(record.time_s, record.direction == SENT, record.data) for record in trace]
    try:
        return Replay(
            records,
            protocol,
            speed=speed,
            on_unknown=lambda request: voice.detail(f"not in the trace: {_named(request)}"),
        )
    except DataError as error:
        raise DataError(f"{path}: {error.message}", hint=error.hint) from error


def tell_unknown(replay: Replay, voice: Voice) -> None:
    """Print the requests that are not in the trace: the most frequent ones by name."""
    if not replay.unknown_count:
        return
    often = sorted(replay.unknown.items(), key=lambda item: -item[1])
    names = [_named(request) + (f" ({count} times)" if count > 1 else "") for request, count in often]
    more = ["…"] if len(names) > _MOST_NAMED else []
    voice.say(
        f"{counted(replay.unknown_count, 'request')} not in the trace, not answered:"
        f" {', '.join(names[:_MOST_NAMED] + more)}"
    )


def _named(request: RequestFrame) -> str:
    data = _text(request.data)
    return f"station {request.station} {_text(request.command)}{f' {data}' if data else ''}"


def _text(data: bytes) -> str:
    """Characters if all of them can be read, else hex; no more than a line has space for."""
    readable = all(0x20 < byte < 0x7F for byte in data)
    text = data.decode("ascii") if readable else data.hex().upper()
    return text if len(text) <= 40 else f"{text[:32]}… ({len(data)} bytes)"
