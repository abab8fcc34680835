"""The address of a PLC and the settings of the connection to it, as one value.

An option of the command line, a key of the inventory and an argument of ``connect`` are the same field here.
Its default and its check are written here, once, so a wrong value is refused in the same words everywhere. A
new setting of the connection is a field here, its name in ``Settings``, and a row in
``cli/shared/connection_options.py``.
"""

from __future__ import annotations

from dataclasses import MISSING, field, fields, replace
from typing import TYPE_CHECKING, Any, Final, Literal, TypedDict, cast

from fatektool.checks import Check, OneOf, Seconds, Text, WholeNumber, YesNo
from fatektool.errors import UsageError
from fatektool.protocol.registry import CODECS
from fatektool.protocols import DEFAULT, PROTOCOLS
from fatektool.transport.base import BAUD, FORMAT, LineSettings
from fatektool.value import Value, frozen

if TYPE_CHECKING:
    from pathlib import Path
    from typing import Unpack

    from fatektool.protocol.codec import Codec
    from fatektool.protocol.modbus.map import ModbusMap
    from fatektool.transport.target import Target

READ_ONLY_VARIABLE: Final = "FATEKTOOL_READ_ONLY"
"""The environment variable that makes every line of a process read-only."""

DEFAULT_FORMATS: Final = "7E1; 8E1 for mseries and modbus-rtu"


def default_format(codec: Codec) -> str:
    """The default line format of a protocol: even parity and as many data bits as it needs."""
    return f"{codec.data_bits or 8}E1"


class _Station(WholeNumber):
    """A station that some PLC has, or 0 for all of them; which, the protocol says."""

    def __init__(self) -> None:
        super().__init__(0, 255)
        self.expected = "a whole number from 1 to 254, over modbus-tcp 0 and 255 too"


def _checked(check: Check[Any], *, default: Any) -> Any:
    return field(default=default, metadata={"check": check})


@frozen
class PlcAddress(Value):
    """The address of a PLC and the settings of the connection to it.

    Attributes:
        target: ``/dev/ttyUSB0``, ``COM3``, a pyserial URL, ``tcp://host[:500]``, ``udp://host[:500]``,
            ``sim:`` or ``sim:FILE``, ``modem:/dev/ttyUSB0?number=0228082192`` (which calls). M-series over
            TCP has no default port: it must be named.
        station: 1 to 254; over ``modbus-tcp`` 0 and 255 too, the PLC at the address itself. Else 0 is
            broadcast, to which no PLC replies.
        protocol: ``facon``, ``mseries``, ``modbus-rtu``, ``modbus-ascii`` or ``modbus-tcp``.
        baud: speed of the serial line; over TCP and UDP that of the line behind a gateway.
        format: data bits, parity, stop bits; None for the protocol's default, 7E1, or 8E1 for ``mseries`` and
            ``modbus-rtu``.
        timeout_s: the PLC's time to answer, in addition to the wire time.
        retries: retries per request.
        lock_wait_s: how long to wait for a port that another process uses.
        read_only: refuse every request that writes, before a byte is sent.
        low_latency: on Linux, ask the driver of a serial port to pass on received bytes at once.
        trace: record all bytes in this file, ``.pcap`` or ``.ndjson``.
        modbus_map: which elements have which Modbus references; None for the standard map. ``custom`` reads
            the PLC's own.

    Raises:
        UsageError: an invalid value.
    """

    target: str = field(metadata={"check": Text("tcp://192.168.2.3 or /dev/ttyUSB0")})
    station: int = _checked(_Station(), default=1)
    protocol: str = _checked(OneOf(PROTOCOLS), default=DEFAULT)
    baud: int = _checked(BAUD, default=9600)
    format: str | None = _checked(FORMAT, default=None)
    timeout_s: float = _checked(Seconds(0, 86400, above=True), default=0.5)
    retries: int = _checked(WholeNumber(0, 1000), default=3)
    lock_wait_s: float = _checked(Seconds(0, 86400), default=10.0)
    read_only: bool = _checked(YesNo(), default=False)
    low_latency: bool = _checked(YesNo(), default=True)
    trace: Path | None = None
    modbus_map: ModbusMap | Literal["custom"] | None = None

    def __post_init__(self) -> None:
        for name, check in CHECKS.items():
            value = getattr(self, name)
            if name not in DEFAULTS or value is not DEFAULTS[name]:
                object.__setattr__(self, name, check.require(name, value))

    def changed(self, **settings: Unpack[Settings]) -> PlcAddress:
        """This address with other settings.

        A format belongs to the protocol that it was given with, so another protocol has its own default.
        Read-only stays read-only.
        """
        if settings.get("protocol", self.protocol) != self.protocol:
            settings.setdefault("format", None)
        if self.read_only:
            settings["read_only"] = True
        return replace(self, **settings)

    def require_consistent(self) -> None:
        """Check the values against each other, before anything is opened or sent.

        Raises:
            UsageError: no PLC can have this address. The message begins with the wrong field, or the target.
        """
        from fatektool.protocol.codec import require_station  # not needed for --help

        require_station(self.codec, self.station)
        where, data_bits = self.where, self.codec.data_bits
        if not where.on_serial_port:
            return
        if data_bits is None and not where.is_url:
            raise UsageError(
                f"protocol {self.protocol} is for networks: expected tcp://HOST, got {self.target!r:.80}",
                hint="on a serial line it is modbus-rtu or modbus-ascii",
            )
        if data_bits is not None and self.line_settings.data_bits < data_bits:
            raise UsageError(
                f"format: expected {data_bits} data bits, as {self.protocol} on a serial line needs, "
                f"got {self.line_settings.format}",
                hint=f"add --line {default_format(self.codec)} or {data_bits}N1, as the PLC's port is set",
            )

    @property
    def codec(self) -> Codec:
        """The codec of the protocol, with the standard map."""
        return CODECS[self.protocol]

    @property
    def line_settings(self) -> LineSettings:
        """Speed and format of the serial line."""
        return LineSettings(self.baud, self.format or default_format(self.codec))

    @property
    def where(self) -> Target:
        """The target, parsed, with the protocol's default port.

        Raises:
            UsageError: it is not a target, or has no port.
        """
        from fatektool.transport.target import Target

        return Target.parse(self.target, default_port=self.codec.default_tcp_port)


class Settings(TypedDict, total=False):
    """The fields of ``PlcAddress`` but the target, as arguments by name: for type checkers and editors."""

    station: int
    protocol: str
    baud: int
    format: str | None
    timeout_s: float
    retries: int
    lock_wait_s: float
    read_only: bool
    low_latency: bool
    trace: Path | None
    modbus_map: ModbusMap | Literal["custom"] | None


DEFAULTS: Final = {each.name: each.default for each in fields(PlcAddress) if each.default is not MISSING}
CHECKS: Final = {
    each.name: cast("Check[Any]", each.metadata["check"])
    for each in fields(PlcAddress)
    if "check" in each.metadata
}
"""The check of each field that is an option and a key of the inventory."""
