"""Connections to PLCs: from an address to lock, transport, trace and link."""

from __future__ import annotations

from contextlib import ExitStack
from functools import partial
from time import sleep
from typing import TYPE_CHECKING

from fatektool.address import PlcAddress
from fatektool.callbacks import ignore
from fatektool.client import Plc
from fatektool.exchange.link import Link
from fatektool.protocol.codec import require_commands
from fatektool.transport.open import ONE_TRY, open_transport
from fatektool.transport.patience import Patience, PatientTransport
from fatektool.transport.target import TargetKind

if TYPE_CHECKING:
    from collections.abc import Callable, Iterable
    from typing import Unpack

    from fatektool.address import Settings
    from fatektool.protocol.codec import Codec
    from fatektool.protocol.commands import Command
    from fatektool.protocol.modbus.map import ModbusMap
    from fatektool.transport.base import Transport
    from fatektool.transport.lent import LentTransport
    from fatektool.transport.limit import Limit
    from fatektool.transport.lock import PortLock
    from fatektool.transport.shared_line import SharedLine
    from fatektool.transport.target import Target


def connect(
    target: str | PlcAddress,
    *,
    needs: Iterable[Command] = (),
    limit: Limit | None = None,
    lend: bool = False,
    shared: SharedLine | None = None,
    note: Callable[[str], None] = ignore,
    waiting: Callable[[str], None] = ignore,
    warn: Callable[[str], None] = ignore,
    **settings: Unpack[Settings],
) -> Plc:
    """Open the line to a PLC. Nothing is sent yet, but for ``modbus_map="custom"``.

    Args:
        target: ``/dev/ttyUSB0``, ``tcp://192.168.2.3`` and others, as of ``PlcAddress``; or a whole address.
        needs: commands that the protocol must have.
        limit: the time after which every exchange on this line ends; None for no limit.
        lend: True to let other processes use the line between two rounds, with ``Plc.lend``.
        shared: keeps the line open for the next PLC on it; not with ``trace``.
        note: gets details, for ``-v``.
        waiting: gets a message with the process that has the line, if it must be waited for.
        warn: gets a message, once, if answers are received later than ``timeout_s``.
        settings: the other fields of ``PlcAddress``: ``station=3``, ``protocol="mseries"``, ``timeout_s=2``.

    Raises:
        UsageError: a wrong value, or the protocol does not have one of ``needs``.
        LineError: the port or gateway cannot be opened; ``PortBusy`` among them.
    """
    address = target.changed(**settings) if isinstance(target, PlcAddress) else PlcAddress(target, **settings)
    require_commands(address.codec, *needs)
    address.require_consistent()
    codec, own_map = address.codec, address.modbus_map
    if own_map is not None:
        codec = _mapped(codec, None if own_map == "custom" else own_map)
    stack = ExitStack()
    locks: list[PortLock] = []
    lines: list[LentTransport] = []
    patience = Patience(address.timeout_s, address.retries, sleep if limit is None else limit.pause, note)
    opened = partial(open_line, address, note=note, waiting=waiting, patience=patience)
    try:
        if shared is None or address.trace is not None or address.where.kind is TargetKind.SIM:
            transport = opened(stack, locks.append, lines.append if lend else None)
        else:
            transport, locks = shared.take(address.target, address.line_settings, opened), shared.locks
        transport = _with_patience(transport, address.target, patience, limit)
        link = Link(
            transport,
            codec,
            address.station,
            address.line_settings,
            timeout_s=address.timeout_s,
            retries=address.retries,
            read_only=address.read_only,
            note=note,
            warn=warn,
        )
        for lock in locks:
            _hand_over_doubt(lock, link)
        if shared is not None:
            stack.callback(_end_turn, shared, link)
        for lent in lines:
            lent.on_lock = partial(_hand_over_doubt, link=link)
        if own_map == "custom":
            _use_own_map(link)
    except BaseException:
        stack.close()
        if shared is not None:
            shared.close()
        raise
    return Plc(link, address.target, stack, lines[0] if lines else None)


def _mapped(codec: Codec, modbus_map: ModbusMap | None) -> Codec:
    from fatektool.exchange.plc_map import mapped

    return mapped(codec, modbus_map)


def _use_own_map(link: Link) -> None:
    from fatektool.exchange.plc_map import map_in_plc

    link.state.codec = _mapped(link.codec, map_in_plc(link))


def _with_patience(transport: Transport, target: str, patience: Patience, limit: Limit | None) -> Transport:
    """The line with its time limit; a lost connection is made again after a pause, within that limit."""
    if limit is not None:
        from fatektool.transport.limit import LimitedTransport

        transport = LimitedTransport(transport, limit)
    return PatientTransport(transport, patience) if "://" in target else transport


def _end_turn(shared: SharedLine, link: Link) -> None:
    """Keep the line open, unless a late answer may still be received on it."""
    if link.receiver.needs_fence:
        shared.close()


def _hand_over_doubt(lock: PortLock, link: Link) -> None:
    """Start with a fence if the process before left an answer unreceived; record the same for the next one.

    A doubt that no fence removed is not passed on a second time: by then the line was read for as long as a
    PLC may take, and a PLC without loopbacks (4E) must not be blocked for ever.
    """
    inherited, fences = lock.found_doubt, link.counters.fences
    if inherited:
        link.fences.assume_outstanding_answer()
    lock.leaves_doubt = lambda: (
        link.receiver.needs_fence and not (inherited and link.counters.fences == fences)
    )


def open_line(
    address: PlcAddress,
    stack: ExitStack,
    on_lock: Callable[[PortLock], object] = lambda _lock: None,
    on_lent: Callable[[LentTransport], object] | None = None,
    *,
    note: Callable[[str], None] = ignore,
    waiting: Callable[[str], None] = ignore,
    patience: Patience = ONE_TRY,
) -> Transport:
    """Open a line: ``connect`` for one PLC on it, a scan for several.

    Args:
        address: of a PLC on it.
        stack: closes the line and releases its lock when it ends.
        on_lock: gets the lock of the line, each time that it is locked.
        on_lent: gets the line if it can be released between two rounds; None to keep it. A call is never
            released.
        note: gets details, for ``-v``.
        waiting: gets a message with the process that has the line, if it must be waited for.
        patience: retries of a connection that is refused or closed.

    Raises:
        UsageError: it is not a target.
        LineError: the port or gateway cannot be opened; ``PortBusy`` among them.
    """
    where = address.where
    opened = partial(_open, address, where, note=note, waiting=waiting, patience=patience)
    if on_lent is None or where.kind is TargetKind.MODEM:
        transport = opened(stack, address.lock_wait_s, on_lock)
    else:
        from fatektool.transport.lent import LentTransport

        transport = lent = stack.enter_context(LentTransport(opened, address.lock_wait_s, on_lock))
        on_lent(lent)
    if address.trace is None:
        return transport
    from fatektool.transport.trace import TracedTransport, open_trace

    return stack.enter_context(TracedTransport(transport, open_trace(address.trace, address.protocol)))


def _open(
    address: PlcAddress,
    where: Target,
    stack: ExitStack,
    lock_wait_s: float,
    on_lock: Callable[[PortLock], object],
    *,
    note: Callable[[str], None],
    waiting: Callable[[str], None],
    patience: Patience,
) -> Transport:
    if where.kind is TargetKind.SIM:
        from fatektool.simulated import open_simulated

        return open_simulated(address, stack, lock_wait_s, on_lock, waiting)
    return open_transport(
        where,
        address.line_settings,
        stack,
        lock_wait_s=lock_wait_s,
        low_latency=address.low_latency,
        note=note,
        waiting=waiting,
        on_lock=on_lock,
        patience=patience,
    )
