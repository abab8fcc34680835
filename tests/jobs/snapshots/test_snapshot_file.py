"""Snapshot files: read back, compared, and refused when they do not hold."""

from __future__ import annotations

import json
from typing import TYPE_CHECKING, Any

import pytest
from hypothesis import given
from hypothesis import strategies as st

from fatektool.errors import DataError, FatektoolError
from fatektool.jobs.snapshots import snapshot as snapshot_file
from fatektool.jobs.snapshots.compare import compare_snapshots
from fatektool.jobs.snapshots.formats import as_json, as_ndjson
from fatektool.jobs.snapshots.snapshot import Snapshot, load_snapshot, parse_snapshot
from tests.plant import error_of, snapshot_of
from tests.rows import each

if TYPE_CHECKING:
    from collections.abc import Callable
    from pathlib import Path

    from tests.cli.running import Cli
    from tests.plant import Plant

GOOD = snapshot_of("R0:2", "D4:f32", "Y0", "R5:hex", "R6:bcd", "DR8:i32")
TEXT = as_json(GOOD).encode()


def edited(change: Callable[[dict[str, Any]], object]) -> bytes:
    document = json.loads(TEXT)
    change(document)
    return json.dumps(document).encode()


def test_there_and_back() -> None:
    assert parse_snapshot(TEXT, "x") == GOOD
    assert parse_snapshot(as_ndjson(GOOD).encode(), "x") == GOOD


DAMAGE: dict[str, Callable[[dict[str, Any]], object]] = {
    "schema": lambda d: d.update(schema="fatektool.backup/1"),
    "no schema": lambda d: d.pop("schema"),
    "time": lambda d: d.update(time="yesterday"),
    "station": lambda d: d.update(station=True),
    "station 256": lambda d: d.update(station=256),
    "running": lambda d: d.update(running=1),
    "duration": lambda d: d.update(duration_s=-1),
    "requests": lambda d: d.pop("requests"),
    "values": lambda d: d.update(values=[]),
    "a value": lambda d: d["values"].update(R0=[1]),
    "a huge value": lambda d: d["values"].update(R0=10**400),
    "a value less": lambda d: d["values"].pop("R0"),
    "a value more": lambda d: d["values"].update(R99=1),
    "an element less": lambda d: d["elements"].pop("R0"),
    "an element that is none": lambda d: d["elements"].update(R0=5),
    "another element": lambda d: d["elements"]["R0"].update(element="Q0"),
    "an element's number": lambda d: d["elements"]["R0"].update(element=5),
    "type": lambda d: d["elements"]["R0"].update(type="u8"),
    "type of a list": lambda d: d["elements"]["R0"].update(type=["u16"]),
    "no type": lambda d: d["elements"]["R0"].pop("type"),
    "a type that is too wide": lambda d: d["elements"]["R0"].update(type="f32"),
    "hex of a discrete": lambda d: d["elements"]["Y0"].update(type="hex"),
    "no raw": lambda d: d["elements"]["R0"].pop("raw"),
    "raw and value": lambda d: d["elements"]["R0"].update(raw="0001"),
    "value alone": lambda d: d["elements"]["R0"].update(raw=None),
    "0x": lambda d: d["elements"]["R0"].update(raw="0x0"),
    "raw of 17 bits": lambda d: d["elements"]["R0"].update(raw="10000"),
    "a negative raw": lambda d: d["elements"]["R0"].update(raw="-0"),
    "a raw number": lambda d: d["elements"]["R0"].update(raw=0),
    "a bool as number": lambda d: d["values"].update(R0=False),
    "a number as bool": lambda d: d["values"].update(Y0=0),
    "unit": lambda d: d["elements"]["R0"].update(unit=5),
    "scale": lambda d: d["elements"]["R0"].update(scale="2"),
    "a scaled hex": lambda d: d["elements"]["R5"].update(scale=2),
    "an error": lambda d: d["errors"].update(R0=None),
}


@each("name", DAMAGE)
def test_damage_is_named(name: str) -> None:
    with pytest.raises(DataError) as caught:
        parse_snapshot(edited(DAMAGE[name]), "monday.json")
    assert caught.value.message.startswith("monday.json: ")
    assert len(caught.value.message) < 300


@pytest.mark.parametrize("key", sorted(snapshot_of("R0").document()))
def test_every_key_must_be_there(key: str) -> None:
    document = snapshot_of("R0").document()
    del document[key]
    with pytest.raises(DataError, match=r"^a\.json: "):
        parse_snapshot(json.dumps(document).encode(), "a.json")


@pytest.mark.parametrize(
    "data",
    [
        b"", b"{", b"[]", b"null", b"5", b"\xff\xfe", b"[" * 100000, TEXT[:-3], TEXT[: len(TEXT) // 2],
        TEXT.replace(b'"duration_s": ', b'"duration_s": NaN, "x": '),
        TEXT.replace(b'"R0": 0', b'"R0": 1e999'),
        b"1" * 5000, b"\n" * 50,
    ],
)  # fmt: skip
def test_files_that_are_no_snapshot(data: bytes) -> None:
    with pytest.raises(DataError):
        parse_snapshot(data, "x")


@given(st.integers(0, len(TEXT) - 1), st.binary(max_size=3), st.integers(0, 40))
def test_any_damage_is_an_error_of_the_project_or_harmless(at: int, put: bytes, gone: int) -> None:
    data = TEXT[:at] + put + TEXT[at + gone :]
    try:
        found = parse_snapshot(data, "x")
    except FatektoolError as error:
        assert error.exit_code == 5  # noqa: PT017  # any other error fails the test
    else:
        assert not compare_snapshots(found, found)


def of_r0(kind: str, raw: str, value: object) -> Snapshot:
    document = snapshot_of(f"R0:{kind}").document()
    document["values"]["R0"] = value
    document["elements"]["R0"] |= {"raw": raw}
    return parse_snapshot(json.dumps(document).encode(), "x")


def test_another_type_of_the_same_bits_is_no_change() -> None:
    """A register that was read as a number without sign before is not reported as changed."""
    assert not compare_snapshots(of_r0("u16", "FFFF", 65535), of_r0("i16", "FFFF", -1))
    assert compare_snapshots(of_r0("u16", "FFFF", 65535), of_r0("i16", "FFFE", -2))
    assert compare_snapshots(of_r0("i16", "FFFF", -1), of_r0("i16", "FFFE", -2))


@given(st.binary(max_size=100))
def test_any_bytes(data: bytes) -> None:
    with pytest.raises(DataError):
        parse_snapshot(data, "x")


def test_of_many_lines_the_last_counts() -> None:
    one, two = snapshot_of("R0"), snapshot_of("R1")
    lines = as_ndjson(one).encode() + as_ndjson(two).encode()
    assert parse_snapshot(lines, "x") == two
    assert parse_snapshot(lines + b"\n\n", "x") == two


def test_a_broken_last_line_gives_the_one_before_and_says_so() -> None:
    one, two = snapshot_of("R0"), snapshot_of("R1")
    told: list[str] = []
    data = as_ndjson(one).encode() + as_ndjson(two).encode() + as_ndjson(one).encode()[:80]
    assert parse_snapshot(data, "x.ndjson", told.append) == two
    assert told == [f"x.ndjson: the last line is incomplete: the snapshot of {two.time} is used instead"]
    with pytest.raises(DataError):
        parse_snapshot(as_ndjson(one).encode()[:80], "x", told.append)
    damaged = as_ndjson(two).replace('"raw":"0000"', '"raw":"0001"').encode()
    with pytest.raises(DataError, match="raw bits 0001 are 1"):  # whole, but not true: no way round it
        parse_snapshot(as_ndjson(one).encode() + damaged, "x", told.append)
    assert len(told) == 1


def test_of_a_very_long_file_the_end_is_read(place: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    one, two = snapshot_of("R0"), snapshot_of("R1")
    (place / "x.ndjson").write_text(as_ndjson(one) * 10 + as_ndjson(two))
    monkeypatch.setattr(snapshot_file, "MAX_SNAPSHOT", len(as_ndjson(two)) + 100)
    assert load_snapshot(place / "x.ndjson") == two


def test_diff(plant: Plant) -> None:
    plant.write("R0=100", "D4:f32=1.5", "M0=on", "R9=0x10")
    words = ["R0-R3", "D4:f32", "M0", "R9:hex", "RT0"]
    assert plant.cli("snapshot", *words, "-o", "a.json").code == 0
    plant.write("R0=103", "D4:f32=2.5", "M0=off", "R9=0x11", "RT0=5")
    assert plant.cli("snapshot", *words, "R7", "-o", "b.json").code == 0
    assert plant.cli("snapshot", "diff", "a.json", "a.json").out == "same\n"
    done = plant.cli("snapshot", "diff", "a.json", "b.json")
    assert done.code == 1
    assert done.out.splitlines() == [
        "R0   100 -> 103", "D4   1.5 -> 2.5", "M0   on -> off", "R9   0010 -> 0011", "RT0  0 -> 5",
        "R7   (not there) -> 0",
    ]  # fmt: skip
    document = plant.json(
        "snapshot-diff",
        "snapshot",
        "diff",
        "a.json",
        "b.json",
        "--tolerance",
        "3",
        "--ignore",
        "R[T79]*",
        code=1,
    )
    assert document["changes"] == [{"key": "M0", "a": True, "b": False}]
    assert (
        plant.cli("snapshot", "diff", "a.json", "b.json", "--tolerance", "3", "--ignore", "[MR]*").code == 0
    )
    assert (
        plant.cli("snapshot", "diff", "b.json", "a.json", "--tolerance", "0.9", "--ignore", "[MR]*").code == 1
    )
    for tolerance in ("nan", "-1", "x"):
        error_of(plant.cli("snapshot", "diff", "a.json", "b.json", "--tolerance", tolerance), 2)


def test_diff_of_damaged_and_missing_files(cli: Cli, place: Path) -> None:
    (place / "a.json").write_bytes(TEXT)
    (place / "b.json").write_bytes(TEXT[:200])
    error_of(cli("snapshot", "diff", "a.json", "b.json"), 5)
    error_of(cli("snapshot", "diff", "none.json", "a.json"), 2)
    error_of(cli("snapshot", "diff", ".", "a.json"), 2)
    error_of(cli("snapshot", "diff", "a.json"), 2)
    (place / "c.ndjson").write_bytes(as_ndjson(GOOD).encode() + b'{"schema":"fatek')
    done = cli("snapshot", "diff", "a.json", "c.ndjson")
    assert done.code == 0
    assert done.err.startswith("warning: c.ndjson: the last line is incomplete")


def test_the_difference_between_no_value_and_none_there(cli: Cli, place: Path) -> None:
    (place / "a.json").write_text(as_json(snapshot_of("R0", "R9000")))
    (place / "b.json").write_text(as_json(snapshot_of("R0")))
    assert cli("snapshot", "diff", "a.json", "b.json").out == "R9000  - (no value) -> (not there)\n"
