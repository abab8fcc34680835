"""Commands over TCP and a pty, as a user gives them."""

from __future__ import annotations

import json
from typing import TYPE_CHECKING

import pytest

from fatektool.program.archive import save_backup
from fatektool.simulator.build import build_simulation
from fatektool.simulator.listen.servers import Server
from tests.cli.running import NEW, one_line
from tests.hurry import hurried
from tests.program.samples import backup

if TYPE_CHECKING:
    from collections.abc import Iterator
    from pathlib import Path

    from fatektool.simulator.build import Simulation
    from tests.cli.running import Cli, Done


class Line:
    """A served PLC, and commands for it."""

    def __init__(self, target: str, simulation: Simulation, cli: Cli) -> None:
        self.target = target
        self.device = simulation.plcs[1]
        self._cli = cli

    def __call__(self, *words: object) -> Done:
        return self._cli(*words, "-p", self.target, "--protocol", "mseries")


@pytest.fixture(params=["tcp", "pty"])
def line(request: pytest.FixtureRequest, place: Path, cli: Cli) -> Iterator[Line]:
    simulation = build_simulation(protocol="mseries", ladder_words=400)
    server = Server(simulation)
    door = server.open_tcp() if request.param == "tcp" else server.open_pty(str(place / "plc"))
    with hurried(server):
        yield Line(door.address, simulation, cli)


def test_status(line: Line) -> None:
    line.device.running = True
    line.device.rom_pack = True  # bit 3
    shown = line("status")
    assert shown.code == 0, shown.err
    rows = dict(row.split("  ", 1) for row in shown.out.splitlines())
    assert rows["mode"].strip() == "RUN"
    assert rows["memory card"].strip() == "yes"
    assert "ROM pack" not in rows
    assert "model code" not in rows
    assert "assumed" in rows["detailed status"]
    assert rows["ladder size"].strip() == "400 words"
    document = line("status", "--json").document("status")
    assert document["protocol"] == "mseries"
    assert document["system"]["layout"] == "assumed"
    assert document["system"]["ladder_words"] == 400
    assert document["brief"]["model"] is None
    assert line("status", "--brief", "--json").document("status")["system"] is None


@pytest.mark.parametrize("size", [0, 3, 63, 65])
def test_a_detailed_status_of_another_length(size: int, line: Line, monkeypatch: pytest.MonkeyPatch) -> None:
    said = bytes(range(size))
    monkeypatch.setattr(type(line.device), "detailed_status", lambda _: said)
    document = line("status", "--json").document("status")
    assert document["system"] == {"layout": "raw", "raw": said.hex().upper()}
    assert f"{size} bytes that no paper describes" in line("status").out
    refused = line("snapshot", "--all")
    assert refused.code == 5
    assert f"expected 64 bytes, got {size}" in one_line(refused.err)


def test_write_and_read(line: Line) -> None:
    done = line("write", "R0=0x55AA", "F3=7", "DF10=70000", "DWM0=5", "Y3=on", "D4:f32=1.5")
    assert done.code == 0, done.err
    assert line.device.read_words("F", 10, 2) == [70000 & 0xFFFF, 70000 >> 16]
    read = line("read", "R0-R2", "F3", "DF10", "DWM0", "M0-M3", "Y0-Y4", "D4:f32", "--json")
    values = read.document("read")["values"]
    assert (
        values | {"R0": 0x55AA, "F3": 7, "DF10": 70000, "DWM0": 5, "M2": True, "Y3": True, "D4": 1.5}
        == values
    )


def test_discretes(line: Line) -> None:
    assert line("discrete", "disable", "X16").code == 0
    assert line("discrete", "set", "X16").code == 0
    listed = line("discrete", "list", "X15-X17", "--json")
    assert listed.code == 0, listed.err
    assert line.device.read_disabled("X", 15, 3) == b"\0\1\0"
    assert line.device.read_discretes("X", 15, 3) == b"\0\1\0"
    assert line("discrete", "list", "X16").out.split() == ["X16", "on", "DISABLED"]


def test_run_and_stop(line: Line) -> None:
    assert line("run", "--yes").code == 0
    assert line.device.running
    assert line("stop", "--yes").code == 0
    assert not line.device.running


def test_snapshots(line: Line, place: Path) -> None:
    line.device.write_words("R", 0, list(range(100)))
    taken = line("snapshot", "R0-R99", "F0-F9", "-o", place / "a.json")
    assert taken.code == 0, taken.err
    line.device.write_words("R", 0, [7])
    applied = line("snapshot", "apply", place / "a.json", "--yes")
    assert applied.code == 0, applied.err
    assert line.device.read_words("R", 0, 2) == [0, 1]
    watched = line("watch", "R0-R3", "F0", "--count", "2", "--interval", "0.01")
    assert watched.code == 0, watched.err
    assert [json.loads(row)["values"]["R1"] for row in watched.out.splitlines()] == [1, 1]


def test_a_refusal(line: Line) -> None:
    refused = line("read", "R60000")
    assert refused.code == 4
    assert "error A, illegal address" in refused.err


def test_what_cannot_be_named(line: Line) -> None:
    refused = line("read", "R17152")
    assert refused.code == 2
    assert "its bytes 52 43 00 begin like RC" in one_line(refused.err)


@pytest.mark.parametrize("command", ["backup", "verify", "restore"])
def test_there_is_no_program(command: str, line: Line, place: Path) -> None:
    file = place / "press.json"
    if command != "backup":
        save_backup(backup(NEW), file)
    before = sorted(place.iterdir())
    refused = line(command, file)
    assert refused.code == 2
    assert "mseries has no program commands: its paper does not list read program page (4F)" in one_line(
        refused.err
    )
    assert sorted(place.iterdir()) == before


def test_a_trace_is_explained(line: Line, place: Path, cli: Cli) -> None:
    for name in ("line.pcap", "line.ndjson"):
        assert line("read", "R0-R3", "F1", "--trace", place / name).code == 0
        shown = cli("decode", "--protocol", "mseries", place / name)
        assert shown.code == 0, shown.err
        assert "51" in shown.out
        assert "fault" not in shown.out
        document = cli("decode", "--protocol", "mseries", place / name, "--json").document("decode")
        assert {frame["checksum_ok"] for frame in document["frames"]} == {True}
        assert [frame["role"] for frame in document["frames"]][:2] == ["request", "answer"]
        assert cli("decode", place / name).out == shown.out  # the trace tells its protocol
        refused = cli("decode", place / name, "--protocol", "facon")
        assert refused.code == 5
        assert "no facon frame found" in refused.err
        assert "--protocol mseries" in refused.err


def test_frames_typed_in(cli: Cli) -> None:
    shown = cli("decode", "--protocol", "mseries", "51 10 00 02 01 40 A1 84 55 AA")
    assert shown.code == 0
    assert "  CRC               A1 84                     right" in shown.out.splitlines()
    refused = cli("decode", "--protocol", "mseries", "02 30 31 34 30 43 37 03")
    assert refused.code == 5
    assert "51 10 or 52 10" in one_line(refused.err)
    assert cli("decode", "51 10 00 02 01 40 A1 84 55 AA").code == 5


# --- what must be named ---------------------------------------------------------------------------


@pytest.mark.parametrize("target", ["tcp://127.0.0.1", "tcp://127.0.0.1/", "udp://plc", "tcp://[::1]"])
def test_the_port_must_be_named(target: str, cli: Cli) -> None:
    refused = cli("status", "-p", target, "--protocol", "mseries")
    assert refused.code == 2
    assert "expected a port, because this protocol has no default port" in one_line(refused.err)
    assert f"{target.rstrip('/')}:PORT" in refused.err


def test_seven_data_bits_do_not_carry_it(cli: Cli) -> None:
    refused = cli("status", "-p", "/dev/ttyS99", "--protocol", "mseries", "--format", "7e1")
    assert refused.code == 2
    assert (
        "format: expected 8 data bits, as mseries on a serial line needs, got 7E1; add --line 8E1 or 8N1"
        in one_line(refused.err)
    )
    missing = cli("status", "-p", "/dev/ttyS99", "--protocol", "mseries")  # 8E1 unless named
    assert missing.code == 3


def test_a_plc_without_file_registers_refuses_them(cli: Cli) -> None:
    assert cli("read", "F12", "-p", "sim:").code == 4
    assert cli("read", "F12", "-p", "sim:", "--protocol", "mseries").code == 0


def test_a_simulated_plc_in_a_file(cli: Cli, place: Path) -> None:
    target = f"sim:{place / 'plc.state'}"
    assert cli("write", "F5=42", "R1=3", "-p", target, "--protocol", "mseries").code == 0
    assert cli("read", "F5", "R1", "-p", target, "--protocol", "mseries").out.split() == [
        "F5",
        "42",
        "R1",
        "3",
    ]
    assert cli("read", "R1", "-p", target).out.split() == ["R1", "3"]  # the same memory
