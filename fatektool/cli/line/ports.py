"""``ports``: the serial ports of this computer."""

from __future__ import annotations

import sys
from typing import TYPE_CHECKING

import click

from fatektool.cli.line.documents.places import ports_document
from fatektool.cli.shared.options import voice_options
from fatektool.jobs.serial_ports import serial_ports

if TYPE_CHECKING:
    from collections.abc import Iterator

    from fatektool.cli.shared.output import Voice
    from fatektool.jobs.serial_ports import SerialPort


@click.command("ports", epilog="Example: fatektool ports")
@voice_options
def ports_command(voice: Voice) -> None:
    """List the serial ports of this computer, with the names of their adapters."""
    found = serial_ports()
    voice.show(ports_document(found), _lines(found))
    if not found:
        voice.say(_nothing())


def _lines(ports: list[SerialPort]) -> Iterator[str]:
    width = max((len(port.device) for port in ports), default=0)
    for port in ports:
        yield f"{port.device:<{width}}  {port.description or '-'}  {port.usb or ''}".rstrip()


def _nothing() -> str:
    if sys.platform == "linux":
        return (
            "no serial ports found; plug the adapter in, then 'dmesg | tail' shows whether Linux detects it"
        )
    return "no serial ports found; check that the driver of the adapter is installed"
