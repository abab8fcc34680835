"""``ports``: the serial ports of this computer."""

from __future__ import annotations

import sys
from typing import TYPE_CHECKING, Any

import click

from fatektool.cli.shared.options import voice_options

if TYPE_CHECKING:
    from collections.abc import Iterator

    from fatektool.cli.shared.output import Voice


@click.command("ports", epilog="Example: fatektool ports")
@voice_options
def ports_command(voice: Voice) -> None:
    """List the serial ports of this computer, with what the adapters tell of themselves."""
    from serial.tools.list_ports import comports

    found = [_port(port) for port in sorted(comports(), key=lambda port: str(port.device))]
    voice.show({"schema": "fatektool.ports/1", "ports": found}, _lines(found))
    if not found:
        voice.say(_nothing())


def _port(port: Any) -> dict[str, Any]:
    return {
        "device": port.device,
        "description": _known(port.description),
        "hardware_id": _known(port.hwid),
        "manufacturer": port.manufacturer,
        "serial_number": port.serial_number,
        "usb": None if port.vid is None else f"{port.vid:04X}:{port.pid:04X}",
    }


def _known(text: str | None) -> str | None:
    return None if text in {None, "", "n/a"} else text


def _lines(ports: list[dict[str, Any]]) -> Iterator[str]:
    width = max((len(port["device"]) for port in ports), default=0)
    for port in ports:
        yield f"{port['device']:<{width}}  {port['description'] or '-'}  {port['usb'] or ''}".rstrip()


def _nothing() -> str:
    if sys.platform == "linux":
        return (
            "no serial port found; after plugging an adapter in, 'dmesg | tail' shows whether Linux knows it"
        )
    return "no serial port found; is the adapter's driver installed?"
