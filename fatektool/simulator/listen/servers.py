"""The server of a simulator: its listeners, and the thread that serves them."""

from __future__ import annotations

import contextlib
import threading
from typing import TYPE_CHECKING

from fatektool.simulator.listen.discovery import ANSWER_PORT, DiscoveryListener
from fatektool.simulator.listen.pty import PtyListener
from fatektool.simulator.listen.reactor import Reactor
from fatektool.simulator.listen.tcp import TcpListener
from fatektool.simulator.listen.udp import UdpListener

if TYPE_CHECKING:
    import os
    from collections.abc import Iterator

    from fatektool.simulator.listen.base import Listener


class Server(Reactor):
    """Listeners of one simulation or replay. Open them, then serve; one thread serves all."""

    def open_tcp(self, host: str = "127.0.0.1", port: int = 0) -> Listener:
        """Listen on TCP; port 0 for any free one. LineError if it cannot be used."""
        return self._opened(TcpListener(self, host, port))

    def open_udp(self, host: str = "127.0.0.1", port: int = 0) -> Listener:
        """Listen on UDP; port 0 for any free one. LineError if it cannot be used."""
        return self._opened(UdpListener(self, host, port))

    def open_discovery(
        self, host: str = "127.0.0.1", port: int = 0, answer_port: int = ANSWER_PORT
    ) -> Listener:
        """Answer discovery requests for Ethernet modules by UDP. LineError if the address cannot be used."""
        return self._opened(DiscoveryListener(self, host, port, answer_port))

    def open_pty(self, link: str | os.PathLike[str], baud: int | None = None) -> Listener:
        """Create a pseudo terminal with a link to it. LineError if that fails.

        Args:
            link: the path that clients open.
            baud: the only speed that is understood; None for any.
        """
        return self._opened(PtyListener(self, link, baud))

    def _opened(self, listener: Listener) -> Listener:
        self.listeners.append(listener)
        return listener


@contextlib.contextmanager
def running(server: Server) -> Iterator[Server]:
    """Serve in a thread during the context, then close the server."""
    failures: list[BaseException] = []

    def serve() -> None:
        try:
            server.serve_until()
        except BaseException as error:  # noqa: BLE001 - raised again where the context ends
            failures.append(error)
            server.close()  # clients see the end of the connection, not a silence

    thread = threading.Thread(target=serve, name="fatektool simulator", daemon=True)
    thread.start()
    try:
        yield server
    finally:
        server.stop()
        thread.join()
        server.close()
    if failures:
        raise failures[0]
