"""What an inventory says: values, defaults, paths; and all that is wrong, by line."""

from __future__ import annotations

from pathlib import Path

import pytest

from fatektool.address import PlcAddress
from fatektool.errors import DataError, UsageError
from fatektool.inventory.entries import Inventory, PlcEntry, parse_inventory
from fatektool.inventory.select import select
from tests.rows import each

FOLDER = Path("/etc/plant")
FILE = FOLDER / "fatek.toml"

WHOLE = """\
[defaults]
protocol = "mseries"
timeout_s = 2
tags = ["all"]

[plc.press]
target = "tcp://192.168.2.3"
protocol = "facon"
station = 7
tags = ["hall-1", "night"]
spec = "specs/press.toml"
reference = "/srv/press.json"
expect = "any"

[plc."oven 1".x]
"""


def parsed(text: str) -> Inventory:
    return parse_inventory(text.encode(), FILE)


def test_a_whole_entry() -> None:
    text = WHOLE.replace('[plc."oven 1".x]', '[plc.oven]\ntarget = "/dev/ttyUSB0"\nbaud = 19200\nretries = 0')
    found = parsed(text)
    assert found.faults == []
    assert list(found.plcs.values()) == [
        PlcEntry(
            "press",
            PlcAddress("tcp://192.168.2.3", 7, "facon", timeout_s=2.0),
            tags=("hall-1", "night"),
            spec=FOLDER / "specs/press.toml",
            reference=Path("/srv/press.json"),
            expect="any",
        ),
        PlcEntry(
            "oven",
            PlcAddress("/dev/ttyUSB0", protocol="mseries", baud=19200, timeout_s=2.0, retries=0),
            tags=("all",),
        ),
    ]


@pytest.mark.parametrize(
    ("target", "found"),
    [
        ("sim:", "sim:"),
        ("sim:press.state", "sim:/etc/plant/press.state"),
        ("sim:/srv/press.state", "sim:/srv/press.state"),
        ("./plc", "/etc/plant/plc"),
        ("/dev/ttyUSB0", "/dev/ttyUSB0"),
        ("COM3", "COM3"),
        ("rfc2217://gateway:4001", "rfc2217://gateway:4001"),
        ("udp://[fe80::1]:500", "udp://[fe80::1]:500"),
    ],
)
def test_paths_are_relative_to_the_file(target: str, found: str) -> None:
    assert parsed(f'[plc.p]\ntarget = "{target}"').plcs["p"].address.target == found


FAULTS = [
    ('[plc.p]\ntarget = "sim:"\nstatoin = 3', "line 3: plc.p: unknown key 'statoin': did you mean station?"),
    ('[plc.p]\ntarget = "sim:"\nx = 3', "line 3: plc.p: unknown key 'x': expected one of baud, "),
    ('[plc.p]\ntarget = "sim:"\nstation = 0', "line 3: plc.p: station: expected 1 to 254, got 0; 0 is a"),
    (
        '[plc.p]\ntarget = "tcp://h"\nprotocol = "modbus-tcp"\nstation = 256',
        "line 4: plc.p: station: expected a whole number from 1 to 254, .*, got 256",
    ),
    ('[plc.p]\ntarget = "sim:"\nstation = true', "line 3: .*got True"),
    ('[plc.p]\ntarget = "sim:"\ntimeout_s = nan', "line 3: plc.p: timeout_s: expected seconds above 0"),
    ('[plc.p]\ntarget = "sim:"\ntimeout_s = true', "line 3: .*got True"),
    ('[plc.p]\ntarget = "sim:"\nformat = "9X1"', "line 3: plc.p: format: expected data bits.*got '9X1'"),
    ('[plc.p]\ntarget = "sim:"\nprotocol = "s7"', "line 3: plc.p: protocol: expected one of facon, "),
    ('[plc.p]\ntarget = "sim:"\ntags = ["a", 3]', "line 3: plc.p: tags: expected a list of strings"),
    ('[plc.p]\ntarget = "sim:"\nread_only = 1', "line 3: plc.p: read_only: expected true or false, got 1"),
    ('[plc.p]\ntarget = "sim:"\ntags = 3', "line 3: plc.p: tags: expected a list of strings, got 3"),
    ('[plc.p]\ntarget = "sim:"\nspec = ""', "line 3: plc.p: spec: expected the name of a file, got ''"),
    ('[plc.p]\ntarget = "sim:"\nretries = ' + "9" * 5000, "not valid TOML: Exceeds the limit"),
    ('[plc.p]\ntarget = "sim:"\nretries = ' + "9" * 4000, "line 3: plc.p: retries: .*got 9999"),
    ("[plc.p]\nstation = 2", 'line 1: plc.p: target is missing: expected for example target = "tcp://HOST"'),
    ('[plc.p]\ntarget = "tcp://"', "line 2: plc.p: target 'tcp://': expected tcp://host:port"),
    ('[plc.p]\ntarget = "tcp://h"\nprotocol = "mseries"', "line 2: plc.p: target 'tcp://h': expected a port"),
    ('[plc.p]\ntarget = "rfc2217://h"', "line 2: plc.p: rfc2217://h: expected rfc2217://HOST:PORT"),
    (
        '[plc.p]\ntarget = "COM3"\nprotocol = "modbus-tcp"',
        "line 3: plc.p: protocol modbus-tcp is for networks: expected tcp://HOST, got 'COM3'",
    ),
    (
        '[plc.p]\ntarget = "COM3"\nprotocol = "mseries"\nformat = "7e1"',
        "line 4: plc.p: format: expected 8 data bits, as mseries on a serial line needs, got 7E1",
    ),
    ("[plc.p]\ntarget = 3", "line 2: plc.p: target: expected a string such as"),
    ('[plc.COM3]\ntarget = "sim:"', "line 1: name of a PLC: expected up to 64 letters.*got 'COM3'"),
    ('[plc."a/b"]\ntarget = "sim:"', "line 1: name of a PLC: .*got 'a/b'"),
    ('[plc.p]\ntarget = "sim:"\n[plc.P]\ntarget = "sim:"', "line 3: 'P' differs only in case from 'p'"),
    ('[defaults]\nreference = "x"\n[plc.p]\ntarget = "sim:"', "line 2: defaults: reference: expected a file"),
    ('[plcs.p]\ntarget = "sim:"', "line 1: expected .defaults. and .plc.NAME. tables, got 'plcs'"),
    ("plc = 3", "line 1: plc: expected .plc.NAME. tables"),
    ("plc.p = 3", r"line 1: expected a table \[plc.p\]"),
    ("defaults = 3", r"line 1: expected a table \[defaults\]"),
    ('plc = {p = {target = "sim:", station = 999}}', "line 1: plc.p: station: "),
    ("[plc.p\n", "line 1: not valid TOML: Expected"),
    ('[plc.p]\ntarget = "sim:"\ntarget = "sim:"\n', "line 3: not valid TOML: Cannot overwrite"),
]  # fmt: skip


@each(("text", "message"), FAULTS)
def test_a_fault_is_named_with_its_line(text: str, message: str) -> None:
    found = parsed(text)
    assert len(found.faults) >= 1
    with pytest.raises(DataError, match=message) as raised:
        found.require_whole()
    assert str(raised.value).startswith("/etc/plant/fatek.toml: ")
    assert "p" not in found.plcs or "'P'" in message or "'plcs'" in message or "defaults" in text


def test_all_faults_are_there_in_the_file_s_order() -> None:
    text = '[plc.p]\ntarget = "sim:"\nstation = 0\n\n[plc.q]\nbaud = 1\n\n[plc.r]\ntarget = "sim:"\n'
    found = parsed(text)
    assert [fault.line for fault in found.faults] == [3, 5, 6]
    assert list(found.plcs) == ["r"]
    with pytest.raises(DataError, match=r"line 3: .* \(and 2 more\); .* run: .*inventory check") as raised:
        found.require_whole()
    assert len(raised.value.details["faults"]) == 3


@pytest.mark.parametrize("data", [b"\xff\xfe", b"\0", b"a" * 100_000, b"[" * 20_000])
def test_what_is_no_toml_at_all(data: bytes) -> None:
    (fault,) = parse_inventory(data, FILE).faults
    assert fault.message.startswith("not valid TOML: ")


def test_a_file_from_windows() -> None:
    text = '\ufeff[plc.p]\r\ntarget = "sim:"\r\nstatoin = 3\r\n'
    (fault,) = parse_inventory(text.encode(), FILE).faults
    assert fault.line == 3


# --- which are meant ---------------------------------------------------------------------------------------

PLANT = parsed(
    '[plc.press-1]\ntarget = "sim:"\ntags = ["hall", "night"]\n'
    '[plc.press-2]\ntarget = "sim:"\ntags = ["hall"]\n'
    '[plc.hall]\ntarget = "sim:"\n'
)


@pytest.mark.parametrize(
    ("words", "names"),
    [
        ([], ["press-1", "press-2", "hall"]),
        (["press-2"], ["press-2"]),
        (["night"], ["press-1"]),
        (["hall"], ["press-1", "press-2", "hall"]),
        (["press-*"], ["press-1", "press-2"]),
        (["hall", "press-[2]", "press-?"], ["press-1", "press-2", "hall"]),
    ],
)
def test_select(words: list[str], names: list[str]) -> None:
    assert [entry.name for entry in select(PLANT, words)] == names


def test_select_nobody() -> None:
    with pytest.raises(UsageError, match=r"--select 'x'.*tags are hall, night"):
        select(PLANT, ["hall", "x"])
    with pytest.raises(UsageError, match="no PLC in the inventory"):
        select(parsed(""))
    with pytest.raises(UsageError, match=r"no PLC 'pres-1'.*did you mean press-1"):
        PLANT.named("pres-1")
