"""From what a user names to a PLC that can be asked: target, lock, transport, trace, link.

A simulated PLC (``sim:``) lives in this process, on a clock of its own; ``sim:FILE`` keeps its memory in FILE
after each change, as a real one would.
"""

from __future__ import annotations

from contextlib import ExitStack
from math import inf
from typing import TYPE_CHECKING

from fatektool.client import Plc
from fatektool.errors import UsageError
from fatektool.link import Link
from fatektool.protocol.codec import require_commands
from fatektool.protocol.facon import FACON
from fatektool.protocol.mseries import MSERIES
from fatektool.transport.base import LineSettings, no_note
from fatektool.transport.target import Target, TargetKind

if TYPE_CHECKING:
    from collections.abc import Callable, Iterable
    from pathlib import Path

    from fatektool.protocol.codec import Codec
    from fatektool.protocol.commands import Command
    from fatektool.transport.base import Transport

CODECS: dict[str, Codec] = {FACON.name: FACON, MSERIES.name: MSERIES}


def codec_named(protocol: str) -> Codec:
    """The codec of this name.

    Raises:
        UsageError: there is none.
    """
    codec = CODECS.get(protocol)
    if codec is None:
        raise UsageError(f"protocol {protocol!r}: expected one of {', '.join(CODECS)}")
    return codec


def usual_format(protocol: str) -> str:
    """The line format of a protocol unless one is named: even parity and as many data bits as it needs."""
    return f"{codec_named(protocol).data_bits}E1"


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
    note: Callable[[str], None] = no_note,
) -> Plc:
    """Open the line to a PLC. Nothing is sent yet.

    Args:
        target: ``/dev/ttyUSB0``, ``COM3``, a pyserial URL, ``tcp://host[:500]``, ``udp://host[:500]``,
            ``sim:`` or ``sim:FILE``. M-series over TCP has no usual port: it must be named.
        station: 1 to 254.
        protocol: ``facon`` or ``mseries``.
        baud: speed of the serial line; over TCP and UDP that of the line behind a gateway.
        format: data bits, parity, stop bits; by default 7E1, and 8E1 for ``mseries``.
        timeout_s: the PLC's time to answer, beside wire time.
        retries: further tries of one exchange.
        lock_wait_s: how long to wait for a port that another process uses.
        trace: record the wire in this file, ``.pcap`` or ``.ndjson``.
        needs: the commands without which there is nothing to do here.
        note: is told what a curious user may want to know.

    Raises:
        UsageError: something named is not there to be named, or the protocol lacks what is needed.
        LineError: the port or gateway cannot be opened; ``PortBusy`` among them.
    """
    codec = codec_named(protocol)
    require_commands(codec, *needs)
    if not 0 < timeout_s < inf or retries < 0:
        raise UsageError(f"expected a timeout above 0 and retries from 0, got {timeout_s:g} and {retries}")
    line = LineSettings(baud, usual_format(protocol) if format is None else format)
    stack = ExitStack()
    try:
        transport = open_line(
            target,
            stack,
            line,
            protocol=protocol,
            station=station,
            lock_wait_s=lock_wait_s,
            trace=trace,
            note=note,
        )
        link = Link(transport, codec, station, line, timeout_s=timeout_s, retries=retries, note=note)
    except BaseException:
        stack.close()
        raise
    return Plc(link, target, stack)


def open_line(
    target: str,
    stack: ExitStack,
    line: LineSettings,
    *,
    protocol: str = "facon",
    station: int = 1,
    lock_wait_s: float = 10.0,
    trace: Path | None = None,
    note: Callable[[str], None] = no_note,
) -> Transport:
    """Open the line alone, for who asks more than one PLC on it.

    Args:
        target: as for ``connect``.
        stack: closes the line and gives its lock back when it ends.
        line: speed and format.
        protocol: what will be spoken on it.
        station: of a simulated PLC.
        lock_wait_s: as for ``connect``.
        trace: as for ``connect``.
        note: as for ``connect``.

    Raises:
        UsageError, LineError: as ``connect``.
    """
    where = Target.parse(target, default_port=codec_named(protocol).default_tcp_port)
    data_bits = codec_named(protocol).data_bits
    if where.kind is TargetKind.SERIAL and line.data_bits < data_bits:
        raise UsageError(
            f"{protocol} on a serial line: expected {data_bits} data bits, got the format {line.format}",
            hint=f"add --format {usual_format(protocol)} or {data_bits}N1, as the PLC's port is set",
        )
    transport = _open(
        where, protocol=protocol, station=station, line=line, stack=stack, lock_wait_s=lock_wait_s, note=note
    )
    if trace is None:
        return transport
    from fatektool.transport.trace import TracedTransport, open_trace

    return stack.enter_context(TracedTransport(transport, open_trace(trace, protocol)))


def _open(
    where: Target,
    *,
    protocol: str,
    station: int,
    line: LineSettings,
    stack: ExitStack,
    lock_wait_s: float,
    note: Callable[[str], None],
) -> Transport:
    if where.kind is not TargetKind.SIM:
        from fatektool.transport.open import open_transport

        return open_transport(where, line, stack, lock_wait_s=lock_wait_s, note=note)
    from os.path import realpath
    from pathlib import Path

    from fatektool.simulator.build import build_simulation
    from fatektool.transport.memory import MemoryTransport

    state = Path(where.path) if where.path else None
    if state is not None:
        from fatektool.transport.lock import PortLock

        lock = PortLock(realpath(state), lock_wait_s)
        lock.acquire()
        stack.callback(lock.release)
    kept = state is not None and state.exists()  # the PLCs in a file have stations of their own
    simulation = build_simulation(
        None if kept else [station],
        protocol=protocol,
        state=state,
        baud=line.baud,  # of the clock's time, which costs none: a test of so many seconds has an end
        bits_per_char=line.byte_time_s * line.baud,
    )
    return stack.enter_context(MemoryTransport(simulation.line(), where.text))
