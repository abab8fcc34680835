"""Nothing that the PLC said is lost in ``status --json``, reserved bits and bytes among them."""

from __future__ import annotations

from typing import TYPE_CHECKING

from fatektool.protocol.status import BriefStatus
from fatektool.simulator.refusal import Refusal, RefusalCode
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


def test_a_refused_53_of_the_m_series_is_a_warning(cli: Cli) -> None:
    def refuse() -> bytes:
        raise Refusal(RefusalCode.ILLEGAL_FORMAT)

    with served(protocol="mseries") as door:
        door.simulation.plcs[1].detailed_status = refuse  # type: ignore[method-assign]
        words = ["status", "-p", door.target, "--protocol", "mseries"]
        done, as_json = cli(*words), cli(*words, "--json")
    assert done.code == as_json.code == 0
    assert done.err.startswith("warning: the PLC refused to read detailed status (53): error 4")
    assert "mode             STOP" in done.out
    document = as_json.document("status")
    assert document["system"] is None
    assert document["status"]["running"] is False


def test_a_brief_status_is_the_same_bytes_again() -> None:
    for status1 in range(256):
        data = bytes((status1, 0x53, 0xA5))
        assert BriefStatus.parse(data).to_bytes() == data
