"""A pseudo terminal as a listener: a serial port for its client. POSIX only.

::

    client ── link ──> /dev/pts/7 (slave end) ═══ master end ── line ──> PLCs

The listener keeps the slave end open itself, so the terminal stays usable after a client closes the port. If
answers fill the terminal's buffer and nobody reads them, the next request drops them, as a serial port
overruns: a client that sends again has given up the earlier answers.

The link is a symbolic link with a path given by the user; see ``pty_symlink``.
"""

from __future__ import annotations

import contextlib
import os
import selectors
from typing import TYPE_CHECKING

from fatektool.errors import LineError, UsageError
from fatektool.simulator.listen.pty_symlink import LOCKS_SUPPORTED, PtyLink

try:
    import pty
    import termios
    import tty
except ImportError:  # Windows has none of them
    PTY_SUPPORTED = False
else:
    PTY_SUPPORTED = LOCKS_SUPPORTED

if TYPE_CHECKING:
    from fatektool.simulator.listen.base import ServedLine
    from fatektool.simulator.listen.reactor import Reactor

_READ_BYTES = 65536
_OUTPUT_SPEED = 5
"""The index of the speed in a terminal's attributes: the setting of the client."""


class PtyListener:
    """A pseudo terminal with a link to it.

    Args:
        reactor: watches it.
        link: the path that clients open; created here, and removed at the end.
        baud: the only speed that is understood, as on a real line; None for any.
    """

    def __init__(self, reactor: Reactor, link: str | os.PathLike[str], baud: int | None = None) -> None:
        if not PTY_SUPPORTED:
            raise LineError(
                f"cannot open {os.fspath(link)}: this system has no pseudo terminals", hint="use TCP"
            )
        self._speed = None if baud is None else _speed(baud)
        self._reactor = reactor
        self._closed = False
        self._link = PtyLink(link)
        self.address = str(self._link.path)
        try:
            self._master, self._slave = pty.openpty()
        except OSError as error:
            self._link.remove()
            raise LineError(f"cannot open a pseudo terminal: {error.strerror}") from error
        try:
            tty.setraw(self._slave)
            self._link.point_to(os.ttyname(self._slave))
        except LineError:
            self._close_ends()
            raise
        for end in (self._master, self._slave):
            os.set_blocking(end, False)
        self._line: ServedLine = reactor.lines.line()
        self._backlog = bytearray()
        self._events = selectors.EVENT_READ
        reactor.selector.register(self._master, self._events, self._on_ready)

    def _on_ready(self, events: int) -> None:
        if events & selectors.EVENT_WRITE:
            self._write()
        if events & selectors.EVENT_READ:
            with contextlib.suppress(BlockingIOError, InterruptedError):
                data = os.read(self._master, _READ_BYTES)
                if self._backlog:
                    self._drop_unread()
                if self._speed not in {None, termios.tcgetattr(self._master)[_OUTPUT_SPEED]}:
                    return  # at another speed there are only framing errors
                self._reactor.dispatch(self._line.receive(data, self._reactor.now()), self._deliver)

    def _deliver(self, data: bytes) -> None:
        if not self._closed:
            self._backlog += data
            self._write()

    def _write(self) -> None:
        with contextlib.suppress(BlockingIOError, InterruptedError):
            del self._backlog[: os.write(self._master, self._backlog)]
        events = selectors.EVENT_READ | (selectors.EVENT_WRITE if self._backlog else 0)
        if events != self._events:
            self._events = events
            self._reactor.selector.modify(self._master, events, self._on_ready)

    def _drop_unread(self) -> None:
        # By reading, because flushing keeps what the kernel has not yet passed on to the terminal. A client
        # may have set the terminal to return nothing instead of an error at the end.
        self._backlog.clear()
        with contextlib.suppress(BlockingIOError, InterruptedError):
            while os.read(self._slave, _READ_BYTES):
                pass

    def lose_power(self) -> None:
        """Send no more; a port has no connection to close."""
        self._backlog.clear()

    def close(self) -> None:
        """Remove the link and close both ends; may be called again."""
        if self._closed:
            return
        self._closed = True
        self._reactor.selector.unregister(self._master)
        self._close_ends()

    def _close_ends(self) -> None:
        # The link first: while the terminal is open, its number cannot belong to another.
        self._link.remove()
        os.close(self._master)
        os.close(self._slave)


def _speed(baud: int) -> int:
    """The system's name of a speed.

    Raises:
        UsageError: it has none.
    """
    speed = getattr(termios, f"B{baud}", None)
    if speed is None:
        raise UsageError(
            f"--strict-baud: this system has no {baud} bits per second for a terminal", hint="such as 9600"
        )
    return int(speed)
