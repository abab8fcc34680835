"""A snapshot as text, read back as the reader at the other end does."""

from __future__ import annotations

import csv
import io
import json
import re
from typing import TYPE_CHECKING, Any

import pytest
from hypothesis import given
from hypothesis import strategies as st

from fatektool.jobs.elements.selection import Item
from fatektool.jobs.snapshots.formats import FORMATS
from fatektool.jobs.snapshots.snapshot import Snapshot, parse_snapshot, take_snapshot
from fatektool.jobs.snapshots.spec import SpecItem
from fatektool.protocol.elements import Element
from fatektool.protocol.values import ValueType
from tests.cli.running import check
from tests.plant import small

if TYPE_CHECKING:
    from tests.plant import Plant

SECONDS = 1795317300
NASTY = [
    'a,b "c"',
    "line\nbreak",
    "back\\slash",
    "end\\",
    "\\",
    "x=1 y",
    "größe °C",
    "a\tb\r",
    "'",
    "{}",
    "a\\,b\\ c",
]


def snapshot(keys: list[str], target: str = "sim:", unit: str | None = None) -> Snapshot:
    """A number, a discrete, a hex text and one without a value, over and over, under these keys."""
    parts: list[tuple[Any, dict[str, Any]]] = [
        (12, {"element": "R12", "type": "u16", "raw": "000C"}),
        (True, {"element": "X1", "type": "bool", "raw": "1"}),
        ("00AB", {"element": "R3", "type": "hex", "raw": "00AB"}),
        (None, {"element": "R9000", "type": "u16", "raw": None}),
        (-2.5, {"element": "DD4", "type": "f32", "raw": "C0200000"}),
    ]
    values, elements = {}, {}
    for number, key in enumerate(keys):
        value, part = parts[number % len(parts)]
        values[key] = value
        elements[key] = part | ({} if unit is None else {"unit": unit})
    errors = {key: 'it said "no", twice\n' for key, value in values.items() if value is None}
    return Snapshot(
        time="2026-11-22T03:15:00Z",
        target=target,
        station=7,
        protocol="facon",
        running=True,
        duration_s=0.5,
        requests=3,
        values=values,
        elements=elements,
        errors=errors,
    )


def influx_lines(text: str) -> list[tuple[dict[str, str], dict[str, str], int]]:
    """Tags, fields and time of each line: a backslash escapes , = and blank, and nothing else."""
    found = []
    for line in text.split("\n")[:-1]:
        match = re.fullmatch(r"((?:[^\\ ]|\\[,= ])+) (\w+=(?:[^\" ]+|\"[^\"\\]*\")) (\d+)", line)
        assert match is not None, line
        head, fields, stamp = match.groups()
        measurement, *tags = re.split(r"(?<!\\),", head)
        assert measurement == "fatek"
        pairs = (re.split(r"(?<!\\)=", tag) for tag in tags)
        found.append(
            (
                {name: re.sub(r"\\([,= ])", r"\1", value) for name, value in pairs},
                dict([fields.split("=", 1)]),
                int(stamp),
            )
        )
    return found


def prometheus_samples(text: str) -> list[tuple[str, dict[str, str], float]]:
    """Name, labels and value of each sample, by the text format's grammar."""
    unescape = {"\\\\": "\\", '\\"': '"', "\\n": "\n"}
    found = []
    types: dict[str, str] = {}
    for line in text.split("\n")[:-1]:
        if line.startswith("#"):
            _, word, name, rest = line.split(" ", 3)
            if word == "TYPE":
                assert name not in types
                types[name] = rest
            continue
        match = re.fullmatch(r'([a-z_]+)\{((?:[a-z]+="(?:[^"\\\n]|\\[\\n"])*",?)*)\} (\S+)', line)
        assert match is not None, line
        assert types[match[1]] == "gauge"
        labels = re.findall(r'([a-z]+)="((?:[^"\\\n]|\\[\\n"])*)"', match[2])
        plain = {name: re.sub(r'\\[\\n"]', lambda part: unescape[part[0]], value) for name, value in labels}
        found.append((match[1], plain, float(match[3])))
    return found


def test_json_and_ndjson() -> None:
    made = snapshot(NASTY, unit="°C")
    check(made.document(), "snapshot")
    for form in ("json", "ndjson"):
        text = FORMATS[form](made)
        assert json.loads(text) == made.document()
    assert FORMATS["ndjson"](made).count("\n") == 1
    assert list(made.document()) == [
        "schema", "time", "target", "station", "protocol", "running", "duration_s", "requests", "values",
        "elements", "errors",
    ]  # fmt: skip


def test_csv() -> None:
    made = snapshot(NASTY, target='a,"b"')
    rows = list(csv.DictReader(io.StringIO(FORMATS["csv"](made), newline="")))
    assert [row["key"] for row in rows] == NASTY
    assert {row["target"] for row in rows} == {'a,"b"'}
    assert [row["value"] for row in rows[:5]] == ["12", "true", "00AB", "", "-2.5"]
    assert rows[3]["error"] == 'it said "no", twice\n'
    assert rows[4]["raw"] == "C0200000"


def test_influx() -> None:
    made = snapshot(NASTY, target="tcp://10.0.0.5:500", unit="m/s, gross")
    lines = influx_lines(FORMATS["influx"](made))
    assert {stamp for _, _, stamp in lines} == {SECONDS * 10**9}
    assert {tags["unit"] for tags, _, _ in lines} == {"m/s, gross"}
    assert {tags["station"] for tags, _, _ in lines} == {"7"}
    assert {name for _, fields, _ in lines for name in fields} == {"value", "text"}
    for _, fields, _ in lines:  # one field, one type: a float without i, t or quotes, or a text
        if "value" in fields:
            float(fields["value"])
        else:
            assert fields["text"] == '"00AB"'
    kept = [key for key, value in made.values.items() if value is not None]
    got = [tags["key"] for tags, _, _ in lines]
    assert got == [re.sub(r"[\n\t\r]", " ", key).replace("\\", "/") for key in kept]


def test_prometheus() -> None:
    made = snapshot(NASTY, target='a"b\\c\nd', unit='"')
    samples = prometheus_samples(FORMATS["prometheus"](made))
    assert ("fatek_running", {"target": 'a"b\\c\nd', "station": "7"}, 1.0) in samples
    assert samples[1][2] == SECONDS
    shown = {labels["key"]: value for name, labels, value in samples if name == "fatek_value"}
    assert shown == {
        key: float(value) for key, value in made.values.items() if isinstance(value, int | float)
    }


@given(st.lists(st.text(min_size=1, max_size=12), min_size=1, max_size=6, unique=True), st.text(max_size=12))
def test_any_keys(keys: list[str], target: str) -> None:
    made = snapshot(keys, target)
    assert json.loads(FORMATS["ndjson"](made)) == made.document()
    rows = list(csv.DictReader(io.StringIO(FORMATS["csv"](made), newline="")))
    assert [row["key"] for row in rows] == keys
    shown = [
        labels["key"]
        for name, labels, _ in prometheus_samples(FORMATS["prometheus"](made))
        if name == "fatek_value"
    ]
    numbers = [key for key, value in made.values.items() if isinstance(value, int | float)]
    assert shown == numbers
    assert len(influx_lines(FORMATS["influx"](made))) == sum(
        value is not None for value in made.values.values()
    )


@pytest.mark.parametrize("form", FORMATS)
def test_formats_on_the_command_line(plant: Plant, form: str) -> None:
    done = plant.cli("snapshot", "R0:3", "Y0", "R4:hex", "--format", form)
    assert done.code == 0
    assert done.err == ""
    for order in (["--format", form.upper(), "--format", "8N1"], ["--format", "7E2", "--format", form]):
        again = plant.cli("snapshot", "R0:3", "Y0", "R4:hex", *order)
        assert again.code == 0, again.err
        assert len(again.out.splitlines()) == len(done.out.splitlines())


@pytest.mark.parametrize(
    "formats",
    [["xml"], ["json", "csv"], ["8N1", "7E1"], ["csv", "8N1", "csv"], [""], ["jsonx"], ["9N1"], ["8X1"]],
)
def test_a_wrong_format(plant: Plant, formats: list[str]) -> None:
    done = plant.cli("snapshot", "R0", *(word for form in formats for word in ("--format", form)))
    assert done.code == 2, done
    assert done.err.count("\n") == 1


def test_a_nan_has_no_value_in_any_format() -> None:
    made = small()
    made.plc.write_registers(Element("DD", 4), [0x7FC00000])
    items = [
        SpecItem(Item("nan", Element("DD", 4), ValueType.F32)),
        SpecItem(Item("R1", Element("R", 1), ValueType.U16)),
    ]
    taken = take_snapshot(made.plc, items)
    check(taken.document(), "snapshot")
    assert taken.values == {"nan": None, "R1": 0}
    assert taken.errors == {"nan": "7FC00000 is not a number as f32"}
    assert parse_snapshot(FORMATS["json"](taken).encode(), "x") == taken
    assert "nan" not in FORMATS["influx"](taken)
    assert "nan" not in FORMATS["prometheus"](taken)
    rows = list(csv.DictReader(io.StringIO(FORMATS["csv"](taken))))
    assert (rows[0]["raw"], rows[0]["value"]) == ("7FC00000", "")
