"""What ends a command beside Ctrl-C: Ctrl-Break, a closed terminal, a closed console."""

from __future__ import annotations

import signal
from typing import TYPE_CHECKING

import pytest

from fatektool.cli.shared import stops
from fatektool.system.console import handle
from tests.platforms import posix
from tests.rows import each

if TYPE_CHECKING:
    from collections.abc import Iterator


NAMES = [name for name in ("SIGTERM", "SIGHUP") if hasattr(signal, name)]


@pytest.fixture(autouse=True)
def _handlers() -> Iterator[None]:
    kept = {number: signal.getsignal(number) for number in (getattr(signal, name) for name in NAMES)}
    yield
    for number, handler in kept.items():
        signal.signal(number, handler)


@pytest.mark.parametrize("name", NAMES)
def test_a_signal_that_ends_a_command(name: str) -> None:
    stops.end_cleanly()
    with pytest.raises(KeyboardInterrupt):
        signal.raise_signal(getattr(signal, name))


@posix("a closed terminal is a signal")
def test_under_nohup_a_closed_terminal_ends_nothing() -> None:
    signal.signal(signal.SIGHUP, signal.SIG_IGN)
    stops.end_cleanly()
    signal.raise_signal(signal.SIGHUP)


@each(
    ("event", "expected"),
    [(0, []), (1, ["interrupt"]), *((event, ["interrupt", "wait"]) for event in (2, 5, 6))],
)
def test_an_event_of_the_console(event: int, expected: list[str]) -> None:
    """Interrupt first, then wait: the system ends the process as soon as the handler returns."""
    done: list[str] = []
    handled = handle(event, lambda: done.append("interrupt"), lambda _: done.append("wait"))
    assert (handled, done) == (bool(expected), expected)
