"""The line to a simulated PLC in this process: ``sim:``, and ``sim:FILE``.

It has a clock of its own. ``sim:FILE`` saves its memory in FILE after each change, as a real PLC keeps it.
"""

from __future__ import annotations

from os.path import realpath
from pathlib import Path
from typing import TYPE_CHECKING, Final

from fatektool.simulator.build import build_simulation
from fatektool.transport.lock import PortLock
from fatektool.transport.memory import MemoryTransport

if TYPE_CHECKING:
    from collections.abc import Callable
    from contextlib import ExitStack

    from fatektool.address import PlcAddress

_LAST_STATION: Final = 254


def open_simulated(
    address: PlcAddress,
    stack: ExitStack,
    lock_wait_s: float,
    on_lock: Callable[[PortLock], object],
    waiting: Callable[[str], None],
) -> MemoryTransport:
    """Make a simulated PLC, or load it from its file, which is locked, and open the line to it.

    Args:
        address: its address; PLCs in a file have their own stations.
        stack: closes the line and releases the lock when it ends.
        lock_wait_s: how long to wait for another process that has the file, in seconds.
        on_lock: gets the lock of the file.
        waiting: gets a message with the process that has the file, if it must be waited for.

    Raises:
        PortBusy: another process has the file.
        DataError: the file is not the memory of a simulated PLC.
    """
    where = address.where
    state = Path(where.path) if where.path else None
    if state is not None:
        lock = PortLock(realpath(state), lock_wait_s, waiting=waiting)
        lock.acquire()
        stack.callback(lock.release)
        on_lock(lock)
    is_kept = state is not None and state.exists()
    station, settings = address.station, address.line_settings
    simulation = build_simulation(
        None if is_kept else [station if 1 <= station <= _LAST_STATION else 1],
        protocol=address.protocol,
        state=state,
        baud=settings.baud,  # of simulated time: a test of so many seconds must end
        bits_per_char=settings.byte_time_s * settings.baud,
    )
    line = simulation.line(whole_answers=True)  # pieces would cost computing time, and the line has no other
    return stack.enter_context(MemoryTransport(line, where.text))
