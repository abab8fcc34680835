"""From a target to an open transport, locked for this process.

The module of a medium is loaded only when a target needs it.
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
    settings: LineSettings,
    stack: ExitStack,
    *,
    lock_wait_s: float = 10.0,
    low_latency: bool = True,
    note: Callable[[str], None] = ignore,
    waiting: Callable[[str], None] = ignore,
    on_lock: Callable[[PortLock], object] = lambda _lock: None,
    patience: Patience = ONE_TRY,
) -> Transport:
    """Lock a serial port, TCP or UDP target and open it; with a modem, call and wait for the connection.

    Args:
        target: any but a simulated PLC.
        settings: speed and format of a serial port; with a modem, between computer and modem.
        stack: closes the transport and releases the lock when it ends.
        lock_wait_s: how long to wait for another process, in seconds.
        low_latency: on Linux, ask the driver of a serial port to pass on received bytes at once.
        note: gets details, for ``-v``.
        waiting: gets a message with the process that has the lock, if it must be waited for.
        on_lock: gets the lock.
        patience: retries of a connection that is refused or closed.

    Raises:
        LineError: it cannot be opened, or the call is not answered; ``PortBusy`` among them.
        UsageError: a target that is not a medium.
    """
    if target.on_serial_port:
        from fatektool.transport.serial_line.port import open_serial

        on_lock(_lock(_serial_line_name(target.path), lock_wait_s, stack, waiting))
        port = stack.enter_context(
            patience.opened(lambda: open_serial(target.path, settings, low_latency=low_latency, note=note))
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
    raise UsageError(f"target {target.text!r} cannot be opened as a line")


def _serial_line_name(path: str) -> str:
    """The name of a serial target's line: the address of its gateway, else its device or URL."""
    from fatektool.transport.serial_line.url import host_of, line_name

    gateway = host_of(path)
    if gateway is None:
        return line_name(path)
    from fatektool.transport.sockets import resolve

    address = resolve(*gateway)
    return f"{address[0]}:{address[1]}"


def _lock(resource: str, wait_s: float, stack: ExitStack, waiting: Callable[[str], None]) -> PortLock:
    lock = PortLock(resource, wait_s, waiting=waiting)
    lock.acquire()
    stack.callback(lock.release)
    return lock
