"""A name of the inventory instead of a port, on every command; what goes before what."""

from __future__ import annotations

import re
from pathlib import Path
from typing import TYPE_CHECKING

import pytest

from fatektool.inventory.find import may_be_name
from fatektool.simulator.build import build_simulation

if TYPE_CHECKING:
    from tests.cli.running import Cli

PLANT = """\
[defaults]
station = 3
timeout_s = 0.1
retries = 0
[plc.press]
target = "sim:press.state"
[plc.oven]
target = "sim:oven.state"
station = 5
protocol = "mseries"
"""


@pytest.fixture(autouse=True)
def plant(place: Path) -> None:
    (place / "fatek.toml").write_text(PLANT)
    build_simulation([3, 4], state=place / "press.state", ladder_words=400)
    build_simulation([5], protocol="mseries", state=place / "oven.state")


@pytest.mark.parametrize(
    ("words", "station", "protocol"),
    [
        ("-p press", 3, "facon"),
        ("-p press -s 4", 4, "facon"),
        ("-p oven", 5, "mseries"),
        ("--port press --inventory ./fatek.toml", 3, "facon"),
    ],
)
def test_a_name_stands_for_all_that_is_said_of_it(cli: Cli, words: str, station: int, protocol: str) -> None:
    document = cli("status", *words.split(), "--json", "--brief").document("status")
    assert (document["station"], document["protocol"]) == (station, protocol)
    assert document["target"].startswith("sim:")


@pytest.mark.parametrize(
    "words",
    [
        "backup x.json",
        "read R0",
        "snapshot R0",
        "snapshot R0 -o x.json",
        "doctor",
        "loopback --count 2",
        "scan",
    ],
)
def test_every_command_knows_names(cli: Cli, words: str) -> None:
    assert cli(*words.split(), "-p", "press").code == 0


def test_an_option_goes_before_the_inventory_even_if_it_is_the_default(cli: Cli) -> None:
    done = cli("status", "-p", "press", "-s", "1", "--retries", "3", "--timeout", "0.5")
    assert done.code == 3
    assert "no answer from station 1" in done.err
    assert "in 1 try and 4 other requests, 2." in done.err
    done = cli("status", "-p", "press", "-s", "1")
    assert re.search(r"in 1 (try|request), 0\.\d s in total", done.err)


def test_another_protocol_takes_its_own_format(cli: Cli) -> None:
    """7E1 of FACON would refuse mseries on a serial line."""
    Path("fatek.toml").write_text('[plc.press]\ntarget = "/dev/nope"\nformat = "7E1"\n')
    done = cli("status", "-p", "press", "--protocol", "mseries")
    assert (done.code, "no such port" in done.err) == (3, True)
    done = cli("status", "-p", "press", "--protocol", "mseries", "--format", "7E1")
    assert (done.code, "expected 8 data bits" in done.err) == (2, True)


def test_read_only_holds_for_the_plc_s_name(cli: Cli) -> None:
    Path("fatek.toml").write_text('[plc.press]\ntarget = "sim:press.state"\nstation = 3\nread_only = true\n')
    assert cli("read", "R0", "-p", "press").code == 0
    done = cli("write", "R0=1", "-p", "press")
    assert done.code != 0
    assert "read-only" in done.err or "may only be read" in done.err


def test_snapshot_s_own_format_is_not_the_line_s(cli: Cli) -> None:
    done = cli("snapshot", "R0", "-p", "oven", "--format", "csv")
    assert done.code == 0, done.err


def test_a_name_from_the_environment(cli: Cli, monkeypatch: pytest.MonkeyPatch, tmp_path: Path) -> None:
    monkeypatch.setenv("FATEKTOOL_PORT", "press")
    assert cli("status", "--brief").code == 0
    Path("fatek.toml").rename(tmp_path / "plant.toml")
    assert cli("status", "--brief").code == 3
    monkeypatch.setenv("FATEKTOOL_INVENTORY", str(tmp_path / "plant.toml"))
    done = cli("status", "--brief")
    assert f"sim:{tmp_path}/press.state" in done.out  # relative to the inventory, not to us


def test_the_user_s_own_inventory_comes_last(cli: Cli, place: Path) -> None:
    own = place.parent / "config" / "fatektool" / "fatek.toml"
    own.parent.mkdir(parents=True)
    own.write_text('[plc.own]\ntarget = "sim:"\n')
    assert cli("status", "-p", "own").code == 2  # there is one here
    (place / "fatek.toml").unlink()
    assert cli("status", "-p", "own").code == 0


@pytest.mark.parametrize(
    ("words", "message"),
    [
        ("-p pres", "no PLC 'pres' in the inventory fatek.toml; did you mean press?"),
        ("-p press --inventory no.toml", "cannot read no.toml: No such file"),
    ],
)
def test_a_name_that_is_none(cli: Cli, words: str, message: str) -> None:
    done = cli("status", *words.split())
    assert done.code == 2
    assert message in done.err


def test_an_inventory_with_a_fault(cli: Cli) -> None:
    Path("fatek.toml").write_text(PLANT + "statoin = 1\n")
    done = cli("status", "-p", "press", "--json")
    assert done.code == 5
    assert done.document("error")["error"]["details"]["faults"] == [
        "line 11: plc.oven: unknown key 'statoin': did you mean station?"
    ]
    assert cli("status", "-p", "sim:", "-s", "1").code == 0  # not looked at


def test_a_file_of_this_folder_is_a_port_unless_it_is_a_name(cli: Cli) -> None:
    Path("press").touch()
    Path("other").touch()
    assert cli("status", "-p", "press", "--brief").code == 0
    assert cli("status", "-p", "other", "--brief").code == 3


@pytest.mark.parametrize(
    ("word", "may"),
    [
        ("press", True),
        ("press-1.x", True),
        ("ttyUSB0", True),
        ("Öfen", True),
        ("COM3", False),
        ("com12", False),
        ("COM", True),
        ("/dev/ttyUSB0", False),
        ("./plc", False),
        (r"\\.\COM10", False),
        ("tcp://h", False),
        ("sim:", False),
        ("", False),
        (" ", False),
    ],
)
def test_which_words_may_be_names(word: str, *, may: bool) -> None:
    assert may_be_name(word) is may


# --- completion --------------------------------------------------------------------------------------------


@pytest.mark.parametrize(
    ("typed", "found"),
    [
        ("fatektool status -p ", ["plain,press", "plain,oven"]),
        ("fatektool status -p pr", ["plain,press"]),
        ("fatektool status -p /dev", ["file,/dev"]),
        ("fatektool fleet status --select o", ["plain,oven"]),
        ("fatektool status --inventory no.toml -p pr", ["file,pr"]),
    ],
)
def test_completion_knows_names(
    cli: Cli, monkeypatch: pytest.MonkeyPatch, typed: str, found: list[str]
) -> None:
    monkeypatch.setenv("_FATEKTOOL_COMPLETE", "bash_complete")
    monkeypatch.setenv("COMP_WORDS", typed)
    monkeypatch.setenv("COMP_CWORD", str(len(typed.split(" ")) - 1))
    assert cli().out.split() == found


def test_completion_says_nothing_of_a_broken_inventory(cli: Cli, monkeypatch: pytest.MonkeyPatch) -> None:
    Path("fatek.toml").write_text("[")
    monkeypatch.setenv("_FATEKTOOL_COMPLETE", "bash_complete")
    monkeypatch.setenv("COMP_WORDS", "fatektool status -p pr")
    monkeypatch.setenv("COMP_CWORD", "3")
    done = cli()
    assert (done.out.split(), done.err) == (["file,pr"], "")
