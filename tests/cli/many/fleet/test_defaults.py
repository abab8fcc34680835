"""What ``[defaults]`` of an inventory gives: where backups and history are, references, a Modbus map."""

from __future__ import annotations

from pathlib import Path
from typing import TYPE_CHECKING

import pytest

import fatektool
from fatektool.inventory.load import load_inventory

if TYPE_CHECKING:
    from tests.cli.running import Cli

PLCS = '[plc.press]\ntarget = "sim:press.state"\nexpect = "any"\n[plc.oven]\ntarget = "sim:oven.state"\n'


@pytest.fixture(autouse=True)
def place(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> Path:
    monkeypatch.chdir(tmp_path)
    for name in ("FATEKTOOL_HISTORY", "FATEKTOOL_INVENTORY"):
        monkeypatch.delenv(name, raising=False)
    return tmp_path


def write(defaults: str, plcs: str = PLCS) -> None:
    Path("fatek.toml").write_text(f"[defaults]\n{defaults}\n{plcs}", encoding="utf-8")


def test_fleet_backup_alone_is_the_nightly_command(cli: Cli) -> None:
    write('backups = "kept"\nhistory = "past"\nreference = "kept/{name}.json"\nlow_latency = false')
    done = cli("fleet", "backup")
    assert done.code == 0, done.err
    assert sorted(path.name for path in Path("kept").iterdir()) == ["oven.json", "press.json"]
    assert "press" in cli("history", "log").out  # of the history that the inventory names
    verified = cli("fleet", "verify")
    assert (verified.code, verified.out.count("same as kept/")) == (0, 2)
    assert cli("verify", "kept/press.json", "-p", "press").code == 0
    assert "program as in kept" in cli("check", "-p", "press").out.replace("press.json", "")
    checked = cli("fleet", "check", "--max-age", "1h", "--select", "press")
    assert (checked.code, "1 of 1 PLCs OK" in checked.out) == (0, True)
    assert not load_inventory(Path("fatek.toml")).plcs["oven"].address.low_latency


def test_an_option_goes_before_the_inventory(cli: Cli) -> None:
    write('backups = "kept"')
    assert cli("fleet", "backup", "--dir", "other").code == 0
    assert not Path("kept").exists()
    assert len(list(Path("other").iterdir())) == 2


def test_the_list_has_them(cli: Cli) -> None:
    write('backups = "kept"\nreference = "kept/{name}.json"')
    document = cli("inventory", "list", "--json").document("inventory")
    assert (document["backups"], document["history"]) == ("kept", None)
    assert [plc["reference"] for plc in document["plcs"]] == ["kept/press.json", "kept/oven.json"]


@pytest.mark.parametrize(
    ("text", "fault"),
    [
        ('[plc.p]\ntarget = "sim:"\nbackups = "x"', "unknown key 'backups'"),
        ("[defaults]\nhistory = 5", "defaults: history: expected the name of a file"),
        ('[defaults]\nreference = "all.json"', "expected a file for each PLC"),
        ('[defaults]\nmodbus_map = "R0-R9=1"', "defaults: modbus_map: "),
    ],
)
def test_a_wrong_one_is_a_fault_with_its_line(cli: Cli, text: str, fault: str) -> None:
    Path("fatek.toml").write_text(text, encoding="utf-8")
    done = cli("inventory", "check")
    assert (done.code, fault in done.out) == (1, True), done


def test_a_modbus_map_is_for_modbus_alone(cli: Cli) -> None:
    with fatektool.simulate(protocol="modbus-tcp") as simulated:
        plcs = f'[plc.bus]\ntarget = "{simulated.target}"\nprotocol = "modbus-tcp"\n{PLCS}'
        write('modbus_map = "R3000-R3099=400101"', plcs)
        found = load_inventory(Path("fatek.toml")).plcs
        assert (found["bus"].modbus_map, found["press"].modbus_map) == ("R3000-R3099=400101", None)
        refused = cli("read", "R0", "-p", "bus", "--timeout", "20")  # which is not in the map
        assert (refused.code, "map" in refused.err) == (2, True)
        assert cli("read", "R0", "-p", "bus", "--timeout", "20", "--modbus-map", "standard").code == 0
        with fatektool.connect("bus", timeout_s=20) as plc, pytest.raises(fatektool.UsageError, match="map"):
            plc.read("R0")
    assert cli("read", "R0", "-p", "press").code == 0
