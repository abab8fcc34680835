"""What needs which OS version, and what is said of it: by 53, which has one digit a nibble."""

from __future__ import annotations

from typing import TYPE_CHECKING

import pytest

from fatektool.jobs.plcports.host import LinkHost, read_host
from fatektool.plcports.operands import TableOperand
from fatektool.plcports.rows import Transaction
from fatektool.plcports.tables import MbusTable
from fatektool.plcports.versions import INPUT_TYPES, MODBUS_ASCII, is_fbs, needs_of_ports, needs_of_table
from tests.rigs import simulated

if TYPE_CHECKING:
    from tests.plant import Plant


@pytest.mark.parametrize(
    ("os_version", "met", "fbs"),
    [
        ("4.0", False, True),
        ("4.1", False, True),
        ("4.2", None, True),
        ("4.3", True, True),
        ("5.0", True, True),
        ("3.1", False, False),
        ("3.9", False, False),
        (None, None, None),
        ("", None, None),
        ("A.0", True, True),
    ],
)
def test_what_is_known_of_an_os_version(os_version: str | None, met: bool | None, fbs: bool | None) -> None:
    for need in (MODBUS_ASCII, INPUT_TYPES):
        assert need.met(os_version) is met
    assert is_fbs(os_version) is fbs


def test_the_versions_of_the_paper() -> None:
    assert (MODBUS_ASCII.version, INPUT_TYPES.version) == ("4.24", "4.22")


def test_what_needs_them() -> None:
    assert needs_of_ports(0x5602) == (MODBUS_ASCII,)
    for r4047 in (None, 0, 0x5502, 0x0056):
        assert needs_of_ports(r4047) == ()
    for slave, needs in ((0, ()), (4, ()), (1, (INPUT_TYPES,)), (3, (INPUT_TYPES,))):
        row = Transaction(1, 1, 1, TableOperand(12 if slave > 1 else 2, 0), TableOperand(slave, 1))
        assert needs_of_table(MbusTable((row,))) == needs


def test_what_is_said() -> None:
    needs = (MODBUS_ASCII,)
    assert list(LinkHost("4.3", needs).warnings()) == []
    assert list(LinkHost("4.0").warnings()) == []
    assert list(LinkHost(None).warnings()) == []
    (said,) = LinkHost("4.0", needs).warnings()
    assert said.endswith("Modbus ASCII) needs OS 4.24 or later, and this PLC has OS 4.0")
    (said,) = LinkHost("4.2", needs).warnings()
    assert "so it can have 4.20 to 4.29" in said
    (said,) = LinkHost(None, needs).warnings()
    assert said.endswith("this PLC's OS is not known")
    (said,) = LinkHost("3.1", needs).warnings()
    assert said.startswith("this PLC has OS 3.1, so it is no FBs: these registers are documented for the FBs")


def test_a_plc_that_does_not_say() -> None:
    for options in ({"protocol": "modbus-tcp"}, {"protocol": "mseries"}, {"faults": ["drop=1"]}):
        assert read_host(simulated(**options).plc) == LinkHost(None)


def test_ports_of_an_fbs_that_is_too_old(fbs: Plant) -> None:
    fbs.write("R4047=0x5602")
    document = fbs.json("link-ports", "link", "ports")
    (need,) = document["os"]["needs"]
    assert (document["os"]["version"], document["os"]["fbs"], need["met"]) == ("4.0", True, False)
    assert {port["protocol"] for port in document["ports"]} == {"FATEK"}  # as any other value
    assert "needs OS 4.24 or later, and this PLC has OS 4.0" in fbs.cli("link", "ports").err
    fbs.write("R4047=0x5502")
    assert fbs.json("link-ports", "link", "ports")["os"]["needs"] == []


TABLE = """kind = "mbus"

[[transaction]]
station = 2
command = "read"
length = 4
master = "R0"
slave = "300001"
"""


def test_a_table_that_needs_a_later_os(fbs: Plant) -> None:
    (fbs.state.parent / "in.toml").write_text(TABLE, encoding="utf-8")
    done = fbs.cli("link", "table", "check", "in.toml")
    assert done.code == 0
    assert "needs PLC OS 4.22 or later" in done.err
    said = "needs OS 4.22 or later, and this PLC has OS 4.0"
    done = fbs.cli("link", "table", "write", "in.toml", "R100", "--yes")
    assert done.code == 0
    assert said in done.err
    show = ("link", "table", "show", "R100", "--kind", "mbus")
    assert said in fbs.cli(*show).err
    assert fbs.json("link-table", *show)["os"]["needs"][0]["met"] is False
    assert said in fbs.cli("link", "table", "save", "R100", "out.toml", "--kind", "mbus").err


@pytest.mark.parametrize(
    "words",
    [
        "ports",
        "result R100",
        "table show R100 --kind md0",
        "table save R100 x.toml --kind md0",
        "modem show",
        "modem set --tone --dry-run",
    ],
)
def test_an_fbe_has_other_registers(fb: Plant, words: str) -> None:
    done = fb.cli("link", *words.split())
    assert done.code == 0
    assert "this PLC has OS 3.1, so it is no FBs" in done.err
    if "save" not in words:
        document = fb.json(
            {"ports": "link-ports", "result": "link-result", "table": "link-table", "modem": "link-modem"}[
                words.split(maxsplit=1)[0]
            ],
            "link",
            *words.split(),
        )
        assert (document["os"]["version"], document["os"]["fbs"]) == ("3.1", False)


def test_a_high_speed_table_says_what_cannot_be_detected(fbs: Plant) -> None:
    row = '\n[[transaction]]\nstation = {}\ncommand = "high-speed"\nlength = 4\ndata = "R{}"\n'
    (fbs.state.parent / "a.toml").write_text('kind = "md3"\n' + row.format(1, 0) + row.format(3, 10))
    done = fbs.cli("link", "table", "check", "a.toml")
    assert done.code == 0
    assert "write 0 to R4058 until it stays 0" in done.out
    assert "senders here: 1, 3" in done.out
    assert "no absent slave" not in done.out
    (fbs.state.parent / "b.toml").write_text('kind = "md3"\n' + row.format(1, 0))
    assert "only station 1 sends: if it is the master, no absent slave is detected at all" in (
        fbs.cli("link", "table", "check", "b.toml").out
    )
    document = fbs.cli("link", "table", "check", "b.toml", "--json").document("link-table")
    assert len(document["notes"]) == 3
