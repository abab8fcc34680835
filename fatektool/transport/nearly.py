"""What a user meant by a target that is nearly right, for the message that says that it is none.

::

    192.168.2.3  127.0.0.1:5500  plc.local        tcp:// is missing
    tcp:HOST  tcp//HOST  http://HOST              so is a part of it, or it is another's
    sim  simulator                                sim:
    ttyUSB0  /dev/ttyusb0  /dev/ttyUSB            a port of this computer
    press                                         a name, and no inventory has it
"""

from __future__ import annotations

import re
from typing import TYPE_CHECKING, Final

if TYPE_CHECKING:
    from collections.abc import Iterable

_HOST: Final = r"(?:\d{1,3}(?:\.\d{1,3}){3}|\[[0-9A-Fa-f:]+\]|[A-Za-z][\w-]*(?:\.[\w-]+)+|localhost)"
_NET: Final = re.compile(rf"({_HOST}(?::\d{{1,5}})?|[A-Za-z][\w-]*:\d{{1,5}})/?", re.ASCII)
_SCHEME: Final = re.compile(
    r"(tcp|udp|http|https|telnet|ssh|ip|modbus|modbus-tcp)(?::/?|//|://)([^/?#\s]+)(?:/.*)?",
    re.ASCII | re.IGNORECASE,
)
_FILE: Final = re.compile(r".*\.(json|toml|pdw|state|txt|bin)", re.IGNORECASE)
_SIMULATED: Final = {"sim", "simulator", "simulate", "simulated", "demo"}
_NAME: Final = re.compile(r"[\w.-]+")
_COM: Final = re.compile(r"COM\d+", re.ASCII | re.IGNORECASE)
_DEVICE: Final = re.compile(r"/dev/(tty|cu)[\w.-]*", re.ASCII)
_PORTS: Final = "'fatektool ports' lists the serial ports"


def meant(target: str) -> str | None:
    """The targets that this one is nearly, as a question. None if it is like none of them.

    Args:
        target: as the user wrote it.
    """
    found = _network(target) or _simulated(target) or _port(target, devices())
    return f"did you mean {found}?" if found and found != target else None


def next_step(target: str) -> str:
    """What to do about a port that is not there, as a sentence without its full stop."""
    question = meant(target)
    if question is not None:
        return question
    if _NAME.fullmatch(target) and not _FILE.fullmatch(target) and not _COM.fullmatch(target):
        return (
            f"for the name of a PLC there must be an inventory: give --inventory FILE, or add the PLC with "
            f"'fatektool inventory add'; {_PORTS}"
        )
    number = "" if target[-1:].isdigit() else f"a port's name ends in a number, such as {target}0; "
    return f"{number if _DEVICE.fullmatch(target) else ''}check that the adapter is plugged in; {_PORTS}"


def devices() -> list[str]:
    """The serial ports of this computer."""
    from serial.tools.list_ports import comports

    return sorted(str(port.device) for port in comports())


def _network(target: str) -> str | None:
    match = _SCHEME.fullmatch(target)
    if match is not None:
        return f"{'udp' if match[1].lower() == 'udp' else 'tcp'}://{match[2]}"
    match = _NET.fullmatch(target)
    return None if match is None or _FILE.fullmatch(target) else f"tcp://{match[1]}"


def _simulated(target: str) -> str | None:
    if target.lower() in _SIMULATED:
        return "sim:"
    return f"sim:{target}" if target.lower().endswith(".state") else None


def _port(target: str, ports: Iterable[str]) -> str | None:
    """The ports of this computer whose names begin so, in small or capital letters, with or without /dev/."""
    word = target.lower()
    begin = [port for port in ports if word in {port.lower()[: len(word)], _bare(port)[: len(word)]}]
    if begin:
        return " or ".join(begin[:3])
    return f"/dev/{target}" if _DEVICE.fullmatch(f"/dev/{target}") and target[-1:].isdigit() else None


def _bare(port: str) -> str:
    return port.rpartition("/")[2].lower()
