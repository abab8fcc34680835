"""``snapshot --all``: its plan is made while the first answers come, with the same requests."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

import pytest

from fatektool.client import Plc
from fatektool.exchange.link import Link
from fatektool.jobs.elements.extent import limits
from fatektool.jobs.elements.reads import turnaround
from fatektool.jobs.snapshots.snapshot import take_all
from fatektool.jobs.snapshots.spec import everything
from fatektool.planner import plan_reads
from fatektool.planner.paths import Search
from fatektool.protocol.registry import CODECS
from fatektool.simulator.build import build_simulation
from fatektool.transport.base import LineSettings
from fatektool.transport.memory import MemoryTransport

if TYPE_CHECKING:
    from collections.abc import Iterator

    from fatektool.transport.memory import Peer


class Recorded:
    """A peer, and what it is sent, in order with what is noted meanwhile."""

    def __init__(self, peer: Peer) -> None:
        self._peer = peer
        self.events: list[bytes | str] = []

    def receive(self, data: bytes, now: float) -> list[tuple[float, bytes]]:
        self.events.append(data)
        return self._peer.receive(data, now)


@pytest.fixture
def recorded(monkeypatch: pytest.MonkeyPatch) -> Recorded:
    peer = Recorded(build_simulation(ladder_words=64).line())
    steps = Search.steps

    def noted(self: Search) -> Iterator[None]:
        yield from steps(self)
        peer.events.append("planned")

    monkeypatch.setattr(Search, "steps", noted)
    return peer


def test_the_requests_are_those_of_the_plan_and_the_first_goes_out_before_it_is_complete(
    recorded: Recorded,
) -> None:
    codec: Any = CODECS["facon"]
    plc = Plc(Link(MemoryTransport(recorded), codec, 1, LineSettings()), "sim:")
    system = plc.detailed_status().system
    plc.brief_status()
    recorded.events.clear()
    snapshot = take_all(plc)
    assert len(snapshot.values) > 10_000
    assert not snapshot.errors
    planned_at = recorded.events.index("planned")
    sent = [
        event for event in recorded.events if isinstance(event, bytes) and event[3:5] not in {b"53", b"40"}
    ]
    plan = plan_reads(everything(system), codec, turnaround=turnaround(plc), limits=limits(system))
    *reads, fence = sent
    assert reads == [codec.encode(1, request) for request in plan]
    assert fence[3:5] == b"4E"
    before = [event for event in recorded.events[:planned_at] if event in reads]
    assert 1 < len(before) < len(reads)
    assert before == reads[: len(before)]
