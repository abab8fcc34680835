"""``link ports`` and ``link result`` at the command line, over a simulated PLC with its memory in a file."""

from __future__ import annotations

from typing import TYPE_CHECKING

import pytest

from tests.plant import error_of
from tests.plcports.samples import put

if TYPE_CHECKING:
    from tests.cli.running import Cli
    from tests.plant import Plant


def test_ports(fbs: Plant) -> None:
    fbs.write(
        "M1960=on", "R4147=0x0332", "R4047=0x5502", "D4043=0x560A", "D4044=0x5602", "D4045:2=0x0A01,0x0244",
        "R4149=0x5500", "R4140:6=0x8220,0x1280,0x0E29,0,0,0", "R4054=0x5507", "R4059=0x0803", "R4148=0x0C00",
    )  # fmt: skip
    document = fbs.json("link-ports", "link", "ports")
    port = document["ports"][0]
    assert (port["free"], port["protocol"], port["continuous"]) == (True, "Modbus RTU", True)
    assert (port["tx_delay_s"], port["rx_timeout_s"], port["rx_timeout_unit_s"]) == (0.03, 5, 0.1)
    assert (port["last_result"]["code"], port["last_result"]["station"]) == ("A", 2)
    assert document["modem"]["phone_number"] == "0228082192"
    assert [port["last_result"] for port in document["ports"][1:]] == [None, None, None]
    assert document["high_speed_link"]["abnormal"] == "CRC error"
    assert document["registers"]["R4147"] == "0332"
    assert document["errors"] == {}
    done = fbs.cli("link", "ports")
    silence = "md0, mbus: no answer from the station within the time-out; "
    silence += "md1: no answer from the device within the time-out"
    assert (done.code, done.err) == (0, "")
    for line in (
        "  state            free",
        "  as a slave       Modbus RTU",
        "  RX time-out      5 s (in units of 0.1 s)",
        f"  last result      A, {silence} (transaction 1, station 2)",
        "  last result      only kept in continuous execution; otherwise see 'fatektool link result'",
        "  R4148             12 ms",
        "  master station    7",
        "  abnormal answers  3, CRC error (R4059)",
        "  phone number   0228082192",
    ):
        assert line in done.out.splitlines(), line


def test_ports_of_a_plc_that_lacks_some(fb: Plant) -> None:
    document = fb.json("link-ports", "link", "ports")
    assert set(document["errors"]) == {f"D{at}" for at in range(4043, 4053)}
    assert document["ports"][0]["rx_timeout_unit_s"] == 0.01
    assert (document["ports"][0]["minimum_scans"], document["ports"][0]["last_result"]) == (None, None)
    done = fb.cli("link", "ports")
    assert done.code == 0
    assert "  last result      -" in done.out.splitlines()
    assert "warning: D4043: the PLC refused" in fb.cli("link", "ports", "-v").err


def test_result(fbs: Plant) -> None:
    put(fbs, "D100", (0x0A03, 0x0246, 0, 0, 0x6011, 0, 0, 0))
    document = fbs.json("link-result", "link", "result", "D100")
    assert document["result"]["transaction"] == 3
    assert [document[name] for name in ("waiting", "repeated", "active", "error", "done")] == [
        True, True, False, True, True,
    ]  # fmt: skip
    done = fbs.cli("link", "result", "D100", "--kind", "md0")
    assert done.out.splitlines()[0] == "result       A, no answer from the station within the time-out"
    assert "do           check that the station is on" in done.out
    assert "command      46H, read registers" in done.out.splitlines()
    assert "outputs      ERR DN" in done.out.splitlines()
    assert fbs.cli("link", "result", "D100", "--check").code == 1
    unsure = fbs.cli("link", "result", "D200", "--check")
    assert (unsure.code, "result 0 without --kind is no proof" in unsure.err) == (0, True)
    assert fbs.cli("link", "result", "D200", "--check", "--kind", "md0").err == ""
    foreign = fbs.cli("link", "result", "D100", "--kind", "mbus").out
    assert "command      46H, not a command of this kind" in foreign.splitlines()
    unnamed = fbs.cli("link", "result", "D100").out
    assert "md2: the ladder program of this PLC did not prepare its reply" in unnamed
    assert "--kind selects one of these meanings" in unnamed


def test_zeros_are_not_told_as_success(fbs: Plant) -> None:
    """Registers that no instruction has written yet, or that are no WR at all."""
    result = fbs.json("link-result", "link", "result", "D100", "--kind", "md0")["result"]
    assert (result["code"], result["meaning"]) == ("0", "no transaction yet: these words are all 0")
    assert "operand WR" in result["next_step"]
    fbs.write("D4044=0x5602")
    assert "  last result      0, no transaction yet: these words are all 0" in (
        fbs.cli("link", "ports").out.splitlines()
    )


def test_result_of_a_message(fbs: Plant) -> None:
    put(fbs, "R100", (0, 9, 9, 9, 0x4000, 9, 9, 9, 4, 0x02, 0x4F, 0x4B, 0x03))
    document = fbs.json("link-result", "link", "result", "R100", "--kind", "md1")
    assert document["received"] == {"length": 4, "data": "02 4F 4B 03"}
    assert document["result"]["transaction"] is None
    lines = fbs.cli("link", "result", "R100", "--kind", "md2").out.splitlines()
    assert "text      .OK." in lines
    assert not any(line.startswith("transaction") for line in lines)


def test_result_of_the_high_speed_link(fbs: Plant) -> None:
    """Result 0 says that the format is correct; what goes wrong is in R4058 and R4059."""
    put(fbs, "R100", (0, 9, 9, 9, 0xFFFF, 9, 9, 9))
    ask = ("link", "result", "R100", "--kind", "md3")
    document = fbs.json("link-result", *ask, "--check")
    assert document["result"]["meaning"] == "the table's format is correct; the stations are not checked"
    assert [document[name] for name in ("waiting", "repeated", "active", "error", "done")] == [None] * 5
    assert document["result"]["station"] is None
    assert document["high_speed_link"] == {
        "abnormal_station": 0, "abnormal_code": 0, "abnormal": None, "abnormal_count": 0,
    }  # fmt: skip
    fbs.write("R4058=5", "R4059=0x0A11")
    done = fbs.cli(*ask, "--check")
    assert done.code == 1
    assert "successful" not in done.out
    for line in (
        "abnormal station  5 (R4058)",
        "abnormal answers  17, no answer from the slave (R4059)",
    ):
        assert line in done.out.splitlines()
    assert "clear both with 'fatektool write R4058=0 R4059=0', again until they stay 0" in done.out
    assert not [line for line in done.out.splitlines() if line.startswith(("outputs", "port", "run"))]
    assert fbs.cli(*ask).code == 0
    fbs.write("R4058=0", "R4059=1")
    assert fbs.cli(*ask, "--check").code == 1
    fbs.write("R4059=0", "R100=0x0400")
    assert fbs.cli(*ask, "--check").code == 1


def test_result_of_a_reply_that_was_late(fbs: Plant) -> None:
    put(fbs, "R100", (0x0A00, 9, 9, 9, 0x6000, 9, 9, 9, 0))
    done = fbs.cli("link", "result", "R100", "--kind", "md2", "--check")
    assert done.code == 1
    assert "the ladder program of this PLC did not prepare its reply within the time-out" in done.out
    assert "wiring" not in done.out
    assert "run" not in [line.split()[0] for line in done.out.splitlines()]


@pytest.mark.parametrize(
    ("wr", "kind", "said"),
    [
        ("R3833", "md0", "WR R3833: 8 words end at R3840, past R3839"),
        ("R3832", "md1", "WR R3832: 9 words end at R3840, past R3839"),
        ("R4100", "md0", "WR R4100: expected R0 to R3839, R5000 to R8071, D0 to D3999"),
        ("R8065", "mbus", "WR R8065: 8 words end at R8072, past R8071"),
        ("D3993", "md3", "WR D3993: 8 words end at D4000, past D3999"),
        ("D4045", "md0", "WR D4045: expected R0 to R3839"),
    ],
)
def test_result_where_no_result_can_be(fbs: Plant, wr: str, kind: str, said: str) -> None:
    error = error_of(fbs.cli("link", "result", wr, "--kind", kind), 2)
    assert said in error
    assert "operand WR" in error


def test_result_of_a_length_past_the_end(fbs: Plant) -> None:
    put(fbs, "R3800", (0, 0, 0, 0, 0x4000, 0, 0, 0, 40))
    error = error_of(fbs.cli("link", "result", "R3800", "--kind", "md1"), 5)
    assert "WR+8 says that 40 bytes were received; WR R3800: 49 words end at R3848, past R3839" in error


def test_result_at_the_last_place(fbs: Plant) -> None:
    put(fbs, "R3832", (0,) * 8)
    assert fbs.cli("link", "result", "R3832", "--check").code == 0


def test_result_of_no_register(fb: Plant) -> None:
    assert "WR M0: expected a register R or D" in error_of(fb.cli("link", "result", "M0"), 2)
    assert "the PLC refused D3072" in error_of(fb.cli("link", "result", "D3070"), 4)
    assert error_of(fb.cli("link", "result", "D0", "-s", "9", "--timeout", "0.01", "--retries", "0"), 3)


def test_the_group_lists_what_there_is(cli: Cli) -> None:
    done = cli("link", "--help")
    assert done.code == 0
    for name in ("ports", "table", "result"):
        assert f"\n  {name} " in done.out
    assert cli("link", "nothing").code == 2
