"""The serial ports of this computer."""

from __future__ import annotations

from dataclasses import dataclass


@dataclass(frozen=True, slots=True)
class SerialPort:
    """A serial port, with what its adapter says of itself; None for what it does not say.

    Attributes:
        device: its name as a target: ``/dev/ttyUSB0``, ``COM3``.
        description: in words.
        hardware_id: vendor, product and serial number as the system writes them.
        manufacturer: of a USB adapter.
        serial_number: of a USB adapter.
        usb: vendor and product number in hex, ``0403:6001``.
    """

    device: str
    description: str | None
    hardware_id: str | None
    manufacturer: str | None
    serial_number: str | None
    usb: str | None


def serial_ports() -> list[SerialPort]:
    """The serial ports that the system knows, by name."""
    from serial.tools.list_ports import comports

    return [
        SerialPort(
            str(port.device),
            _known(port.description),
            _known(port.hwid),
            port.manufacturer,
            port.serial_number,
            None if port.vid is None else f"{port.vid:04X}:{port.pid:04X}",
        )
        for port in sorted(comports(), key=lambda port: str(port.device))
    ]


def _known(text: str | None) -> str | None:
    return None if text in {None, "", "n/a"} else text
