"""A job leaves the line no pause, and sends little more than what it cannot do without.

The clock is the line's own: it moves by wire time and by waiting alone. So a job that never waits ends when
the last of its bytes has crossed.
"""

from __future__ import annotations

from dataclasses import replace
from typing import TYPE_CHECKING

import pytest

from fatektool.client import Plc
from fatektool.exchange.link import Link
from fatektool.jobs.programs.backup import backup
from fatektool.jobs.programs.restore import RestoreOptions, carry_out, plan_restore
from fatektool.jobs.programs.verify import verify
from fatektool.jobs.snapshots.snapshot import take_all
from fatektool.program.image import Program
from fatektool.protocol.fatek.facon.codec import FACON
from fatektool.simulator.build import build_simulation
from fatektool.transport.base import LineSettings
from fatektool.transport.memory import MemoryTransport

if TYPE_CHECKING:
    from collections.abc import Callable

    from fatektool.program.archive import Backup
    from fatektool.transport.memory import Peer

WORDS = 2048
PAGES = 33
READ = 12 + 265  # 4F and its answer
WRITE = 268 + 9  # 50 and its answer
CHANGED = 12
LONGEST_OTHER = 120  # of 53 and its answer


class Counted(MemoryTransport):
    """A line that counts what crosses it."""

    def __init__(self, peer: Peer) -> None:
        super().__init__(peer)
        self.bytes = 0
        self.requests = 0

    def write(self, data: bytes) -> None:
        self.requests += 1
        self.bytes += len(data)
        super().write(data)

    def read(self, max_bytes: int, timeout_s: float) -> bytes:
        data = super().read(max_bytes, timeout_s)
        self.bytes += len(data)
        return data


def changed(found: Backup) -> Backup:
    """The same program with other words in some pages."""
    pages = list(found.program.pages)
    for number in range(1, CHANGED + 1):
        pages[number] = bytes(byte ^ 0x55 for byte in pages[number])
    return replace(found, program=Program(WORDS, tuple(pages)))


def put(plc: Plc, found: Backup, *, changed_only: bool) -> None:
    plan = plan_restore(plc, found, RestoreOptions(changed_only=changed_only))
    assert carry_out(plc, plan, None).verified


def snapshot_all(plc: Plc) -> None:
    assert not take_all(plc).errors


JOBS: dict[str, tuple[Callable[[Plc, Backup], object], int, int]] = {
    # what is done; the pages' bytes that it cannot do without; other requests: 53, 40, fences
    "backup": (lambda plc, _: backup(plc), 2 * PAGES * READ, 4),
    "backup, one pass": (lambda plc, _: backup(plc, single_pass=True), PAGES * READ, 2),
    "verify": (lambda plc, found: verify(plc, found.program), PAGES * READ, 2),
    "restore": (
        lambda plc, found: put(plc, changed(found), changed_only=False),
        3 * PAGES * READ + PAGES * WRITE,
        8,
    ),
    "restore, changed only": (
        lambda plc, found: put(plc, changed(found), changed_only=True),
        3 * PAGES * READ + CHANGED * WRITE,
        8,
    ),
}


@pytest.mark.parametrize("baud", [9600, 115200, 921600])
@pytest.mark.parametrize("name", [*JOBS, "snapshot --all"])
def test_the_line_is_never_idle(name: str, baud: int) -> None:
    simulation = build_simulation(ladder_words=WORDS, baud=baud)
    found = backup(Plc(Link(MemoryTransport(simulation.line()), FACON, 1, LineSettings()), "sim:"))
    transport = Counted(simulation.line())
    line = LineSettings(baud)
    plc = Plc(Link(transport, FACON, 1, line), "sim:")
    if name in JOBS:
        JOBS[name][0](plc, found)
    else:
        snapshot_all(plc)
    assert transport.clock() == pytest.approx(transport.bytes * line.byte_time_s, rel=1e-9)


@pytest.mark.parametrize("name", JOBS)
def test_a_job_sends_little_more_than_it_must(name: str) -> None:
    simulation = build_simulation(ladder_words=WORDS)
    found = backup(Plc(Link(MemoryTransport(simulation.line()), FACON, 1, LineSettings()), "sim:"))
    transport = Counted(simulation.line())
    job, least, others = JOBS[name]
    job(Plc(Link(transport, FACON, 1, LineSettings()), "sim:"), found)
    pages = least // READ  # a read and a write of a page are as long
    assert transport.requests == pages + others
    assert transport.bytes <= least + LONGEST_OTHER * others
