"""``inventory check``, ``list`` and ``add``."""

from __future__ import annotations

import json
import os
from pathlib import Path
from typing import TYPE_CHECKING, Any

import pytest

from fatektool.inventory.values import KEYS
from tests.cli.running import process, served

if TYPE_CHECKING:
    from tests.cli.running import Cli

PRESS = '[plc.press]\ntarget = "tcp://h"\nstation = 7\ntags = ["a", "b"]\n'


def text() -> str:
    return Path("fatek.toml").read_bytes().decode()


# --- check and list ----------------------------------------------------------------------------------------


def test_check(cli: Cli) -> None:
    Path("fatek.toml").write_text(PRESS)
    assert cli("inventory", "check") == (0, "fatek.toml: 1 PLC, no faults\n", "")
    Path("fatek.toml").write_text(PRESS + "x = 1\n[plc.q]\n")
    done = cli("inventory", "check")
    assert done.code == 1
    keys = ", ".join(sorted(KEYS))
    assert done.out.splitlines() == [
        f"fatek.toml: line 5: plc.press: unknown key 'x': expected one of {keys}",
        'fatek.toml: line 6: plc.q: target is missing: expected for example target = "tcp://HOST"',
    ]
    document = cli("inventory", "check", "--json").document("inventory-check")
    assert [fault["line"] for fault in document["faults"]] == [5, 6]


def test_check_looks_at_the_files_that_are_named(cli: Cli) -> None:
    Path("fatek.toml").write_text(PRESS + 'spec = "s.toml"\nreference = "r.json"\n')
    Path("s.toml").write_text('[[item]]\nelement = "Q1"\n')
    Path("r.json").write_text("{}")
    done = cli("inventory", "check")
    assert done.code == 1
    spec, reference = done.out.splitlines()
    assert spec.startswith("fatek.toml: plc.press: spec: s.toml: item 1: ")
    assert reference.startswith("fatek.toml: plc.press: reference: r.json: not a backup file")


def test_no_inventory(cli: Cli) -> None:
    for words in ("inventory check", "inventory list", "fleet status"):
        done = cli(*words.split())
        assert done.code == 2
        assert "no inventory found; give --inventory FILE, set FATEKTOOL_INVENTORY" in done.err


def test_list(cli: Cli) -> None:
    Path("fatek.toml").write_text(PRESS + '[plc.oven]\ntarget = "sim:"\n')
    assert cli("inventory", "list").out.splitlines() == [
        "name   target   station  protocol  tags",
        "press  tcp://h  7        facon     a, b",
        "oven   sim:     1        facon",
    ]
    (plc,) = cli("inventory", "list", "--select", "b", "--json").document("inventory")["plcs"]
    assert (plc["name"], plc["station"], plc["tags"], plc["format"]) == ("press", 7, ["a", "b"], "7E1")


# --- add ---------------------------------------------------------------------------------------------------


def test_add_begins_an_inventory(cli: Cli) -> None:
    done = cli("inventory", "add", "press", "-p", "tcp://h", "-s", "7", "--tag", "a", "--tag", "b")
    assert done == (0, "added press to fatek.toml\n", "")
    assert text() == PRESS


@pytest.mark.parametrize(
    ("before", "gap"),
    [
        ("# ours\n" + PRESS, "\n"),
        (PRESS.rstrip("\n"), "\n\n"),
        (PRESS.replace("\n", "\r\n"), "\r\n"),
        ("[defaults]\nbaud = 38400  # fast\n\n\n", "\n"),
    ],
)
def test_add_keeps_all_that_is_there(cli: Cli, before: str, gap: str) -> None:
    path = Path("fatek.toml")
    path.write_bytes(before.encode())
    path.chmod(0o664)
    document = cli("inventory", "add", "oven.1", "-p", "/dev/ttyUSB0", "--baud", "9600", "--json").document(
        "inventory-add"
    )
    assert document["added"] == ["oven.1"]
    end = "\r\n" if "\r\n" in before else "\n"
    new = end.join(['[plc."oven.1"]', 'target = "/dev/ttyUSB0"', "baud = 9600", ""])
    assert text() == before + gap + new
    if os.name == "posix":
        assert path.stat().st_mode & 0o777 == 0o664 & ~umask()
    assert cli("inventory", "check").code == 0


def umask() -> int:
    now = os.umask(0)
    os.umask(now)
    return now


@pytest.mark.parametrize(
    ("words", "code", "message"),
    [
        ("press -p sim:", 2, "'press' is already in the inventory fatek.toml; choose another name"),
        ("PRESS -p sim:", 2, "'PRESS' cannot be added: 'PRESS' differs only in case from 'press'"),
        ("COM3 -p sim:", 2, "cannot be added: name of a PLC: expected"),
        ("x -p tcp://", 2, "'x' cannot be added: plc.x: target 'tcp://': expected"),
        ("x -p sim: --baud 9", 2, "'--baud': expected a whole number from 50 to 4000000, got 9"),
        ("x", 2, "no PLC is given; give --port TARGET, or --from FILE"),
        ("x --from s.json -p sim:", 2, "--from does not go with --port"),
        ("x --from no.json", 2, "cannot read no.json"),
        ("x --from fatek.toml", 5, "fatek.toml: not what 'fatektool scan --json' prints"),
        ("x --from other.json", 5, "other.json: expected schema 'fatektool.scan/1', got 'x'"),
        ("x --from nobody.json", 2, "nobody.json: the scan found no PLC"),
    ],
)
def test_add_refuses(cli: Cli, words: str, code: int, message: str) -> None:
    Path("fatek.toml").write_text(PRESS)
    Path("other.json").write_text('{"schema": "x", "target": "sim:", "found": []}')
    Path("nobody.json").write_text('{"schema": "fatektool.scan/1", "target": "sim:", "found": []}')
    done = cli("inventory", "add", *words.split())
    assert done.code == code
    assert message in done.err
    assert text() == PRESS


def test_add_to_an_inventory_with_a_fault(cli: Cli) -> None:
    Path("fatek.toml").write_text("x = 1\n")
    assert cli("inventory", "add", "press", "-p", "sim:").code == 5
    assert text() == "x = 1\n"


def scanned(*stations: int, **more: Any) -> str:
    each = {"protocol": "facon", "baud": 19200, "format": "8N1"} | more
    found = [{"station": station, **each} for station in stations]
    return json.dumps({"schema": "fatektool.scan/1", "target": "/dev/ttyUSB0", "found": found})


def test_add_one_from_a_scan(cli: Cli) -> None:
    Path("s.json").write_text(scanned(3))
    assert cli("inventory", "add", "press", "--from", "s.json").code == 0
    assert text() == (
        '[plc.press]\ntarget = "/dev/ttyUSB0"\nstation = 3\n'
        'protocol = "facon"\nbaud = 19200\nformat = "8N1"\n'
    )


def test_add_many_from_a_scan_all_or_none(cli: Cli) -> None:
    Path("s.json").write_text(scanned(9, 3, 3))
    assert cli("inventory", "add", "hall", "--from", "s.json", "--tag", "x").out.splitlines() == [
        "added hall-3 to fatek.toml",
        "added hall-9 to fatek.toml",
    ]
    before = text()
    done = cli("inventory", "add", "hall", "--from", "s.json")
    assert (done.code, done.out) == (0, "")
    assert done.err.splitlines() == [
        "skipped station 3 on /dev/ttyUSB0: it is in the inventory already",
        "skipped station 9 on /dev/ttyUSB0: it is in the inventory already",
    ]
    Path("s.json").write_text(scanned(3, 8).replace("ttyUSB0", "ttyUSB1"))
    assert cli("inventory", "add", "hall", "--from", "s.json").code == 2  # hall-3 is taken
    assert text() == before


def test_add_what_a_real_scan_finds(cli: Cli) -> None:
    with served(stations=[2, 5]) as door:
        scan = cli("scan", "-p", door.target, "--stations", "2-5", "--timeout", "2", "--json")
        Path("s.json").write_text(scan.out)
        assert process("inventory", "add", "hall", "--from", "-", redirect="< s.json").code == 0
        assert cli("status", "-p", "hall-5", "--brief").code == 0
        assert "baud" not in text()  # a gateway has none of its own
