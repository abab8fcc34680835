"""``sim:``: the wire time of a line, and no more reads than a client needs."""

from __future__ import annotations

import pytest

import fatektool
from tests.simulator.wire import frame

CHAR_S = 10 / 9600


def test_an_answer_is_one_piece_that_takes_its_wire_time() -> None:
    with fatektool.connect("sim:") as plc:
        line = plc.link.transport
        began = line.clock()
        line.write(frame("40"))
        assert line.read(4096, 1.0) == frame("400005400")
        assert line.clock() - began == pytest.approx((8 + 15) * CHAR_S)
