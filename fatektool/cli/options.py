"""The options that commands share, and the line to the PLC that they describe."""

from __future__ import annotations

from dataclasses import dataclass
from functools import wraps
from math import isnan
from pathlib import Path
from typing import TYPE_CHECKING, Any, TypeVar

import click

from fatektool.cli.output import Voice
from fatektool.errors import UsageError

if TYPE_CHECKING:
    from collections.abc import Callable
    from contextlib import ExitStack

    from fatektool.client import Plc
    from fatektool.protocol.commands import Command
    from fatektool.transport.base import Transport


class Seconds(click.FloatRange):
    """A time in seconds; click's range lets NaN through, which would be a wait for ever."""

    def convert(self, value: Any, param: click.Parameter | None, ctx: click.Context | None) -> Any:
        """Read the number; NaN is out of every range."""
        seconds = super().convert(value, param, ctx)
        if isnan(seconds):
            self.fail(f"{value!r} is no number of seconds", param, ctx)
        return seconds


class Several(click.ParamType):  # type: ignore[type-arg]  # a generic in the newest click only
    """Values with commas between them, each read by a type of its own."""

    def __init__(self, each: click.ParamType) -> None:  # type: ignore[type-arg]
        self.name = each.name
        self._each = each

    def convert(self, value: Any, param: click.Parameter | None, ctx: click.Context | None) -> Any:
        """Read each of them."""
        if isinstance(value, tuple):
            return value
        return tuple(self._each.convert(part.strip(), param, ctx) for part in value.split(","))


F = TypeVar("F", bound="Callable[..., Any]")

PATH = click.Path(path_type=Path)
PROTOCOLS = ("facon", "mseries")


@dataclass(frozen=True, slots=True)
class Connection:
    """Where the PLC is and how to talk to it, as the options say."""

    target: str
    station: int
    protocol: str
    baud: int
    format: str
    timeout_s: float
    retries: int
    lock_wait_s: float
    trace: Path | None

    def open(self, voice: Voice, *, needs: tuple[Command, ...] = ()) -> Plc:
        """Open the line, if the protocol has the commands that are needed."""
        from fatektool.connection import connect

        return connect(
            self.target,
            station=self.station,
            protocol=self.protocol,
            baud=self.baud,
            format=self.format,
            timeout_s=self.timeout_s,
            retries=self.retries,
            lock_wait_s=self.lock_wait_s,
            trace=self.trace,
            needs=needs,
            note=voice.detail,
        )

    def open_line(self, voice: Voice, stack: ExitStack) -> Transport:
        """Open the line alone, for who asks more than one PLC on it; ``stack`` closes it."""
        from fatektool.connection import open_line
        from fatektool.transport.base import LineSettings

        return open_line(
            self.target,
            stack,
            LineSettings(self.baud, self.format),
            protocol=self.protocol,
            station=self.station,
            lock_wait_s=self.lock_wait_s,
            trace=self.trace,
            note=voice.detail,
        )


def voice_options(function: F) -> F:
    """``--json``, ``-q``, ``-v``; the command gets ``voice``."""

    @click.option("--json", "as_json", is_flag=True, help="One JSON document on stdout, errors too.")
    @click.option("-q", "--quiet", is_flag=True, help="Nothing on stderr but warnings and errors.")
    @click.option("-v", "--verbose", is_flag=True, help="More on stderr.")
    @wraps(function)
    def with_voice(*args: Any, as_json: bool, quiet: bool, verbose: bool, **rest: Any) -> Any:
        return function(*args, voice=Voice(as_json, quiet, verbose), **rest)

    return with_voice  # type: ignore[return-value]  # click's decorators hand back what they get


def connection_options(function: F) -> F:
    """All that says where a PLC is; the command gets ``connection`` and ``voice``."""
    line_format = click.option(
        "--format",
        "line_format",
        metavar="7E1",
        help="Data bits, parity, stop bits.  [default: 7E1; 8E1 for mseries]",
    )
    return line_format(connection_options_but_format(function))


def connection_options_but_format(function: F) -> F:
    """The same for a command whose ``--format`` says more than the line's; it passes ``line_format`` on."""

    @click.option(
        "-p",
        "--port",
        metavar="TARGET",
        envvar="FATEKTOOL_PORT",
        help="Where the PLC is: /dev/ttyUSB0, COM3, tcp://HOST[:500], udp://HOST[:500], a pyserial URL, "
        "sim: (a simulated PLC) or sim:FILE.  [env: FATEKTOOL_PORT]",
    )
    @click.option(
        "-s", "--station", type=click.IntRange(1, 254), default=1, show_default=True, help="Its station."
    )
    @click.option(
        "--protocol",
        type=click.Choice(PROTOCOLS),
        default="facon",
        show_default=True,
        help="What the PLC speaks: facon (FB, FBE, FBN, FBs) or mseries (M-series).",
    )
    @click.option("--baud", type=int, default=9600, show_default=True, help="Speed of the serial line.")
    @click.option(
        "--timeout",
        type=Seconds(0, 3600, min_open=True),
        default=0.5,
        show_default=True,
        metavar="S",
        help="The PLC's time to answer, beside wire time.",
    )
    @click.option(
        "--retries",
        type=click.IntRange(0, 1000),
        default=3,
        show_default=True,
        help="Further tries of one exchange.",
    )
    @click.option(
        "--lock-wait",
        type=Seconds(0, 86400),
        default=10.0,
        show_default=True,
        metavar="S",
        help="How long to wait for a port that another process uses.",
    )
    @click.option("--trace", type=PATH, metavar="FILE", help="Record the wire: .pcap or .ndjson.")
    @voice_options
    @wraps(function)
    def with_connection(
        *args: Any,
        port: str | None,
        station: int,
        protocol: str,
        baud: int,
        line_format: str | None,
        timeout: float,
        retries: int,
        lock_wait: float,
        trace: Path | None,
        **rest: Any,
    ) -> Any:
        if not port:
            raise UsageError(
                "no PLC named", hint="give --port, such as -p /dev/ttyUSB0 or -p sim:, or set FATEKTOOL_PORT"
            )
        from fatektool.connection import usual_format

        form = usual_format(protocol) if line_format is None else line_format.upper()
        line = Connection(port, station, protocol, baud, form, timeout, retries, lock_wait, trace)
        return function(*args, connection=line, **rest)

    return with_connection  # type: ignore[return-value]  # as above


def yes_option(function: F) -> F:
    """``--yes``."""
    return click.option("--yes", is_flag=True, help="Do not ask.")(function)
