"""Targets of ``--port``: ``/dev/ttyUSB0``, ``COM3``, ``tcp://host:500``, ``sim:FILE``, ``modem:…``, a URL.

::

    scheme       kind     opened by
    (none)       serial   pyserial, a device
    tcp, udp     net      this project; default port 500 (of FACON; other protocols may have none)
    sim          sim      the simulator, in this process
    modem        modem    a serial port with a modem that calls: modem:/dev/ttyUSB0?number=0228082192
    others       serial   pyserial, by its URL handler: rfc2217, socket, hwgrep, spy, alt, loop
"""

from __future__ import annotations

import os
import re
from enum import Enum
from typing import TYPE_CHECKING, Final, NamedTuple

from fatektool.errors import UsageError

if TYPE_CHECKING:
    from fatektool.transport.modem.dial import Call

_NET: Final = re.compile(
    r"(tcp|udp)://(?:\[([0-9A-Fa-f:.%\w]+)\]|([^/:\[\]@?#\s]+))(?::([0-9]{1,9}))?/?", re.ASCII
)
_SCHEME: Final = r"[A-Za-z][A-Za-z0-9+.]*://"
DEFAULT_PORT: Final = 500
_WINDOWS: Final = os.name == "nt"


class TargetKind(Enum):
    """The way in which a target is opened."""

    SERIAL = "serial"
    TCP = "tcp"
    UDP = "udp"
    SIM = "sim"
    MODEM = "modem"


class Target(NamedTuple):
    """A target, parsed.

    Attributes:
        text: as the user wrote it.
        kind: the way in which it is opened.
        host: of TCP and UDP.
        port: of TCP and UDP.
        path: the device or URL of a serial port, or the file of ``sim:FILE``; empty for ``sim:``.
        call: the number that a modem calls, and its options.
    """

    text: str
    kind: TargetKind
    host: str = ""
    port: int = 0
    path: str = ""
    call: Call | None = None

    @classmethod
    def parse(cls, text: str, *, default_port: int | None = DEFAULT_PORT) -> Target:
        """Parse a target.

        Args:
            text: as the user wrote it.
            default_port: for TCP and UDP without a port; None if the port is required.

        Raises:
            UsageError: it is not a target.
        """
        if not text.strip() or "\0" in text:
            raise UsageError("the target is empty", hint=_WAYS)
        text = _lower_scheme(text)
        if text.startswith("sim:"):
            if _WINDOWS:
                from fatektool.files.portable_name import require_file_name

                require_file_name(text.removeprefix("sim:"))
            return cls(text, TargetKind.SIM, path=text.removeprefix("sim:"))
        if text.startswith(("tcp:", "udp:")):
            return cls._net(text, default_port)
        if text.startswith("modem:"):
            return cls._modem(text)
        _require_place(text)
        return cls(text, TargetKind.SERIAL, path=text)

    @classmethod
    def _modem(cls, text: str) -> Target:
        from fatektool.transport.modem.dial import Call

        path, _, query = text.removeprefix("modem:").rpartition("?")  # a URL may have one of its own
        if not path:
            raise UsageError(
                f"target {text[:80]!r}: expected modem:PORT?number=…",
                hint="such as modem:/dev/ttyUSB0?number=0228082192",
            )
        _require_place(path)
        return cls(text, TargetKind.MODEM, path=path, call=Call.parse(query))

    @classmethod
    def _net(cls, text: str, default_port: int | None) -> Target:
        match = _NET.fullmatch(text)
        if match is None:
            from fatektool.transport.nearly import meant

            raise UsageError(
                f"target {text!r}: expected tcp://host:port or udp://host:port", hint=meant(text) or _WAYS
            )
        port = int(match[4]) if match[4] else default_port
        if port is None:
            raise UsageError(
                f"target {text!r}: expected a port, because this protocol has no default port",
                hint=f"add it: {text.rstrip('/')}:PORT",
            )
        if not 1 <= port <= 65535:
            raise UsageError(f"target {text!r}: port: expected 1 to 65535, got {port}")
        kind = TargetKind.TCP if match[1] == "tcp" else TargetKind.UDP
        return cls(text, kind, host=match[2] or match[3], port=port)

    @property
    def is_url(self) -> bool:
        """True for a serial port that pyserial opens by its URL."""
        return self.on_serial_port and re.match(_SCHEME, self.path) is not None

    @property
    def on_serial_port(self) -> bool:
        """True for a serial port of this computer or a URL of pyserial, with or without a modem."""
        return self.kind in {TargetKind.SERIAL, TargetKind.MODEM}


def _require_place(path: str) -> None:
    if _WINDOWS and "://" not in path:
        from fatektool.transport.serial_line.windows import require_port

        require_port(path, path)
    if "://" in path:  # loaded only if there is a URL
        from fatektool.transport.serial_line.url import require_place

        require_place(path)


def _lower_scheme(text: str) -> str:
    """``TCP://HOST`` is ``tcp://HOST``: the scheme of a URL may be in capitals."""
    match = re.match(_SCHEME, text) or re.match(r"(?:sim|modem|tcp|udp):", text, re.IGNORECASE)
    return text if match is None else match[0].lower() + text[match.end() :]


_WAYS: Final = "such as /dev/ttyUSB0, COM3, tcp://192.168.2.3:500, udp://192.168.2.3 or sim:"
