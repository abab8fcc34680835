"""What ends a command beside Ctrl-C: Ctrl-Break, a closed terminal, a closed console."""

from __future__ import annotations

import os
import signal
from typing import TYPE_CHECKING

import pytest

from fatektool.cli.shared import stops
from fatektool.system.console import closed
from tests.rows import each

if TYPE_CHECKING:
    from collections.abc import Iterator

if os.name != "posix":
    pytest.skip("signals of POSIX stand for those of Windows", allow_module_level=True)


@pytest.fixture(autouse=True)
def _handlers() -> Iterator[None]:
    kept = {number: signal.getsignal(number) for number in (signal.SIGTERM, signal.SIGHUP, signal.SIGUSR1)}
    yield
    for number, handler in kept.items():
        signal.signal(number, handler)


@pytest.mark.parametrize("name", ["SIGTERM", "SIGHUP", "SIGBREAK"])
def test_a_signal_that_ends_a_command(name: str, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(signal, "SIGBREAK", signal.SIGUSR1, raising=False)  # of Windows alone
    stops.end_cleanly()
    with pytest.raises(KeyboardInterrupt):
        signal.raise_signal(getattr(signal, name))


def test_under_nohup_a_closed_terminal_ends_nothing() -> None:
    signal.signal(signal.SIGHUP, signal.SIG_IGN)
    stops.end_cleanly()
    signal.raise_signal(signal.SIGHUP)


@each(("event", "ends"), [(0, False), (1, False), (2, True), (5, True), (6, True)])
def test_a_console_that_is_closed_waits_for_the_end(event: int, *, ends: bool) -> None:
    """Interrupt first, then wait: the system ends the process as soon as the handler returns."""
    done: list[str] = []
    assert closed(event, lambda: done.append("interrupt"), lambda _: done.append("wait")) == ends
    assert done == (["interrupt", "wait"] if ends else [])
