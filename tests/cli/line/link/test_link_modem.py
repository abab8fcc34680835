"""``link modem``: the words of the paper's examples, and nothing written that was not asked for."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

import pytest

from fatektool.errors import UsageError
from fatektool.jobs.plcports.modem import ModemSettings
from fatektool.simulator.build import build_simulation
from tests.cli.running import one_line
from tests.transport.modem.scripted import ScriptedModem
from tests.transport.modem.test_port import plugged_in

if TYPE_CHECKING:
    from pathlib import Path

    from tests.cli.running import Cli

PLC = "sim:plc.state"
BEFORE = {
    "R4140": 0x8220, "R4141": 0x1280, "R4142": 0x0E29, "R4143": 0, "R4144": 0, "R4145": 0,
    "R4149": 0x5512, "R4163": 0x0314, "M1959": 1,
}  # fmt: skip


def held(cli: Cli) -> dict[str, int]:
    """What the registers hold, read by another command."""
    values = cli("read", *BEFORE, "-p", PLC, "--json").document("read")["values"]
    return {name: int(value) & 0xFFFF for name, value in values.items()}  # they are signed


@pytest.fixture
def plc(place: Path, cli: Cli) -> Path:
    """A PLC with the number of the paper's example, whose low byte of R4149 is somebody's too."""
    done = cli("write", *[f"{name}={value}" for name, value in BEFORE.items()], "-p", PLC)
    assert done.code == 0, done
    assert held(cli) == BEFORE
    return place


@pytest.mark.usefixtures("plc")
def test_show(cli: Cli) -> None:
    found = cli("link", "modem", "show", "-p", PLC, "--json").document("link-modem")
    assert found["modem"] == {
        "on": True, "phone_number": "0228082192", "pulse_dialling": True, "dial": False, "connected": False,
        "failed": False, "dial_control": 4, "profile": 1, "rings": 3,
    }  # fmt: skip
    assert found["registers"]["R4163"] == "0314"
    assert (found["set"], found["errors"]) == (None, {})
    words = cli("link", "modem", "show", "-p", PLC)
    for line in (
        "modem          on",
        "phone number   0228082192",
        "dials by       pulses",
        "AT&Y",
        "3 rings",
    ):
        assert line in words.out


@pytest.mark.parametrize(
    ("words", "changes"),
    [
        (
            ["--number", "02,28082192,,,,,,100"],  # the paper's "02-28082192 ext 100"
            {
                "R4140": 0x2A20,
                "R4141": 0x2808,
                "R4142": 0xA291,
                "R4143": 0xAAAA,
                "R4144": 0x001A,
                "R4145": 0x000E,
            },
        ),
        (["--number", "*70#1"], {"R4140": 0xB07C, "R4141": 0x00E1, "R4142": 0}),
        (["--modem-off"], {"R4149": 0x0012}),
        (["--modem-on"], {}),
        (["--tone"], {"M1959": 0}),
        (["--pulse"], {}),
        (["--auto-answer", "255"], {"R4163": 0xFF14}),
        (["--auto-answer", "0"], {"R4163": 0x0014}),
        (["--dial-control", "1"], {"R4163": 0x0311}),
        (["--profile", "factory"], {"R4163": 0x0304}),
        (["--profile", "factory", "--auto-answer", "1", "--dial-control", "3"], {"R4163": 0x0103}),
        (["--tone", "--modem-off"], {"M1959": 0, "R4149": 0x0012}),
    ],
)
def test_what_is_named_is_set_and_nothing_else(
    plc: Path, cli: Cli, words: list[str], changes: dict[str, int]
) -> None:
    done = cli("link", "modem", "set", *words, "-p", PLC, "--yes", "--json")
    assert done.code == 0, done
    found = done.document("link-modem")["set"]
    assert {change["element"] for change in found["changes"]} == set(changes)
    assert found["written"] == len(changes)
    assert held(cli) == BEFORE | changes
    assert len(list(plc.glob("modem.safety-st01-*.json"))) == bool(changes)
    if changes:
        assert cli("snapshot", "apply", found["safety_snapshot"], "-p", PLC, "--yes").code == 0
        assert held(cli) == BEFORE


def test_a_dry_run_writes_nothing(plc: Path, cli: Cli) -> None:
    done = cli("link", "modem", "set", "--tone", "--dry-run", "-p", PLC)
    assert done.code == 0
    assert "M1959  1 -> 0\nPrevious values will be saved first.\ndry run: nothing was written" in done.out
    assert held(cli) == BEFORE
    assert not list(plc.glob("*safety*"))


@pytest.mark.parametrize(
    ("words", "message"),
    [
        ([], "nothing to set; name a setting"),
        (["--tone"], "no terminal to ask on: nothing was written; add --yes"),
        (["--number", "12x"], "got 'x'"),
        (["--number", "1" * 24, "--yes"], "expected 1 to 23 characters, got 24"),
        (["--dial-control", "5"], "5 is not in the range 1<=x<=4"),
        (["--auto-answer", "256"], "256 is not in the range"),
        (["--tone", "--no-safety-snapshot", "--safety-dir", "."], "does not go with"),
        (["--tone", "--safety-dir", "plc.state"], "plc.state is not a folder"),
    ],
)
def test_what_is_refused_writes_nothing(plc: Path, cli: Cli, words: list[str], message: str) -> None:
    done = cli("link", "modem", "set", *words, "-p", PLC)
    assert done.code == 2
    assert message in one_line(done.err)
    assert held(cli) == BEFORE
    assert not list(plc.glob("*safety*"))


@pytest.mark.usefixtures("place")
def test_what_does_not_take_is_named(cli: Cli) -> None:
    assert cli("discrete", "disable", "M1959", "-p", PLC).code == 0
    done = cli("link", "modem", "set", "--pulse", "-p", PLC, "--yes", "--no-safety-snapshot")
    assert done.code == 4
    assert "NOT saved" in done.err
    assert "M1959: not kept: expected 1, read back 0: it is disabled" in done.err


def test_a_line_that_fails_on_the_way_is_gone_on_with(place: Path, cli: Cli) -> None:
    simulation = build_simulation()
    cut: list[ScriptedModem] = []

    class Cutting(ScriptedModem):
        def receive(self, data: bytes, now: float) -> list[tuple[float, bytes]]:
            if self.online and data[3:5] in {b"47", b"49", b"45"}:
                self.online = False
                return [(now, b"\r\nNO CARRIER\r\n")]
            return super().receive(data, now)

    cut.append(Cutting(plc=simulation.line()))
    with plugged_in(place, cut[0]) as target:
        done = cli("link", "modem", "set", "--number", "123", "-p", target, "--yes", "--json")
    assert done.code == 6
    error: dict[str, Any] = done.document("error")["error"]
    assert "the call ended" in error["message"]
    assert error["details"]["command"].startswith("fatektool link modem set --number 123 -p ")
    assert (place / error["details"]["safety_snapshot"]).exists()


def test_settings_without_a_setting_name_no_element() -> None:
    assert ModemSettings().elements == ()
    assert ModemSettings(rings=0).elements == ("R4163",)
    with pytest.raises(UsageError):
        ModemSettings(number="").apply({})
