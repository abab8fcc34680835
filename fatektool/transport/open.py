"""From a target to an open transport, locked for this process.

Each medium's file is loaded only when its kind of target is named.
"""

from __future__ import annotations

from typing import TYPE_CHECKING, Final

from fatektool.callbacks import ignore
from fatektool.errors import UsageError
from fatektool.transport.lock import PortLock
from fatektool.transport.patience import Patience
from fatektool.transport.target import Target, TargetKind

if TYPE_CHECKING:
    from collections.abc import Callable
    from contextlib import ExitStack

    from fatektool.transport.base import LineSettings, Transport

ONE_TRY: Final = Patience()


def open_transport(
    target: Target,
    line: LineSettings,
    stack: ExitStack,
    *,
    lock_wait_s: float = 10.0,
    low_latency: bool = True,
    note: Callable[[str], None] = ignore,
    waiting: Callable[[str], None] = ignore,
    on_lock: Callable[[PortLock], object] = lambda _lock: None,
    patience: Patience = ONE_TRY,
) -> Transport:
    """Lock a serial port, TCP or UDP target and open it; a modem calls and is connected.

    Args:
        target: where; anything but a simulated PLC.
        line: speed and format of a serial port; of a modem's, to the modem.
        stack: closes the transport and gives the lock back when it ends.
        lock_wait_s: how long to wait for another process.
        low_latency: ask the driver of a serial port to hand on at once what it receives, on Linux.
        note: is told what a curious user may want to know.
        waiting: is told whom this process waits for.
        on_lock: is given the lock.
        patience: how often a connection that is refused or closed is tried.

    Raises:
        LineError: it cannot be opened, or the call finds nobody; PortBusy among them.
        UsageError: a target that is no medium.
    """
    if target.on_serial_port:
        from fatektool.transport.serial_line.port import open_serial

        on_lock(_lock(_serial_line(target.path), lock_wait_s, stack, waiting))
        port = stack.enter_context(
            patience.opened(lambda: open_serial(target.path, line, low_latency=low_latency, note=note))
        )
        if target.call is None:
            return port
        from fatektool.transport.modem.device import ModemTransport

        modem = stack.enter_context(ModemTransport(port, target.call, note))
        modem.connect()
        return modem
    if target.kind in {TargetKind.TCP, TargetKind.UDP}:
        from fatektool.transport.sockets import resolve

        address = resolve(target.host, target.port)
        on_lock(_lock(f"{address[0]}:{address[1]}", lock_wait_s, stack, waiting))
        if target.kind is TargetKind.TCP:
            from fatektool.transport.tcp import TcpTransport

            return stack.enter_context(patience.opened(lambda: TcpTransport(target.text, address)))
        from fatektool.transport.udp import UdpTransport

        return stack.enter_context(UdpTransport(target.text, address))
    raise UsageError(f"target {target.text!r} is no line that can be opened here")


def _serial_line(path: str) -> str:
    """The line of a serial target: a gateway's address where a URL leads to one, else its device or URL."""
    from fatektool.transport.serial_line.url import host_of, line_of

    gateway = host_of(path)
    if gateway is None:
        return line_of(path)
    from fatektool.transport.sockets import resolve

    address = resolve(*gateway)
    return f"{address[0]}:{address[1]}"


def _lock(resource: str, wait_s: float, stack: ExitStack, waiting: Callable[[str], None]) -> PortLock:
    lock = PortLock(resource, wait_s, waiting=waiting)
    lock.acquire()
    stack.callback(lock.release)
    return lock
