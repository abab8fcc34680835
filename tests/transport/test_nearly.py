"""Targets that are nearly right, and what is said of them."""

from __future__ import annotations

import pytest

from fatektool.transport import nearly
from fatektool.transport.nearly import meant, next_step
from tests.rows import each

PORTS = ["/dev/ttyS0", "/dev/ttyUSB0", "/dev/ttyUSB1"]


@pytest.fixture(autouse=True)
def ports(monkeypatch: pytest.MonkeyPatch) -> list[str]:
    found = list(PORTS)
    monkeypatch.setattr(nearly, "devices", lambda: found)
    return found


@each(
    ("target", "found"),
    [
        ("192.168.2.3", "tcp://192.168.2.3"),
        ("192.168.2.3:500", "tcp://192.168.2.3:500"),
        ("127.0.0.1:5500", "tcp://127.0.0.1:5500"),
        ("[::1]:500", "tcp://[::1]:500"),
        ("plc.local", "tcp://plc.local"),
        ("localhost", "tcp://localhost"),
        ("press:500", "tcp://press:500"),
        ("tcp:192.168.2.3", "tcp://192.168.2.3"),
        ("udp:192.168.2.3:500", "udp://192.168.2.3:500"),
        ("tcp//192.168.2.3", "tcp://192.168.2.3"),
        ("http://192.168.2.3/", "tcp://192.168.2.3"),
        ("sim", "sim:"),
        ("Simulator", "sim:"),
        ("press.state", "sim:press.state"),
        ("/dev/ttyUSB", "/dev/ttyUSB0 or /dev/ttyUSB1"),
        ("/dev/ttyusb1", "/dev/ttyUSB1"),
        ("ttyUSB", "/dev/ttyUSB0 or /dev/ttyUSB1"),
        ("ttyUSB7", "/dev/ttyUSB7"),
    ],
)
def test_it_is_said_what_was_meant(target: str, found: str) -> None:
    assert meant(target) == next_step(target) == f"did you mean {found}?"


@each(
    "target",
    ["press", "/dev/ttyUSB9", "COM9", "press.json", "tcp://a:b", "tcp://192.168.2.3", "ftp://x", "/x/y"],
)
def test_nothing_is_suggested_that_is_not_near(target: str) -> None:
    assert meant(target) is None
    assert "did you mean" not in next_step(target)


def test_a_name_needs_an_inventory() -> None:
    assert next_step("press").startswith("for the name of a PLC there must be an inventory: ")
    assert "inventory" not in next_step("COM9")
    assert "inventory" not in next_step("press.json")


def test_a_port_has_a_number(ports: list[str]) -> None:
    ports.clear()
    assert next_step("/dev/ttyUSB").startswith("a port's name ends in a number, such as /dev/ttyUSB0; ")
    assert next_step("/dev/ttyUSB9").startswith("check that the adapter is plugged in")
