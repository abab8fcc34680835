"""``status`` of a PLC that refuses 53, byte for byte."""

from __future__ import annotations

import pytest

from fatektool.errors import PlcRefused
from fatektool.jobs.status import read_status
from tests.exchange.peer import Rules, frame
from tests.rigs import client_on

M_STATUS = bytes.fromhex("511000020140A18455AA")
M_RUNNING = bytes.fromhex("5210000601400001000077D555AA")
M_DETAILED = bytes.fromhex("511000020153E04955AA")
M_REFUSED = bytes.fromhex("5210000301530448B755AA")


def test_an_m_series_plc_may_refuse_53_whose_layout_no_paper_has() -> None:
    peer = Rules({M_STATUS: M_RUNNING, M_DETAILED: M_REFUSED})
    report = read_status(client_on(peer, "mseries"))
    assert report.flags.running
    assert (report.detailed, report.system) == (None, None)
    assert report.refused.startswith("the PLC refused to read detailed status (53): error 4")
    assert peer.heard == [M_STATUS, M_DETAILED]


def test_a_facon_plc_may_not() -> None:
    with pytest.raises(PlcRefused, match="the PLC refused to read detailed status"):
        read_status(client_on(Rules({frame("53"): frame("534")})))
