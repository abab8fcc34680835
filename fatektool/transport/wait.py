"""Waiting for one file descriptor, with ``poll`` or ``select``.

``poll`` where it exists, because ``select`` fails for descriptors above 1023; else ``select``, which on
Windows has no such limit.
"""

from __future__ import annotations

import select
from typing import TYPE_CHECKING, Final

if TYPE_CHECKING:
    from collections.abc import Callable


_LONGEST_S: Final = 86400.0
"""A wait may be shorter than asked, and ``poll`` cannot count the milliseconds of a month."""


def readable(descriptor: int) -> Callable[[float], bool]:
    """A function that waits at most so many seconds until there is something to read, or the end."""
    return _waiter(descriptor, writing=False)


def writable(descriptor: int) -> Callable[[float], bool]:
    """A function that waits at most so many seconds until bytes can be written."""
    return _waiter(descriptor, writing=True)


def _waiter(descriptor: int, *, writing: bool) -> Callable[[float], bool]:
    if hasattr(select, "poll"):
        poller = select.poll()
        poller.register(descriptor, select.POLLOUT if writing else select.POLLIN)

        def wait_poll(timeout_s: float) -> bool:
            return bool(poller.poll(_bounded(timeout_s) * 1000 if timeout_s else 0))

        return wait_poll

    def wait_select(timeout_s: float) -> bool:
        watched = [descriptor]
        found = select.select([] if writing else watched, watched if writing else [], [], _bounded(timeout_s))
        return any(found)

    return wait_select


def _bounded(timeout_s: float) -> float:
    return min(max(0.0, timeout_s), _LONGEST_S)
