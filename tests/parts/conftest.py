from __future__ import annotations

import threading
import time
from types import SimpleNamespace

import pytest
import serial.rfc2217
import serial.urlhandler.protocol_socket

from tests.cli.conftest import cli, place

__all__ = ["cli", "place"]


@pytest.fixture(autouse=True)
def pyserial_in_a_hurry(monkeypatch: pytest.MonkeyPatch) -> None:
    """Its sockets sleep for 0.3 s when they are closed, and look every 50 ms whether an answer is there."""
    brief = SimpleNamespace(time=time.time, sleep=lambda seconds: threading.Event().wait(min(seconds, 0.002)))
    for module in (serial.rfc2217, serial.urlhandler.protocol_socket):
        monkeypatch.setattr(module, "time", brief)
