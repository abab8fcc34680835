"""A simulated PLC's memory in a file: there and back, and what is refused."""

from __future__ import annotations

import json
import stat
from dataclasses import replace
from typing import TYPE_CHECKING, Any

import pytest

from fatektool.errors import DataError, UsageError
from fatektool.simulator.build import build_plcs, build_simulation
from fatektool.simulator.memory import DiscreteAction
from fatektool.simulator.models import MODELS
from fatektool.simulator.plc import SimulatedPlc
from fatektool.simulator.program.facon_program import demonstration_program
from fatektool.simulator.state import StateFile, dump_state, parse_state
from tests.platforms import symbolic_links
from tests.simulator.wire import frame, sent

if TYPE_CHECKING:
    from collections.abc import Callable
    from pathlib import Path


def used_plc() -> SimulatedPlc:
    plc = SimulatedPlc(7, replace(MODELS["fbs-20mc"], ladder_words=100))
    plc.running = plc.id_differs = True
    plc.write_discretes("Y", 3, b"\x01")
    plc.control_discrete(DiscreteAction.DISABLE, "X", 16)
    plc.set_input(16, 1)
    for symbol in ("R", "D", "F", "RT", "RC"):
        plc.write_words(symbol, 12, [0xBEEF])
    return plc


def test_there_and_back() -> None:
    plc = used_plc()
    text = dump_state([plc, SimulatedPlc(8)])
    again = parse_state(text, "x")
    assert dump_state(again) == text
    assert again[0].running
    assert again[0].read_words("F", 12, 1) == [0xBEEF]
    assert again[0].read_discretes("X", 16, 1) == b"\x00"
    again[0].control_discrete(DiscreteAction.ENABLE, "X", 16)
    assert again[0].read_discretes("X", 16, 1) == b"\x01"
    assert again[0].pages == plc.pages


def test_the_file_is_sparse() -> None:
    plc = SimulatedPlc(model=replace(MODELS["fbe-28mc"], ladder_words=64), pages=[b"\xff" * 128] * 2)
    (part,) = json.loads(dump_state([plc]))["plcs"]
    assert part == {
        "station": 1,
        "model": "fbe-28mc",
        "ladder_words": 64,
        "flags": [],
        "on": {},
        "disabled": {},
        "inputs": [],
        "registers": {},
        "pages": {},
    }


DAMAGES: dict[str, Callable[[dict[str, Any]], object]] = {
    "flags is not a list": lambda plc: plc.update(flags="running"),
    "flags is not a list of running, battery_low": lambda plc: plc.update(flags=["tired"]),
    "unknown model 'fx'": lambda plc: plc.update(model="fx"),
    "unknown model 1": lambda plc: plc.update(model=1),
    "unknown model []": lambda plc: plc.update(model=[]),
    "station: expected 1 to 254, got 0": lambda plc: plc.update(station=0),
    "station: expected 1 to 254, got True": lambda plc: plc.update(station=True),
    "station: expected 1 to 254, got 1.0": lambda plc: plc.update(station=1.0),
    "ladder_words: expected 1 to 65535, got 65536": lambda plc: plc.update(ladder_words=65536),
    "pages: expected 0 to 2, got 3": lambda plc: plc["pages"].update({"3": "00" * 128}),
    "pages: '01' is not an address": lambda plc: plc["pages"].update({"01": "00" * 128}),
    "pages: '99999999999' is not an address": lambda plc: plc["pages"].update({"9" * 11: "00" * 128}),
    "pages: not an object": lambda plc: plc.update(pages=[]),
    "page 0: expected 256 hex digits": lambda plc: plc["pages"].update({"0": "00" * 127}),
    "page 1: expected 256 hex digits": lambda plc: plc["pages"].update({"1": "0g" * 128}),
    "page 2: expected 256 hex digits": lambda plc: plc["pages"].update({"2": None}),
    "a PLC: expected the keys": lambda plc: plc.update(more=1),
    "got 'station'": lambda plc: plc.pop("pages"),
    "on is not an object of X, Y": lambda plc: plc["on"].update(Q=[1]),
    "on: not a list of addresses": lambda plc: plc["on"].update(Y={}),
    "on: expected 0 to 255, got 256": lambda plc: plc["on"].update(Y=[256]),
    "disabled is not an object": lambda plc: plc.update(disabled=[]),
    "inputs: not a list": lambda plc: plc.update(inputs=None),
    "inputs: expected 0 to 255, got -1": lambda plc: plc.update(inputs=[-1]),
    "registers: '-1' is not an address": lambda plc: plc["registers"].update(R={"-1": 1}),
    "registers: expected 0 to 8071, got 8072": lambda plc: plc["registers"].update(R={"8072": 1}),
    "a register: expected 0 to 65535, got 65536": lambda plc: plc["registers"].update(R={"1": 65536}),
}


@pytest.mark.parametrize("message", DAMAGES)
def test_damage_is_named(message: str) -> None:
    document = json.loads(dump_state([used_plc()]))
    DAMAGES[message](document["plcs"][0])
    with pytest.raises(DataError) as refused:
        parse_state(json.dumps(document), "plc.json")
    assert message in str(refused.value)
    assert str(refused.value).startswith("plc.json: ")
    assert "\n" not in str(refused.value)


@pytest.mark.parametrize(
    ("text", "message"),
    [
        (b"", "not a JSON document"),
        (b"{", "not a JSON document"),
        (b"\xff\xfe\xfd", "not a JSON document"),
        (b"[" * 100000, "not a JSON document"),
        (b"[]", "schema"),
        (b'{"schema": "fatektool.backup/1"}', "schema"),
        (b'{"schema": "fatektool.simulator/1"}', "got 'schema'"),
        (b'{"schema": "fatektool.simulator/1", "plcs": []}', "at least one"),
        (b'{"schema": "fatektool.simulator/1", "plcs": {}}', "at least one"),
        (b'{"schema": "fatektool.simulator/1", "plcs": [1]}', "a PLC is not an object"),
    ],
)
def test_what_is_no_state(text: bytes, message: str) -> None:
    with pytest.raises(DataError, match=message):
        parse_state(text, "x")


def test_a_station_is_there_once() -> None:
    with pytest.raises(DataError, match="station 7 occurs twice"):
        parse_state(dump_state([used_plc(), used_plc()]), "x")


def test_save_if_changed(tmp_path: Path) -> None:
    path = tmp_path / "plc.json"
    simulation = build_simulation(state=path)
    first = path.read_text()
    assert not simulation.save_if_changed()
    assert sent(simulation.line(), frame("40")) != b""
    assert path.read_text() == first
    sent(simulation.line(), frame("4701R000120001"))
    assert path.read_text() != first
    assert list(tmp_path.iterdir()) == [path]
    again = build_simulation(state=path)
    assert again.plcs[1].read_words("R", 12, 1) == [1]
    assert not again.save_if_changed()


def test_a_page_is_in_the_file_when_it_is_acknowledged(tmp_path: Path) -> None:
    path = tmp_path / "plc.json"
    line = build_simulation(state=path, faults=["power-cut=2"]).line()
    for page in (0, 1):
        sent(line, frame(f"50{page:04X}" + "AB" * 128))
    pages = build_simulation(state=path).plcs[1].pages
    assert pages[0] == b"\xab" * 128
    assert pages[1:] == demonstration_program(13184)[1:]


@symbolic_links
def test_a_link_to_a_state_file_stays_one(tmp_path: Path) -> None:
    real, link = tmp_path / "real.json", tmp_path / "link.json"
    build_simulation(state=real)
    link.symlink_to(real)
    before = real.read_text()
    sent(build_simulation(state=link).line(), frame("411"))
    assert link.is_symlink()
    assert real.read_text() != before


def test_what_cannot_be_read_or_written(tmp_path: Path) -> None:
    with pytest.raises(DataError, match="cannot be read"):
        StateFile(tmp_path).load()
    with pytest.raises(DataError, match="cannot be written"):
        build_simulation(state=tmp_path / "nowhere" / "plc.json")
    (tmp_path / "folder").mkdir()
    with pytest.raises(DataError, match="cannot be written"):
        StateFile(tmp_path / "folder").save_if_changed({1: SimulatedPlc()})
    assert stat.S_ISDIR((tmp_path / "folder").stat().st_mode)
    assert list(tmp_path.iterdir()) == [tmp_path / "folder"]


def test_the_file_says_what_the_plc_is(tmp_path: Path) -> None:
    path = tmp_path / "plc.json"
    build_simulation((3, 4), "fb-40mc", state=path)
    kept = build_simulation(state=path, ladder_words=64, program=demonstration_program(64))
    assert sorted(kept.plcs) == [3, 4]
    assert kept.plcs[3].model == MODELS["fb-40mc"]
    build_simulation((4, 3), "FB-40MC", state=path)
    with pytest.raises(DataError, match="expected the stations 1, got 3, 4"):
        build_simulation((1,), state=path)
    with pytest.raises(DataError, match="station 3: expected the model fbe-28mc, got fb-40mc"):
        build_simulation(model="fbe-28mc", state=path)


def test_build_plcs() -> None:
    program = demonstration_program(100)
    plcs = build_plcs((1, 2), "fb-40mc", program=program)
    assert [plc.model.ladder_words for plc in plcs.values()] == [100, 100]
    assert plcs[1].pages == program
    assert build_plcs(ladder_words=65535)[1].model.page_count == 1025
    assert build_plcs(program=[b"\0" * 128] * 207)[1].model.ladder_words == 13184
    assert build_plcs(program=[b"\0" * 128] * 4)[1].model.ladder_words == 192
    assert not build_plcs(program_commands=False)[1].program_commands


@pytest.mark.parametrize(
    ("arguments", "message"),
    [
        ({"model": "s7-1200"}, "expected one of fb-20mc"),
        ({"stations": ()}, "at least one"),
        ({"stations": (0,)}, "1 to 254, not 0"),
        ({"stations": (255,)}, "1 to 254"),
        ({"stations": (1, 1)}, "twice"),
        ({"ladder_words": 0}, "1 to 65535"),
        ({"ladder_words": 65536}, "1 to 65535"),
        ({"baud": 0}, "baud"),
        ({"scan_ms": -1}, "scan"),
        ({"scan_ms": float("nan")}, "scan"),
        ({"faults": ["smoke=1"]}, "smoke"),
    ],
)
def test_build_refuses(arguments: dict[str, Any], message: str) -> None:
    with pytest.raises(UsageError, match=message):
        build_simulation(**arguments)


@pytest.mark.parametrize("program", [[], [b"\0" * 128], [b"\0" * 128, b"\0" * 127]])
def test_a_program_that_does_not_fit(program: list[bytes]) -> None:
    with pytest.raises(DataError, match="pages"):
        build_simulation(program=program)
    with pytest.raises(DataError, match="pages"):
        build_simulation(program=demonstration_program(64), ladder_words=65)
