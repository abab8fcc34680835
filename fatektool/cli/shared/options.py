"""The options that commands share, and the line to the PLC that they describe."""

from __future__ import annotations

from dataclasses import dataclass, replace
from functools import wraps
from math import isnan
from typing import TYPE_CHECKING, Any, Literal, TypeVar

import click
from click.core import ParameterSource

from fatektool.cli.shared.file_path import FilePath
from fatektool.cli.shared.inventory_file import complete_target, inventory_option, plc_named
from fatektool.cli.shared.output import Voice
from fatektool.cli.shared.station import Station, require_station
from fatektool.cli.shared.unfinished import warn_of_unfinished
from fatektool.errors import LineReadOnly, UsageError
from fatektool.protocols import DEFAULT, PROTOCOLS

if TYPE_CHECKING:
    from collections.abc import Callable
    from contextlib import ExitStack
    from pathlib import Path

    from fatektool.client import Plc
    from fatektool.inventory.entries import PlcEntry
    from fatektool.protocol.commands import Command
    from fatektool.protocol.modbus.map import ModbusMap
    from fatektool.transport.base import Transport
    from fatektool.transport.limit import Limit
    from fatektool.transport.shared_line import SharedLine


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

PATH = FilePath()
USUAL_FORMATS = "7E1; 8E1 for mseries and modbus-rtu"
_IN_INVENTORY = {
    "station": "station",
    "protocol": "protocol",
    "baud": "baud",
    "timeout": "timeout_s",
    "retries": "retries",
    "lock_wait": "lock_wait_s",
}


@dataclass(frozen=True, slots=True)
class Connection:
    """Where the PLC is and how to talk to it, as the options and the inventory say."""

    target: str
    station: int
    protocol: str
    baud: int
    format: str
    timeout_s: float
    retries: int
    lock_wait_s: float
    trace: Path | None
    entry: PlcEntry | None = None
    read_only: bool = False
    modbus_map: ModbusMap | Literal["custom"] | None = None
    low_latency: bool = True

    def open(
        self,
        voice: Voice,
        *,
        needs: tuple[Command, ...] = (),
        writes: bool = False,
        limit: Limit | None = None,
        lend: bool = False,
        shared: SharedLine | None = None,
        finishes: bool = False,
    ) -> Plc:
        """Open the line to one PLC.

        Args:
            voice: is told what a curious user may want to know.
            needs: commands that the protocol must have.
            writes: True if something is to be written, which a read-only line refuses before it is opened.
            limit: ends everything on this line when it is over.
            lend: others may have the line between two rounds.
            shared: keeps the line open for the next PLC on it.
            finishes: no warning of a restore that did not complete, as this may finish it.

        Raises:
            LineReadOnly: something is to be written to a line that may only be read.
            UsageError: the protocol lacks what is needed.
            LineError: it cannot be opened.
        """
        from fatektool.connection import connect

        if writes and self.read_only:
            raise LineReadOnly(f"'{click.get_current_context().command_path}' writes")
        wait_s = self.lock_wait_s if limit is None else min(self.lock_wait_s, limit.require_rest())
        plc = connect(
            self.target,
            station=self.station,
            protocol=self.protocol,
            baud=self.baud,
            format=self.format,
            timeout_s=self.timeout_s,
            retries=self.retries,
            lock_wait_s=wait_s,
            trace=self.trace,
            needs=needs,
            limit=limit,
            read_only=self.read_only,
            modbus_map=self.modbus_map,
            low_latency=self.low_latency,
            lend=lend,
            shared=shared,
            note=voice.detail,
            waiting=voice.say,
            warn=voice.warn,
        )
        if not finishes:
            warn_of_unfinished(self.target, self.station, voice)
        return plc

    def open_line(self, voice: Voice, stack: ExitStack) -> Transport:
        """Open the line alone, for who asks more than one PLC on it; ``stack`` closes it."""
        from fatektool.connection import open_line
        from fatektool.transport.base import LineSettings
        from fatektool.transport.patience import Patience

        return open_line(
            self.target,
            stack,
            line=LineSettings(self.baud, self.format),
            protocol=self.protocol,
            station=self.station,
            lock_wait_s=self.lock_wait_s,
            trace=self.trace,
            low_latency=self.low_latency,
            note=voice.detail,
            waiting=voice.say,
            patience=Patience(self.timeout_s, self.retries, note=voice.detail),
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
        help=f"Data bits, parity, stop bits.  [default: {USUAL_FORMATS}]",
    )
    return line_format(connection_options_but_format(function))


def connection_options_but_format(function: F) -> F:
    """The same for a command whose ``--format`` says more than the line's; it passes ``line_format`` on."""

    @click.option(
        "-p",
        "--port",
        metavar="TARGET",
        envvar="FATEKTOOL_PORT",
        shell_complete=complete_target,
        help="Where the PLC is: /dev/ttyUSB0, COM3, tcp://HOST[:500], udp://HOST[:500], rfc2217://HOST:PORT, "
        "modem:/dev/ttyUSB0?number=0228082192, sim: (a simulated PLC), sim:FILE, "
        "or its name in the inventory.  [env: FATEKTOOL_PORT]",
    )
    @inventory_option
    @click.option("-s", "--station", type=Station(1, 254), default=1, show_default=True, help="Its station.")
    @click.option(
        "--protocol",
        type=click.Choice(list(PROTOCOLS)),
        default=DEFAULT,
        show_default=True,
        help="What the PLC speaks: facon (FB, FBE, FBN, FBs), mseries (M-series), or Modbus (FBs).",
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
    @click.option(
        "--low-latency/--no-low-latency",
        default=True,
        show_default=True,
        help="Ask the driver of a serial port to hand on at once what it receives, on Linux.",
    )
    @click.option("--trace", type=PATH, metavar="FILE", help="Record the wire: .pcap or .ndjson.")
    @click.option(
        "--read-only",
        is_flag=True,
        envvar="FATEKTOOL_READ_ONLY",
        help="Refuse whatever would write to the PLC.  [env: FATEKTOOL_READ_ONLY]",
    )
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
        low_latency: bool,
        trace: Path | None,
        read_only: bool,
        inventory: Path | None,
        **rest: Any,
    ) -> Any:
        if not port and rest.get("network"):
            port = f"udp://{rest['network']}"  # a scan of a network has no other target
        if not port:
            raise UsageError(
                "no PLC named", hint="give --port, such as -p /dev/ttyUSB0 or -p sim:, or set FATEKTOOL_PORT"
            )
        if trace is not None:
            from fatektool.cli.shared.places import require_free

            require_free(trace)
        from fatektool.connection import usual_format

        form = usual_format(protocol) if line_format is None else line_format.upper()
        line = Connection(
            port,
            station,
            protocol,
            baud,
            form,
            timeout,
            retries,
            lock_wait,
            trace,
            read_only=read_only,
            low_latency=low_latency,
        )
        entry = plc_named(port, inventory)
        if entry is not None:
            line = _of_inventory(line, entry, has_format=line_format is not None)
        require_station(line.station, line.protocol, broadcast=rest.get("broadcast"))
        return function(*args, connection=line, **rest)

    return with_connection  # type: ignore[return-value]  # as above


def _of_inventory(line: Connection, entry: PlcEntry, *, has_format: bool) -> Connection:
    """A PLC of the inventory; what was given as an option goes before what stands there."""
    own = connection_of(entry)
    source = click.get_current_context().get_parameter_source
    given = {
        field: getattr(line, field)
        for option, field in _IN_INVENTORY.items()
        if source(option) is ParameterSource.COMMANDLINE
    }
    if has_format or given.get("protocol", own.protocol) != own.protocol:
        given["format"] = line.format  # that of the inventory is meant for the protocol there
    return replace(
        own,
        trace=line.trace,
        read_only=line.read_only or own.read_only,
        low_latency=line.low_latency,
        **given,
    )


def connection_of(entry: PlcEntry) -> Connection:
    """A PLC of the inventory, as it stands there."""
    from fatektool.connection import usual_format

    return Connection(
        entry.target,
        entry.station,
        entry.protocol,
        entry.baud,
        entry.format or usual_format(entry.protocol),
        entry.timeout_s,
        entry.retries,
        entry.lock_wait_s,
        None,
        entry,
        read_only=entry.read_only,
    )


def yes_option(function: F) -> F:
    """``--yes``."""
    return click.option("--yes", is_flag=True, help="Do not ask.")(function)
