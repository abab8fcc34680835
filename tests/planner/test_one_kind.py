"""Hundreds of registers of one kind, in every protocol: the plan costs what the best one costs."""

from __future__ import annotations

from random import Random
from typing import TYPE_CHECKING

import pytest

from fatektool.planner import plan_reads, plan_writes
from fatektool.protocol.elements import Element
from fatektool.protocol.fatek.facon.codec import FACON
from fatektool.protocol.fatek.mseries.codec import MSERIES
from fatektool.protocol.modbus.rtu import RTU
from tests.night import seeds
from tests.planner.exhaustive import READ_CAPS, WRITE_CAPS, Caps, least_read, least_write, wire_bytes
from tests.planner.one_kind import least_of_registers
from tests.planner.sets import TURNAROUNDS

if TYPE_CHECKING:
    from fatektool.protocol.codec import Codec

MODBUS_READ, MODBUS_WRITE = Caps(2000, 125, 0, packs=True), Caps(1968, 123, 0, packs=True)
protocols = pytest.mark.parametrize(
    ("codec", "read", "write"),
    [
        pytest.param(FACON, READ_CAPS, WRITE_CAPS, id="facon"),
        pytest.param(MSERIES, READ_CAPS, WRITE_CAPS, id="mseries"),
        pytest.param(RTU, MODBUS_READ, MODBUS_WRITE, id="modbus-rtu"),
    ],
)


@pytest.mark.arithmetic
@protocols
@pytest.mark.parametrize("seed", seeds(4, 4))
def test_the_table_is_right_where_everything_can_be_tried(
    codec: Codec, read: Caps, write: Caps, seed: int
) -> None:
    random = Random(seed)  # noqa: S311  # the same sets each time
    for turnaround in TURNAROUNDS:
        addresses = set(random.sample(range(random.choice((12, 40, 200))), 10))
        elements = [Element("R", address) for address in addresses]
        found = least_of_registers("R", addresses, codec, turnaround, read)
        assert found == pytest.approx(least_read(elements, codec, turnaround, caps=read))
        found = least_of_registers("R", addresses, codec, turnaround, write, writes=True)
        assert found == pytest.approx(least_write(elements, codec, turnaround, caps=write))


@pytest.mark.arithmetic
@protocols
@pytest.mark.parametrize(("count", "within"), [(60, 90), (60, 3800), (120, 400), (150, 1500)])
def test_large_sets(codec: Codec, read: Caps, write: Caps, count: int, within: int) -> None:
    random = Random(count)  # noqa: S311
    for turnaround in TURNAROUNDS[1:3]:
        addresses = set(random.sample(range(within), count))
        elements = [Element("R", address) for address in addresses]
        plan = plan_reads(elements, codec, turnaround=turnaround)
        least = least_of_registers("R", addresses, codec, turnaround, read)
        assert wire_bytes(plan, codec, turnaround) == pytest.approx(least)
        writes = plan_writes([(element, 0) for element in elements], codec, turnaround=turnaround)
        least = least_of_registers("R", addresses, codec, turnaround, write, writes=True)
        assert wire_bytes(writes, codec, turnaround) == pytest.approx(least)
