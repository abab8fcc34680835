"""Commands over the three framings, on TCP and a pty, as a user gives them."""

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

PROTOCOLS = ["modbus-rtu", "modbus-ascii", "modbus-tcp"]
OWN = [0xA55A, 0, 1000, 100, 10, 1100, 50, 50, 1000, 10, 100, 2000, 200]
OWN_TEXT = "M1000-M1099=000001,M1100-M1149=100011,R1000-R1009=300051,R2000-R2199=400101"


class Line:
    """A served PLC, and commands for it."""

    def __init__(self, target: str, protocol: str, simulation: Simulation, cli: Cli) -> None:
        self.target = target
        self.protocol = protocol
        self.device = simulation.plcs[1]
        self._cli = cli

    def __call__(self, *words: object) -> Done:
        given = () if "--timeout" in words else ("--timeout", "0.5")
        return self._cli(*words, "-p", self.target, "--protocol", self.protocol, *given)


@pytest.fixture(params=["modbus-rtu tcp", "modbus-rtu pty", "modbus-ascii pty", "modbus-tcp tcp"])
def line(request: pytest.FixtureRequest, place: Path, cli: Cli) -> Iterator[Line]:
    protocol, medium = request.param.split()
    simulation = build_simulation([1, 247], protocol=protocol, faults=["drop=0.05", "noise=0.05"], seed=4)
    server = Server(simulation)
    door = server.open_tcp() if medium == "tcp" else server.open_pty(str(place / "plc"))
    with hurried(server):
        yield Line(door.address, protocol, simulation, cli)


def test_read_and_write(line: Line) -> None:
    done = line("write", "R0=0x55AA", "D10:f32=1.5", "WM16=5", "Y3=on", "DRC200=70000", "R5-R200=7")
    assert done.code == 0, done.err
    assert line.device.read_words("R", 0, 1) == [0x55AA]
    assert line.device.read_long_counters(0, 2) == [70000 & 0xFFFF, 1]
    read = line("read", "R0-R200", "D10:f32", "M16-M19", "Y0-Y4", "X0-X255", "DRC200", "RT0", "C0", "--json")
    document = read.document("read")
    wanted = {"R0": 0x55AA, "R5": 7, "D10": 1.5, "M16": True, "M17": False, "M18": True, "Y3": True}
    assert document["values"] | wanted == document["values"]
    assert document["values"]["DRC200"] == 70000
    assert document["protocol"] == line.protocol
    assert document["requests"] <= 9


def test_single_discretes(line: Line) -> None:
    assert line("discrete", "set", "Y7", "M5", "--json").document("discrete")["discretes"] == {
        "Y7": {"on": True, "disabled": None},
        "M5": {"on": True, "disabled": None},
    }
    assert line.device.read_discretes("Y", 7, 1) == b"\1"
    assert line("discrete", "reset", "Y7").code == 0
    assert line("discrete", "list", "Y7", "M5").out.split() == ["Y7", "off", "M5", "on"]
    failed = line("discrete", "set", "X3")
    assert failed.code == 4
    assert "X3: no effect: acknowledged, but nothing changed: it is disabled, an input" in failed.err


def test_snapshots_and_watch(line: Line, place: Path) -> None:
    line.device.write_words("R", 0, list(range(300)))
    taken = line("snapshot", "R0-R299", "M0-M99", "-o", place / "a.json", "--json")
    assert taken.code == 0, taken.err
    assert taken.document("snapshot")["running"] is None
    line.device.write_words("R", 0, [7])
    applied = line("snapshot", "apply", place / "a.json", "--yes")
    assert applied.code == 0, applied.err
    assert line.device.read_words("R", 0, 2) == [0, 1]
    watched = line("watch", "R0-R3", "--count", "2", "--interval", "0.01")
    assert [json.loads(row)["values"]["R1"] for row in watched.out.splitlines()] == [1, 1]
    prometheus = line("snapshot", "R1", "--format", "prometheus")
    assert "fatek_running" not in prometheus.out
    assert 'key="R1"' in prometheus.out


def test_a_trace_is_explained(line: Line, place: Path, cli: Cli) -> None:
    for name in ("line.pcap", "line.ndjson"):
        assert line("read", "R0-R3", "--trace", place / name).code == 0
        document = cli("decode", "--protocol", line.protocol, place / name, "--json").document("decode")
        good = [frame for frame in document["frames"] if frame["fault"] is None]
        assert [frame["role"] for frame in good][:2] == ["request", "answer"]
        assert {frame["command"] for frame in good[:2]} == {"03"}
        assert any(field["name"] == "R3" for field in good[1]["fields"])
        refused = cli("decode", "--protocol", "mseries", place / name)
        assert refused.code == 5


def test_a_scan_finds_who_answers(line: Line) -> None:
    found = line("scan", "--stations", "1,2,246-250", "--timeout", "0.5", "--retries", "2", "--json")
    document = found.document("scan")
    stations = [row["station"] for row in document["found"]]
    assert set(stations) <= {1, 247}  # a dropped answer is nobody's
    assert stations
    tcp = document["found"][0]["protocol"] == "modbus-tcp"  # which has units up to 255
    assert document["probes"] == (7 if tcp else 4)
    assert {(row["running"], row["model"]) for row in document["found"]} == {(None, None)}


# --- the user's own map ---------------------------------------------------------------------------


@pytest.fixture
def state(place: Path, cli: Cli) -> str:
    """A simulated PLC whose own map is in force, set over FACON."""
    target = f"sim:{place / 'plc.state'}"
    words = [f"R{3968 + n}={word}" for n, word in enumerate(OWN)]
    assert cli("write", *words, "R2000=42", "M1000=on", "M1100=on", "R1009=9", "-p", target).code == 0
    return target


@pytest.mark.parametrize("protocol", PROTOCOLS)
def test_a_map_as_given_and_from_a_snapshot(protocol: str, state: str, place: Path, cli: Cli) -> None:
    taken = cli("snapshot", "R3968-R3980", "-o", place / "map.json", "-p", state)
    assert taken.code == 0, taken.err
    for text in (OWN_TEXT, place / "map.json"):
        options = ["-p", state, "--protocol", protocol, "--modbus-map", text]
        read = cli("read", "R2000", "M1000", "M1100", "R1009", *options)
        assert read.code == 0, read.err
        assert read.out.split() == ["R2000", "42", "M1000", "on", "M1100", "on", "R1009", "9"]
        assert cli("write", "R2199=5", "M1099=1", *options).code == 0
        refused = cli("read", "R100", *options)
        assert refused.code == 2
        assert "R100 has no Modbus reference: the custom map has M1000-M1099" in one_line(refused.err)
        refused = cli("write", "M1100=0", *options)
        assert refused.code == 2
        assert "M1100 can be read over Modbus, but not written" in refused.err
    without = cli("read", "R2000", "-p", state, "--protocol", protocol)
    assert without.code == 4
    assert "exception 02" in without.err


def test_the_map_that_the_plc_has_itself(state: str, cli: Cli) -> None:
    options = ["-p", state, "--protocol", "modbus-tcp", "--modbus-map", "custom"]
    hidden = cli("read", "R2000", *options)
    assert hidden.code == 4
    assert "R3968 cannot be read" in one_line(hidden.err)
    assert "fatektool snapshot R3968-R3980" in hidden.err
    assert cli("write", "R3978=3839", "R3979=3839", "R3980=200", "-p", state).code == 0
    seen = cli("read", "R3979", "M1000", *options)
    assert seen.code == 0, seen.err
    assert seen.out.split() == ["R3979", "3839", "M1000", "on"]
    assert cli("write", "R3968=0", "-p", state).code == 0
    standard = cli("read", "R2000", *options)
    assert standard.code == 4
    assert "omit the option" in standard.err
    # Another register stands where R3968 would be, and happens to hold the mark.
    words = ["R3968=0xA55A", "R3978=3968", "R3979=2000", "R3980=100", "R2000=0xA55A"]
    assert cli("write", *words, "-p", state).code == 0
    assert cli("read", "R2000", *options).code == 4


@pytest.mark.parametrize(
    ("words", "code", "said"),
    [
        (["read", "R0", "--modbus-map", "custom"], 2, "a Modbus map is for a Modbus protocol, not for facon"),
        (["read", "R0", "--modbus-map", "R0=1", "--protocol", "modbus-rtu"], 2, "expected ELEMENT-ELEMENT"),
        (["read", "R0", "--modbus-map", "no.json", "--protocol", "modbus-rtu"], 2, "no.json"),
    ],
)
def test_maps_that_cannot_be(words: list[str], code: int, said: str, cli: Cli) -> None:
    refused = cli(*words, "-p", "sim:")
    assert refused.code == code
    assert said in one_line(refused.err)


# --- what Modbus lacks ----------------------------------------------------------------------------


@pytest.mark.parametrize("protocol", PROTOCOLS)
@pytest.mark.parametrize(
    "words",
    [
        ["status"],
        ["status", "--brief"],
        ["run", "--yes"],
        ["stop", "--yes"],
        ["loopback"],
        ["doctor"],
        ["discrete", "disable", "X3"],
        ["discrete", "enable", "X3"],
        ["snapshot", "--all"],
        ["backup", "x.json"],
        ["verify", "press.json"],
        ["restore", "press.json", "--yes"],
    ],
    ids=" ".join,
)
def test_one_line_before_anything_is_opened(protocol: str, words: list[str], place: Path, cli: Cli) -> None:
    save_backup(backup(NEW), place / "press.json")
    refused = cli(*words, "-p", "/dev/nothing", "--protocol", protocol)
    assert refused.code == 2
    line = one_line(refused.err)
    assert f"{protocol} has no " in line
    assert sorted(path.name for path in place.iterdir()) == ["press.json"]


@pytest.mark.parametrize("station", [248, 254])
def test_stations_past_247(station: int, cli: Cli) -> None:
    refused = cli("read", "R0", "-p", "/dev/nothing", "--protocol", "modbus-rtu", "-s", station)
    assert refused.code == 2
    assert f"station: expected 1 to 247, got {station}" in one_line(refused.err)
    assert cli("scan", "--stations", "250", "-p", "sim:", "--protocol", "modbus-rtu").code == 2


def test_what_each_framing_needs(cli: Cli) -> None:
    serial = cli("read", "R0", "-p", "/dev/ttyS99", "--protocol", "modbus-tcp")
    assert serial.code == 2
    assert "modbus-tcp is for networks: expected tcp://HOST" in one_line(serial.err)
    seven = cli("read", "R0", "-p", "/dev/ttyS99", "--protocol", "modbus-rtu", "--format", "7E1")
    assert "expected 8 data bits" in one_line(seven.err)
    port = cli("read", "R0", "-p", "tcp://127.0.0.1", "--protocol", "modbus-rtu")
    assert "expected a port" in one_line(port.err)
    assert cli("read", "R0", "-p", "/dev/ttyS99", "--protocol", "modbus-ascii").code == 3  # 7E1 unless named


# --- modbus map -----------------------------------------------------------------------------------


def test_the_map_both_ways(cli: Cli) -> None:
    shown = cli("modbus", "map", "R100", "406012", "46012", "DRC200", "409702", "X16", "04002")
    assert shown.code == 0
    assert shown.out.splitlines() == [
        "R100    400101 (40101), holding register, offset 100",
        "D11     406012 (46012), holding register, offset 6011",
        "D11     406012 (46012), holding register, offset 6011",
        "DRC200  409701 to 409702 (49701), holding register, offset 9700",
        "DRC200  409702 (49702), high word, holding register, offset 9701",
        "X16     001017 (01017), coil, offset 1016",
        "M2001   004002 (04002), coil, offset 4001",
    ]
    document = cli("modbus", "map", "--json").document("modbus-map")
    assert [entry["element"] for entry in document["entries"]][-1] == "DRC200"
    assert document["entries"][-1]["last_reference"] == "409812"
    own = cli("modbus", "map", "--modbus-map", OWN_TEXT, "100011", "R1009", "--json").document("modbus-map")
    assert own["map"] == "custom"
    assert [(entry["element"], entry["reference"]) for entry in own["entries"]] == [
        ("M1100", "100011"),
        ("R1009", "300060"),
    ]


@pytest.mark.parametrize(
    ("name", "said"),
    [
        ("R4168", "R4168 has no Modbus reference"),
        ("RC200", "use DRC200"),
        ("404169", "404169: no element of the PLC"),
        ("500001", "is not a Modbus reference"),
        ("Q7", "unknown element kind"),
    ],
)
def test_what_the_map_lacks(name: str, said: str, cli: Cli) -> None:
    refused = cli("modbus", "map", "R0", name)
    assert refused.code == 2
    assert said in one_line(refused.err)
    assert not refused.out
