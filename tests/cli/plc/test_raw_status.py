"""Nothing that the PLC said is lost in ``status --json``, reserved bits and bytes among them."""

from __future__ import annotations

from typing import TYPE_CHECKING

from fatektool.protocol.status import BriefStatus
from tests.cli.running import served

if TYPE_CHECKING:
    from tests.cli.running import Cli


def test_reserved_bits_and_bytes(cli: Cli) -> None:
    reserved = bytes(range(1, 37))
    with served() as door:
        device = door.simulation.plcs[1]
        known = device.detailed_status()[:28]
        device.brief_status = lambda: bytes((0x81, 0x54, 0x99))  # type: ignore[method-assign]
        device.detailed_status = lambda: known + reserved  # type: ignore[method-assign]
        document = cli("status", "-p", door.target, "--json").document("status")
        brief = cli("status", "-p", door.target, "--json", "--brief").document("status")
    assert document["brief"] == {"status1": 0x81, "status2": 0x54, "status3": 0x99, "model": "FBE, 13K steps"}
    assert document["raw"]["brief"] == "815499"
    assert document["raw"]["detailed"] == (known + reserved).hex().upper()
    assert document["status"]["running"] is True
    assert brief["raw"] == {"brief": "815499", "detailed": None}


def test_a_brief_status_is_the_same_bytes_again() -> None:
    for status1 in range(256):
        data = bytes((status1, 0x53, 0xA5))
        assert BriefStatus.parse(data).to_bytes() == data
