"""What a job asks beside what it was asked for: that this is refused is not told as a refusal of the job."""

from __future__ import annotations

from typing import TYPE_CHECKING

import pytest

from fatektool.client import Plc
from fatektool.errors import PlcError
from fatektool.exchange.link import Link
from fatektool.jobs.elements.reads import read_elements
from fatektool.jobs.elements.selection import parse_items
from fatektool.jobs.elements.writes import write_elements
from fatektool.jobs.snapshots.snapshot import take_snapshot
from fatektool.jobs.snapshots.spec import items_of
from fatektool.protocol.elements import Element
from fatektool.protocol.fatek.facon.codec import FACON
from fatektool.simulator.build import build_simulation
from fatektool.transport.base import LineSettings
from fatektool.transport.memory import MemoryTransport

if TYPE_CHECKING:
    from fatektool.simulator.plc import SimulatedPlc

R5, Y3 = Element("R", 5), Element("Y", 3)


class Refusing:
    """A PLC that answers some commands with error 4.

    Args:
        commands: which, as they stand in a frame.
        lost: the number of a request whose answer is lost, from 1.
    """

    def __init__(self, *commands: bytes, lost: int = 0) -> None:
        simulation = build_simulation([1], ladder_words=64)
        self.device: SimulatedPlc = simulation.plcs[1]
        self._line = simulation.line()
        self._commands = commands
        self._lost = lost
        self.asked: list[bytes] = []

    def receive(self, data: bytes, now: float) -> list[tuple[float, bytes]]:
        self.asked.append(data[3:5])
        if len(self.asked) == self._lost:
            return []
        if data[3:5] in self._commands:
            body = data[:5] + b"4"
            return [(now + 0.01, body + b"%02X" % (sum(body) % 256) + b"\x03")]
        return self._line.receive(data, now)


def client(peer: Refusing) -> Plc:
    return Plc(Link(MemoryTransport(peer), FACON, 1, LineSettings()), "sim:")


def test_a_write_whose_read_back_is_refused_is_written_and_not_proven() -> None:
    peer = Refusing(b"46", b"48")
    (left,) = write_elements(client(peer), [(R5, 7)])
    assert peer.device.read_words("R", 5, 1) == [7]
    told = left.words(str)
    assert told.startswith("written and acknowledged, but it cannot be read back: the PLC refused")
    assert left.acknowledged


def test_a_refused_write_is_told_as_refused() -> None:
    (left,) = write_elements(client(Refusing(b"47", b"49")), [(R5, 7)])
    assert left.words(str).startswith("not kept: expected 7, read back 0: the PLC refused to write")
    assert not left.acknowledged


@pytest.mark.parametrize("lost", range(4))
def test_a_plc_that_refuses_loopbacks_is_read_over_a_line_that_loses_answers(lost: int) -> None:
    peer = Refusing(b"4E", lost=lost)
    peer.device.write_words("R", 0, list(range(300)))
    wanted = [Element("R", at) for at in range(300)]
    plc = client(peer)
    reading = read_elements(plc, wanted)
    assert not reading.errors
    assert [reading.values[element] for element in wanted] == list(range(300))
    assert write_elements(plc, [(R5, 7)]) == []


def test_a_mode_that_cannot_be_read_back_is_acknowledged() -> None:
    with pytest.raises(PlcError, match="acknowledged RUN, but its mode cannot be read back: the PLC refused"):
        client(Refusing(b"40")).run()


def test_a_snapshot_without_a_mode_is_a_snapshot() -> None:
    snapshot = take_snapshot(client(Refusing(b"40")), items_of(parse_items(["R5"])))
    assert snapshot.running is None
    assert snapshot.values == {"R5": 0}
