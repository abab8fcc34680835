"""``scan``: which stations are on the line."""

from __future__ import annotations

from contextlib import ExitStack
from typing import TYPE_CHECKING, Any

import click

from fatektool.address import default_format
from fatektool.cli import INTERRUPTED
from fatektool.cli.line.documents.linetest import scan_document, station_document
from fatektool.cli.line.network import look_for_modules, network_option
from fatektool.cli.shared.colour import joined, word
from fatektool.cli.shared.connection_options import connection_options, without_effect
from fatektool.cli.shared.options import ChoiceType, Several, type_of
from fatektool.cli.shared.pairs import apart, together
from fatektool.counts import counted
from fatektool.errors import UsageError
from fatektool.exchange.no_answer import longer_timeout
from fatektool.files.times import utc
from fatektool.jobs.linetest.scan import scan
from fatektool.jobs.linetest.scan_result import ScanResult, ScanSetting
from fatektool.protocol.line_settings import BAUDS, FORMATS
from fatektool.protocols import PROTOCOLS
from fatektool.transport.base import BAUD, FORMAT, LineSettings

if TYPE_CHECKING:
    from collections.abc import Iterator

    from fatektool.address import PlcAddress
    from fatektool.cli.shared.connection import Connection
    from fatektool.cli.shared.output import Voice
    from fatektool.jobs.linetest.scan_result import Station


_OF_UNITS = "modbus-tcp"
_UNITS = {0, 255}


class Stations(click.ParamType):  # type: ignore[type-arg]  # a generic in the newest click only
    """``1-254``, ``1,5,7-9``."""

    name = "stations"

    def convert(self, value: Any, param: click.Parameter | None, ctx: click.Context | None) -> Any:
        """Read them, each once, in the order given."""
        found: dict[int, None] = {}
        for part in str(value).split(","):
            first, dash, last = part.strip().partition("-")
            ends = [first, last if dash else first]
            if not all(end.isascii() and end.isdigit() and 0 <= int(end[:4]) <= 255 for end in ends):
                self.fail(
                    f"{part.strip()!r}: expected stations from 1 to 254, such as 1-254 or 1,5,7-9; "
                    f"over {_OF_UNITS} 0 and 255 too",
                    param,
                    ctx,
                )
            if int(ends[0]) > int(ends[1]):
                self.fail(f"{part.strip()!r}: expected the lower station first", param, ctx)
            found.update(dict.fromkeys(range(int(ends[0]), int(ends[1]) + 1)))
        return tuple(found)


class Bauds(Several):
    """Numbers with commas between them, or ``all``."""

    def convert(self, value: Any, param: click.Parameter | None, ctx: click.Context | None) -> Any:
        """Read them."""
        return BAUDS if value == "all" else super().convert(value, param, ctx)


@click.command(
    "scan",
    epilog="Example: fatektool scan --stations 1-5 --protocols facon,mseries -p sim:",
)
@click.option(
    "--stations",
    type=Stations(),
    default="1-254",
    show_default=True,
    metavar="N-N,N…",
    help="Stations to try; the first one with all settings, before the others.",
)
@click.option(
    "--bauds",
    type=Bauds(type_of(BAUD)),
    metavar="N,…",
    help="Baud rates to try; 'all' for all that FATEK PLCs have.  [default: that of --baud]",
)
@click.option(
    "--formats",
    type=Several(type_of(FORMAT)),
    metavar="F,…",
    help="Formats to try.  [default: that of --line]",
)
@click.option(
    "--protocols",
    type=Several(ChoiceType(PROTOCOLS)),
    metavar="P,…",
    help="Protocols to try.  [default: that of --protocol]",
)
@network_option
@without_effect("station")
@connection_options
def scan_command(
    connection: Connection,
    voice: Voice,
    *,
    stations: tuple[int, ...],
    bauds: tuple[int, ...] | None,
    formats: tuple[str, ...] | None,
    protocols: tuple[str, ...] | None,
    network: str | None,
) -> int:
    """Find the stations that answer, with baud rate, format and protocol.

    Each station is asked for its brief status (40), over Modbus for R0. Nothing is changed.

    Each silent station takes --timeout: a shorter one makes a scan faster, but slow PLCs may be missed.
    Exit 1 if no station answers.
    """
    apart("network", "port", "stations", "station", why="it asks Ethernet modules, not stations on a line")
    apart("network", "bauds", "baud", "formats", "line_format", "old_format", "protocols", "protocol")
    apart("network", "trace", "retries", "lock_wait")
    if network is not None:
        return look_for_modules(voice, network, connection.address.timeout_s)
    together("station", holds=False, needs="one PLC; a scan asks those of --stations")
    apart("baud", "bauds")
    apart("line_format", "formats")
    apart("old_format", "formats")
    apart("protocol", "protocols")
    settings = _settings(connection.address, bauds, formats, protocols)
    for station in _UNITS.intersection(stations):
        if not any(station in setting.codec.stations for setting in settings):
            raise UsageError(
                f"station {station}: expected stations from 1 to 254; it is a unit of {_OF_UNITS}"
            )
    with ExitStack() as stack:
        transport = connection.open_line(voice, stack)
        serial = transport.serial_settings is not None
        networks = [setting.codec.name for setting in settings if setting.codec.data_bits is None]
        if serial and networks:
            raise UsageError(f"{networks[0]} is for networks: {connection.address.target} is a serial line")
        if not serial and len({setting.line.baud for setting in settings}) > 1:
            raise UsageError(
                f"{connection.address.target} has no baud rate and format: expected a serial port",
                hint="set them in the gateway",
            )
        time = utc()
        bar = stack.enter_context(voice.progress("probes"))
        result = scan(
            transport,
            settings,
            stations,
            timeout_s=connection.address.timeout_s,
            retries=connection.address.retries,
            on_found=lambda found: None if voice.json else bar.print(_line(found, serial=serial)),
            on_probe=lambda done, total: bar.update("scan", done, total),
        )
    if voice.json:
        voice.show(scan_document(time, connection.address.target, result, serial=serial), ())
    voice.say(_summary(result))
    if result.interrupted:
        return INTERRUPTED
    return 0 if result.found else 1


def _settings(
    address: PlcAddress,
    bauds: tuple[int, ...] | None,
    formats: tuple[str, ...] | None,
    protocols: tuple[str, ...] | None,
) -> list[ScanSetting]:
    """All settings to try: protocol by protocol, the factory setting first.

    Raises:
        UsageError: no format has enough data bits for a protocol.
    """
    found: dict[ScanSetting, None] = {}
    for name in protocols or (address.protocol,):
        own = address.changed(protocol=name)
        codec, tried = own.codec, formats or (own.line_settings.format,)
        lines = [LineSettings(baud, form) for baud in bauds or (own.baud,) for form in tried]
        carrying = [line for line in lines if line.data_bits >= (codec.data_bits or 0)]
        if not carrying:
            raise UsageError(
                f"{name} needs {codec.data_bits} data bits, which no format of {', '.join(tried)} has",
                hint=f"add {default_format(codec)} to --formats",
            )
        factory = LineSettings(format=default_format(codec))
        found |= {
            ScanSetting(codec, line): None for line in sorted(carrying, key=lambda line: line != factory)
        }
    return list(found)


def _line(found: Station, *, serial: bool) -> str:
    row = station_document(found, serial=serial)
    line = f"{row['baud']} {row['format']}  " if serial else ""
    mode = {True: "RUN", False: "STOP", None: "mode unknown"}[row["running"]]
    took = "late" if row["latency_ms"] is None else f"{row['latency_ms']:.1f} ms{', late' * row['late']}"
    model = row["model"] or "model unknown"
    start = f"station {row['station']:>3}  {line}{row['protocol']}  "
    return joined(start, word(mode), f"  {model}  {took}")


def _summary(result: ScanResult) -> str:
    return "; ".join(_parts(result))


def _parts(result: ScanResult) -> Iterator[str]:
    count = len({found.station for found in result.found})
    stations = counted(count, "station") if count else "no stations"
    several = f" ({counted(len(result.found), 'setting')})" if len(result.found) > count else ""
    yield f"{stations} found{several} with {counted(result.probes, 'request')} in {result.duration_s:.1f} s"
    if result.unclear:
        places = sorted({place.station for place in result.unclear})
        named = ", ".join(map(str, places[:5])) + (", …" if len(places) > 5 else "")
        yield f"no valid frame in the bytes from station {named}: another baud rate, format or protocol?"
    elif not count:
        yield f"check that the PLC is on, and the cable; try --bauds all --formats {','.join(FORMATS)}"
    if result.refused:
        lines = dict.fromkeys(str(setting.line) for setting in result.refused)
        yield f"this port does not support {', '.join(lines)}"
    for found in result.found:
        if found.any_number:
            yield (
                f"station {found.station} answers for every station number: it is one PLC, whose port does "
                "not check the number (the low byte of R4149 for port 0, R4155 for ports 1 and 2, R4156 "
                "for ports 3 and 4 is 1; write 0 there before you connect several PLCs)"
            )
    late_s = [found.latency_s for found in result.found if found.late and found.latency_s is not None]
    if late_s:
        yield f"answers were late, after {max(late_s):.2g} s: give --timeout {longer_timeout(max(late_s)):g}"
    if result.interrupted:
        yield "interrupted"
