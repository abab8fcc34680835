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
from fatektool.protocol.facon import FACON
from fatektool.transport.base import LineSettings, no_note
from fatektool.transport.target import Target, TargetKind

if TYPE_CHECKING:
    from collections.abc import Callable
    from pathlib import Path

    from fatektool.protocol.codec import Codec
    from fatektool.transport.base import Transport

CODECS: dict[str, Codec] = {FACON.name: FACON}


def connect(
    target: str,
    *,
    station: int = 1,
    protocol: str = "facon",
    baud: int = 9600,
    format: str = "7E1",  # noqa: A002  # the option's name
    timeout_s: float = 0.5,
    retries: int = 3,
    lock_wait_s: float = 10.0,
    trace: Path | None = None,
    note: Callable[[str], None] = no_note,
) -> Plc:
    """Open the line to a PLC. Nothing is sent yet.

    Args:
        target: ``/dev/ttyUSB0``, ``COM3``, a pyserial URL, ``tcp://host[:500]``, ``udp://host[:500]``,
            ``sim:`` or ``sim:FILE``.
        station: 1 to 254.
        protocol: ``facon``.
        baud: speed of the serial line; over TCP and UDP that of the line behind a gateway.
        format: data bits, parity, stop bits.
        timeout_s: the PLC's time to answer, beside wire time.
        retries: further tries of one exchange.
        lock_wait_s: how long to wait for a port that another process uses.
        trace: record the wire in this file, ``.pcap`` or ``.ndjson``.
        note: is told what a curious user may want to know.

    Raises:
        UsageError: something named is not there to be named.
        LineError: the port or gateway cannot be opened; ``PortBusy`` among them.
    """
    codec = CODECS.get(protocol)
    if codec is None:
        raise UsageError(f"protocol {protocol!r}: expected one of {', '.join(CODECS)}")
    if not 0 < timeout_s < inf or retries < 0:
        raise UsageError(f"expected a timeout above 0 and retries from 0, got {timeout_s:g} and {retries}")
    line = LineSettings(baud, format)
    where = Target.parse(target)
    stack = ExitStack()
    try:
        transport = _open(where, station=station, line=line, stack=stack, lock_wait_s=lock_wait_s, note=note)
        if trace is not None:
            from fatektool.transport.trace import TracedTransport, open_trace

            transport = stack.enter_context(TracedTransport(transport, open_trace(trace, protocol)))
        link = Link(transport, codec, station, line, timeout_s=timeout_s, retries=retries, note=note)
    except BaseException:
        stack.close()
        raise
    return Plc(link, target, stack)


def _open(
    where: Target,
    *,
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
    simulation = build_simulation(None if kept else [station], state=state)
    return stack.enter_context(MemoryTransport(simulation.line(), where.text))
