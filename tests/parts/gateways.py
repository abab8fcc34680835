"""Serial gateways: ser2net and socat in front of a simulated PLC, on ports that they keep over a restart."""

from __future__ import annotations

from contextlib import ExitStack
from dataclasses import dataclass, field
from typing import TYPE_CHECKING, Self

from tests.parts.programs import command, free_port, listening, running

if TYPE_CHECKING:
    from collections.abc import Callable
    from pathlib import Path

    from tests.parts.programs import Running


@dataclass
class Gateway:
    """A gateway that may be cut and put back.

    Attributes:
        target: where a client finds it.
        start: starts it, on this stack.
    """

    target: str
    start: Callable[[ExitStack], Running]
    _stack: ExitStack = field(default_factory=ExitStack)
    _running: Running | None = None

    def put_back(self) -> None:
        """Start it; it is ready then."""
        self._running = self.start(self._stack)

    def cut(self) -> None:
        """End it at once; nothing closes a connection in order."""
        assert self._running is not None
        self._running.kill()

    def __enter__(self) -> Self:
        self.put_back()
        return self

    def __exit__(self, *_: object) -> None:
        self._stack.close()


def ser2net(device: Path, scheme: str, folder: Path, options: str = "") -> Gateway:
    """ser2net before a serial device, as bare bytes or as RFC 2217 by the scheme of the target.

    Args:
        device: the serial device.
        scheme: of the target.
        folder: for its files.
        options: more lines of its configuration for this port.
    """
    port, ready = free_port(), free_port()
    accepter = f"tcp(nodelay),127.0.0.1,{port}"  # else it keeps the rest of an answer for 40 ms
    if scheme == "rfc2217":
        accepter = f"telnet(rfc2217),{accepter}"
    settings = folder / f"ser2net-{port}.yaml"
    settings.write_text(
        f"connection: &plc\n  accepter: {accepter}\n  connector: serialdev,{device},9600n81,local\n{options}"
        f"connection: &ready\n  accepter: tcp,127.0.0.1,{ready}\n  connector: echo\n"
    )

    def start(stack: ExitStack) -> Running:
        return stack.enter_context(listening(command("ser2net", "-d", "-u", "-c", settings), ready))

    return Gateway(f"{scheme}://127.0.0.1:{port}", start)


def socat_tcp(device: Path, scheme: str, _: Path) -> Gateway:
    """socat before a serial device, for one connection at a time: two would take each other's bytes."""
    port = free_port()
    listen = f"TCP-LISTEN:{port},bind=127.0.0.1,reuseaddr,fork,max-children=1"

    def start(stack: ExitStack) -> Running:
        words = command("socat", "-d", "-d", "-t", "0.05", listen, f"FILE:{device},raw,echo=0")
        return stack.enter_context(running(words, "listening on"))

    return Gateway(f"{scheme}://127.0.0.1:{port}", start)


def socat_udp(address: str) -> Gateway:
    """socat from UDP to a server on TCP; each client has a connection of its own."""
    port = free_port()

    def start(stack: ExitStack) -> Running:
        words = command(
            "socat", "-d", "-d", f"UDP-LISTEN:{port},bind=127.0.0.1,fork", f"TCP:{_place(address)}"
        )
        return stack.enter_context(running(words, "listening on"))

    return Gateway(f"udp://127.0.0.1:{port}", start)


def _place(address: str) -> str:
    return address.partition("://")[2]


def socat_device(address: str, link: Path) -> Gateway:
    """socat as a serial port of this computer, whose bytes go to a server on TCP."""

    def start(stack: ExitStack) -> Running:
        words = command("socat", "-d", "-d", f"PTY,link={link},raw,echo=0", f"TCP:{_place(address)}")
        return stack.enter_context(running(words, "starting data transfer"))

    return Gateway(str(link), start)
