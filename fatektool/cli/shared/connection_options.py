"""The options that say where a PLC is and how it is asked: a row for each field of its address.

An option goes before its environment variable, that before the inventory, and that before the default.
"""

from __future__ import annotations

import sys
from functools import wraps
from types import MappingProxyType
from typing import TYPE_CHECKING, Any, Final, NamedTuple, TypeVar

import click
from click.core import ParameterSource

from fatektool.address import CHECKS, DEFAULT_FORMATS, DEFAULTS, READ_ONLY_VARIABLE, PlcAddress
from fatektool.checks import YesNo
from fatektool.cli.shared.connection import Connection
from fatektool.cli.shared.inventory_file import complete_target, inventory_option
from fatektool.cli.shared.options import PATH, ConnectionOption, completing, type_of, voice_options
from fatektool.cli.shared.output import print_stderr
from fatektool.errors import UsageError
from fatektool.inventory.find import plc_named

if TYPE_CHECKING:
    from collections.abc import Callable, Mapping
    from pathlib import Path

    from click.shell_completion import CompletionItem

F = TypeVar("F", bound="Callable[..., Any]")

_GIVEN: Final = {ParameterSource.COMMANDLINE, ParameterSource.ENVIRONMENT}


_COMPLETE: Final[dict[str, Callable[..., list[CompletionItem]]]] = {
    "target": complete_target,
    "baud": completing("complete_baud"),
    "format": completing("complete_line"),
}


class Row(NamedTuple):
    """A field of ``PlcAddress`` as an option; its default and its check are the field's.

    Attributes:
        field: the field.
        parameter: the command's parameter that gets the value.
        words: the option as it is written.
        help: what it is for.
        metavar: what the help writes for its value.
        variable: the environment variable that gives it too.
        old: True for the former name of another row's option, which is taken and is not in the help.
    """

    field: str
    parameter: str
    words: tuple[str, ...]
    help: str
    metavar: str | None = None
    variable: str | None = None
    old: bool = False

    def option(self, *, default: Any) -> Callable[[F], F]:
        """The option, as a decorator of a command."""
        check = CHECKS.get(self.field)
        is_flag = isinstance(check, YesNo)
        return click.option(
            *self.words,
            self.parameter,
            cls=ConnectionOption,
            is_flag=is_flag,
            type=None if is_flag else PATH if check is None else type_of(check),
            default=None if self.old else default,
            hidden=self.old,
            show_default=default not in {None, False},
            metavar=self.metavar,
            envvar=self.variable,
            shell_complete=_COMPLETE.get(self.field),
            help=self.help + (f"  [env: {self.variable}]" if self.variable else ""),
        )


ROWS: Final = (
    Row(
        "target",
        "port",
        ("-p", "--port"),
        "Where the PLC is: /dev/ttyUSB0, COM3, tcp://HOST[:500], udp://HOST[:500], rfc2217://HOST:PORT, "
        "modem:/dev/ttyUSB0?number=0228082192, sim: (a simulated PLC), sim:FILE, "
        "or its name in the inventory.",
        metavar="TARGET",
        variable="FATEKTOOL_PORT",
    ),
    Row(
        "station",
        "station",
        ("-s", "--station"),
        "The PLC's station, 1 to 254; over modbus-tcp 0 and 255 too.",
        "N",
    ),
    Row(
        "protocol",
        "protocol",
        ("--protocol",),
        "The PLC's protocol: facon (FB, FBE, FBN, FBs), mseries (M-series), or Modbus (FBs).",
    ),
    Row("baud", "baud", ("--baud",), "Speed of the serial line.", "N"),
    Row(
        "format",
        "line_format",
        ("--line",),
        f"Data bits, parity, stop bits of the serial line.  [default: {DEFAULT_FORMATS}]",
        "7E1",
    ),
    Row("format", "old_format", ("--format",), "As --line.", "7E1", old=True),
    Row("timeout_s", "timeout", ("--timeout",), "The PLC's time to answer, in addition to wire time.", "S"),
    Row("retries", "retries", ("--retries",), "Retries per request.", "N"),
    Row(
        "lock_wait_s",
        "lock_wait",
        ("--lock-wait",),
        "How long to wait for a port that another process uses.",
        "S",
    ),
    Row(
        "low_latency",
        "low_latency",
        ("--low-latency/--no-low-latency",),
        "On Linux, ask the driver of a serial port to pass on received bytes at once.",
    ),
    Row("trace", "trace", ("--trace",), "Record all bytes sent and received: .pcap or .ndjson.", "FILE"),
    Row(
        "read_only",
        "read_only",
        ("--read-only",),
        "Refuse every command that would write to the PLC.",
        variable=READ_ONLY_VARIABLE,
    ),
)


def address_options(
    rows: tuple[Row, ...] = ROWS, defaults: Mapping[str, Any] = MappingProxyType({})
) -> Callable[[F], F]:
    """An option for each row; the command gets each value under its parameter.

    Args:
        rows: which.
        defaults: by field; one that is not there has no default.
    """

    def decorate(function: F) -> F:
        for row in reversed(rows):
            function = row.option(default=defaults.get(row.field))(function)
        return function

    return decorate


def given_of(values: dict[str, Any], rows: tuple[Row, ...] = ROWS) -> dict[str, Any]:
    """The values of the options that were given, by field; all of them are taken out of ``values``.

    Args:
        values: of a command's parameters. One that is no option of this command counts unless it is None.
        rows: the options.
    """
    source = click.get_current_context().get_parameter_source
    found: dict[str, Any] = {}
    for row in rows:
        value, came_from = values.pop(row.parameter), source(row.parameter)
        if came_from in _GIVEN or (came_from is None and value is not None):
            if row.old:
                _renamed(row, rows, found)
            found[row.field] = value
    return found


def _renamed(old: Row, rows: tuple[Row, ...], found: Mapping[str, Any]) -> None:
    """Say on a terminal that an option has another name now; a cron job is not to send mail for it.

    Raises:
        UsageError: both are given.
    """
    name = next(row.words[0] for row in rows if row.field == old.field)
    if old.field in found:
        raise UsageError(f"{name} and {old.words[0]} are the same option: give {name} alone")
    if sys.stderr.isatty():
        print_stderr(f"the line's {old.words[0]} is {name} now; {old.words[0]} still works")


def without_effect(*parameters: str) -> Callable[[F], F]:
    """Do not show options of the connection that have no effect here; above ``connection_options``."""

    def decorate(function: F) -> F:
        for option in getattr(function, "__click_params__", ()):
            if option.name in parameters:
                option.hidden = True
        return function

    return decorate


def connection_options(function: F) -> F:
    """All options of a connection; the command gets ``connection`` and ``voice``."""
    return _connection_options(function, ROWS)


def connection_options_but_format(function: F) -> F:
    """The same for a command whose own ``--format`` may say the line's too; it passes ``old_format`` on."""
    return _connection_options(function, tuple(row for row in ROWS if not row.old))


def _connection_options(function: F, rows: tuple[Row, ...]) -> F:
    @inventory_option
    @voice_options
    @wraps(function)
    def with_connection(*args: Any, inventory: Path | None, **rest: Any) -> Any:
        given = given_of(rest)
        target = given.pop("target", None)
        network = rest.get("network")  # of a scan of a network, in which no PLC is named
        if not target and network is None:
            raise UsageError(
                "no PLC named", hint="give --port, such as -p /dev/ttyUSB0 or -p sim:, or set FATEKTOOL_PORT"
            )
        if "trace" in given:
            from fatektool.cli.shared.places import require_free

            require_free(given["trace"])
        entry = plc_named(target, inventory) if target else None
        address = (
            PlcAddress(target or str(network), **given) if entry is None else entry.address.changed(**given)
        )
        _require_station(address, broadcast=rest.get("broadcast"))
        return function(*args, connection=Connection(address, entry), **rest)

    return address_options(rows, DEFAULTS)(with_connection)  # type: ignore[return-value]  # as in options.py


def _require_station(address: PlcAddress, *, broadcast: bool | None) -> None:
    """Check the station, now that the protocol is known, which the inventory may name.

    Args:
        address: of a PLC, or of all of them.
        broadcast: of ``--broadcast``; None for a command without it.

    Raises:
        UsageError: no PLC can be asked under it.
    """
    if address.station == 0 and broadcast is False and 0 not in address.codec.stations:
        raise UsageError(
            "station: expected 1 to 254, got 0",
            hint="0 is broadcast, to which no PLC replies: add --broadcast if every PLC on the line is meant",
        )
    if not (address.station == 0 and broadcast):
        from fatektool.protocol.codec import require_station

        require_station(address.codec, address.station)
