"""From what a user names to a PLC that can be asked: target, lock, transport, trace, link.

A simulated PLC (``sim:``) lives in this process, on a clock of its own; ``sim:FILE`` keeps its memory in FILE
after each change, as a real one would.
"""

from __future__ import annotations

from contextlib import ExitStack
from functools import partial
from math import inf
from time import sleep
from typing import TYPE_CHECKING, Final, Literal

from fatektool.client import Plc
from fatektool.errors import UsageError
from fatektool.exchange.link import Link
from fatektool.protocol.codec import require_commands, require_station
from fatektool.protocol.registry import codec_named
from fatektool.transport.base import LineSettings, no_note
from fatektool.transport.patience import Patience, PatientTransport
from fatektool.transport.target import Target, TargetKind

if TYPE_CHECKING:
    from collections.abc import Callable, Iterable
    from pathlib import Path

    from fatektool.protocol.codec import Codec
    from fatektool.protocol.commands import Command
    from fatektool.protocol.modbus.map import ModbusMap
    from fatektool.transport.base import Transport
    from fatektool.transport.lent import LentTransport
    from fatektool.transport.limit import Limit
    from fatektool.transport.lock import PortLock
    from fatektool.transport.shared_line import SharedLine

_LAST_STATION: Final = 254
_ONE_TRY: Final = Patience()


def _to_nobody(_: object) -> None:
    pass


def usual_format(protocol: str) -> str:
    """The line format of a protocol unless one is named: even parity and as many data bits as it needs."""
    return f"{codec_named(protocol).data_bits or 8}E1"


def connect(
    target: str,
    *,
    station: int = 1,
    protocol: str = "facon",
    baud: int = 9600,
    format: str | None = None,  # noqa: A002  # the option's name
    timeout_s: float = 0.5,
    retries: int = 3,
    lock_wait_s: float = 10.0,
    trace: Path | None = None,
    needs: Iterable[Command] = (),
    limit: Limit | None = None,
    read_only: bool = False,
    modbus_map: ModbusMap | Literal["custom"] | None = None,
    low_latency: bool = True,
    lend: bool = False,
    shared: SharedLine | None = None,
    note: Callable[[str], None] = no_note,
    waiting: Callable[[str], None] = no_note,
    warn: Callable[[str], None] = no_note,
) -> Plc:
    """Open the line to a PLC. Nothing is sent yet, but for ``modbus_map="custom"``.

    Args:
        target: ``/dev/ttyUSB0``, ``COM3``, a pyserial URL, ``tcp://host[:500]``, ``udp://host[:500]``,
            ``sim:`` or ``sim:FILE``, ``modem:/dev/ttyUSB0?number=0228082192`` (which calls). M-series over
            TCP has no usual port: it must be named.
        station: 1 to 254; over ``modbus-tcp`` 0 and 255 too, the PLC at the address itself.
        protocol: ``facon``, ``mseries``, ``modbus-rtu``, ``modbus-ascii`` or ``modbus-tcp``.
        baud: speed of the serial line; over TCP and UDP that of the line behind a gateway.
        format: data bits, parity, stop bits; by default 7E1, and 8E1 for ``mseries`` and
            ``modbus-rtu``.
        timeout_s: the PLC's time to answer, beside wire time.
        retries: further tries of one exchange.
        lock_wait_s: how long to wait for a port that another process uses.
        trace: record the wire in this file, ``.pcap`` or ``.ndjson``.
        needs: the commands without which there is nothing to do here.
        limit: ends everything on this line when it is over; None for no limit.
        read_only: refuse every request that writes, before a byte is sent.
        modbus_map: which elements have which Modbus references; by default the standard map. ``custom`` reads
            the PLC's own.
        low_latency: ask the driver of a serial port to hand on at once what it receives, on Linux.
        lend: True for who lets others have the line between two rounds, with ``Plc.lend``.
        shared: keeps the line open for the next PLC on it; not with ``trace``.
        note: is told what a curious user may want to know.
        waiting: is told, at once, who has the line, if it must be waited for.
        warn: is told once that answers come later than ``timeout_s``.

    Raises:
        UsageError: something named is not there to be named, or the protocol lacks what is needed.
        LineError: the port or gateway cannot be opened; ``PortBusy`` among them.
    """
    codec = codec_named(protocol)
    require_commands(codec, *needs)
    require_station(codec, station)
    if modbus_map is not None:
        codec = _mapped(codec, None if modbus_map == "custom" else modbus_map)
    if not 0 < timeout_s < inf or retries < 0:
        raise UsageError(f"expected a timeout above 0 and retries from 0, got {timeout_s:g} and {retries}")
    line = LineSettings(baud, usual_format(protocol) if format is None else format)
    stack = ExitStack()
    locks: list[PortLock] = []
    lines: list[LentTransport] = []
    patience = Patience(timeout_s, retries, sleep if limit is None else limit.pause, note)
    opened = partial(
        open_line,
        target,
        line=line,
        protocol=protocol,
        station=station,
        lock_wait_s=lock_wait_s,
        trace=trace,
        low_latency=low_latency,
        note=note,
        waiting=waiting,
        patience=patience,
    )
    try:
        if shared is None or trace is not None or target.startswith("sim:"):
            transport = opened(stack, locks.append, lines.append if lend else None)
        else:
            transport, locks = shared.take(target, line, opened), shared.locks
        transport = _with_patience(transport, target, patience, limit)
        link = Link(
            transport,
            codec,
            station,
            line,
            timeout_s=timeout_s,
            retries=retries,
            read_only=read_only,
            note=note,
            warn=warn,
        )
        for lock in locks:
            _hand_over_doubt(lock, link)
        if shared is not None:
            stack.callback(_end_turn, shared, link)
        for lent in lines:
            lent.on_lock = partial(_hand_over_doubt, link=link)
        if modbus_map == "custom":
            _use_own_map(link)
    except BaseException:
        stack.close()
        if shared is not None:
            shared.close()
        raise
    return Plc(link, target, stack, lines[0] if lines else None)


def _mapped(codec: Codec, modbus_map: ModbusMap | None) -> Codec:
    from fatektool.exchange.plc_map import mapped

    return mapped(codec, modbus_map)


def _use_own_map(link: Link) -> None:
    from fatektool.exchange.plc_map import map_in_plc

    link.state.codec = _mapped(link.codec, map_in_plc(link))


def _with_patience(transport: Transport, target: str, patience: Patience, limit: Limit | None) -> Transport:
    """The line within a limit of time; a connection that fails is made anew after a pause, within it too."""
    if limit is not None:
        from fatektool.transport.limit import LimitedTransport

        transport = LimitedTransport(transport, limit)
    return PatientTransport(transport, patience) if "://" in target else transport


def _end_turn(shared: SharedLine, link: Link) -> None:
    """Leave a line open that is in order; close one on which an answer may be on its way."""
    if link.receiver.needs_fence:
        shared.close()


def _hand_over_doubt(lock: PortLock, link: Link) -> None:
    """Begin behind a fence where the one before left an answer on its way; leave word of one of our own.

    A doubt that no fence took away is not handed on a second time: by then the line was listened to for as
    long as a PLC may take, and a PLC without loopbacks (4E) is not to be locked out for ever.
    """
    inherited, fences = lock.found_doubt, link.counters.fences
    if inherited:
        link.fences.assume_outstanding_answer()
    lock.leaves_doubt = lambda: (
        link.receiver.needs_fence and not (inherited and link.counters.fences == fences)
    )


def open_line(
    target: str,
    stack: ExitStack,
    on_lock: Callable[[PortLock], object] = _to_nobody,
    on_lent: Callable[[LentTransport], object] | None = None,
    *,
    line: LineSettings,
    protocol: str = "facon",
    station: int = 1,
    lock_wait_s: float = 10.0,
    trace: Path | None = None,
    low_latency: bool = True,
    note: Callable[[str], None] = no_note,
    waiting: Callable[[str], None] = no_note,
    patience: Patience = _ONE_TRY,
) -> Transport:
    """Open the line alone, for who asks more than one PLC on it.

    Args:
        target: as for ``connect``.
        stack: closes the line and gives its lock back when it ends.
        on_lock: is given the lock of a real line, each time that it is taken.
        on_lent: is given a line that can be lent; None if it shall not be. A modem's call goes on.
        line: speed and format.
        protocol: what will be spoken on it.
        station: of a simulated PLC.
        lock_wait_s: as for ``connect``.
        trace: as for ``connect``.
        low_latency: as for ``connect``.
        note: as for ``connect``.
        waiting: as for ``connect``.
        patience: how often a connection that is refused or closed is tried.

    Raises:
        UsageError, LineError: as ``connect``.
    """
    where = Target.parse(target, default_port=codec_named(protocol).default_tcp_port)
    data_bits = codec_named(protocol).data_bits
    if where.on_serial_port and data_bits is None and not where.is_url:
        raise UsageError(
            f"{protocol} is for networks: expected tcp://HOST, got {target!r:.80}",
            hint="on a serial line it is modbus-rtu or modbus-ascii",
        )
    if where.on_serial_port and data_bits is not None and line.data_bits < data_bits:
        raise UsageError(
            f"{protocol} on a serial line: expected {data_bits} data bits, got the format {line.format}",
            hint=f"add --format {usual_format(protocol)} or {data_bits}N1, as the PLC's port is set",
        )
    opened = partial(
        _open,
        where,
        protocol=protocol,
        station=station,
        line=line,
        low_latency=low_latency,
        note=note,
        waiting=waiting,
        patience=patience,
    )
    if on_lent is None or where.kind is TargetKind.MODEM:
        transport = opened(stack, lock_wait_s, on_lock)
    else:
        from fatektool.transport.lent import LentTransport

        transport = lent = stack.enter_context(LentTransport(opened, lock_wait_s, on_lock))
        on_lent(lent)
    if trace is None:
        return transport
    from fatektool.transport.trace import TracedTransport, open_trace

    return stack.enter_context(TracedTransport(transport, open_trace(trace, protocol)))


def _open(
    where: Target,
    stack: ExitStack,
    lock_wait_s: float,
    on_lock: Callable[[PortLock], object],
    *,
    protocol: str,
    station: int,
    line: LineSettings,
    low_latency: bool,
    note: Callable[[str], None],
    waiting: Callable[[str], None],
    patience: Patience,
) -> Transport:
    if where.kind is not TargetKind.SIM:
        from fatektool.transport.open import open_transport

        return open_transport(
            where,
            line,
            stack,
            lock_wait_s=lock_wait_s,
            low_latency=low_latency,
            note=note,
            waiting=waiting,
            on_lock=on_lock,
            patience=patience,
        )
    from os.path import realpath
    from pathlib import Path

    from fatektool.simulator.build import build_simulation
    from fatektool.transport.memory import MemoryTransport

    state = Path(where.path) if where.path else None
    if state is not None:
        from fatektool.transport.lock import PortLock

        lock = PortLock(realpath(state), lock_wait_s, waiting=waiting)
        lock.acquire()
        stack.callback(lock.release)
        on_lock(lock)
    kept = state is not None and state.exists()  # the PLCs in a file have stations of their own
    simulation = build_simulation(
        None if kept else [station if 1 <= station <= _LAST_STATION else 1],
        protocol=protocol,
        state=state,
        baud=line.baud,  # of the clock's time, which costs none: a test of so many seconds has an end
        bits_per_char=line.byte_time_s * line.baud,
    )
    return stack.enter_context(MemoryTransport(simulation.line(), where.text))
