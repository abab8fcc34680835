"""The part ``data`` of a backup file: what is written is read, and nothing damaged is."""

from __future__ import annotations

import json
from dataclasses import replace
from hashlib import sha256
from typing import TYPE_CHECKING, Any

import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from fatektool.errors import DataError
from fatektool.program.archive import Backup
from fatektool.program.data.part import DataPart
from tests.cli.running import check
from tests.night import examples
from tests.program.samples import backup

if TYPE_CHECKING:
    from collections.abc import Callable

SIZES = {"R": 256, "D": 256, "F": 3, "RT": 256, "RC": 256, "M": 256, "S": 256}


def part(**changes: Any) -> DataPart:
    values = {symbol: tuple(range(size)) for symbol, size in SIZES.items()}
    values |= {symbol: tuple(at % 2 for at in range(SIZES[symbol])) for symbol in "MS"}
    made = DataPart("2026-11-22T03:16:00Z", False, values, {"X3": True, "M7": False}, ("R7", "D4-D6"), {})  # noqa: FBT003
    return replace(made, **changes)


def with_data(data: DataPart | None = None) -> Backup:
    return replace(backup(), data=data or part())


def test_the_lines_of_the_file() -> None:
    lines = with_data().to_bytes().decode().splitlines()
    assert (
        '   "R0": "0000 0001 0002 0003 0004 0005 0006 0007 0008 0009 000A 000B 000C 000D 000E 000F",' in lines
    )
    assert f'   "M64": "{"01" * 32}",' in lines
    assert '   "F0": "0000 0001 0002",' in lines
    assert lines[-6:] == ['  "disabled": {', '   "X3": true,', '   "M7": false', "  }", " }", "}"]


def test_the_hash_can_be_computed_by_others() -> None:
    document = json.loads(with_data().to_bytes())
    check(document, "backup")
    data = document["data"]
    lines = [f"{name} {row}\n" for name, row in data["values"].items()]
    lines += [f"{name} {'on' if on else 'off'}\n" for name, on in data["disabled"].items()]
    assert data["sha256"] == sha256("".join(lines).encode()).hexdigest()


@given(st.data())
@settings(max_examples=examples(30))
def test_what_is_written_is_read(draw: st.DataObject) -> None:
    word, bit = st.integers(0, 0xFFFF), st.integers(0, 1)
    values = {
        symbol: tuple(
            draw.draw(st.lists(bit if symbol == "M" else word, min_size=size, max_size=size))
            if symbol in {"R", "M"}
            else (0,) * size
        )
        for symbol, size in SIZES.items()
    }
    disabled = draw.draw(st.dictionaries(st.sampled_from(["X0", "Y1", "M2", "T3", "C4"]), st.booleans()))
    whole = with_data(part(values=values, disabled=disabled, running=draw.draw(st.booleans())))
    assert Backup.parse(whole.to_bytes()) == whole


def test_values_that_are_missing() -> None:
    values = dict(part().values)
    values["R"] = (None, None, *values["R"][2:])
    values["M"] = (0, None, *values["M"][2:])
    whole = with_data(part(values=values, errors={"R0-R1": "illegal address", "M1": "not asked"}))
    assert Backup.parse(whole.to_bytes()) == whole
    check(json.loads(whole.to_bytes()), "backup")


def _set(*path: str, value: object) -> Callable[[dict[str, Any]], object]:
    def change(data: dict[str, Any]) -> None:
        *way, last = path
        for key in way:
            data = data[key]
        data[last] = value

    return change


DAMAGE: dict[str, tuple[Callable[[dict[str, Any]], object], str]] = {
    "a value": (_set("values", "R0", value="0000 " * 15 + "0001"), r"data\.sha256"),
    "a state": (_set("disabled", "X3", value=False), r"data\.sha256"),
    "the hash": (_set("sha256", value="0" * 64), r"data\.sha256"),
    "a line short": (_set("values", "R16", value="0000"), r"data\.values\.R16: expected 16 registers"),
    "no hex": (_set("values", "R16", value="000G " * 16), r"data\.values\.R16"),
    "a relay": (_set("values", "M0", value="2" * 64), r"data\.values\.M0: expected 64 relays"),
    "a line too many": (_set("values", "R256", value="0000"), r"data\.values\.R256: expected no such line"),
    "a line missing": (lambda data: data["values"].pop("D0"), r"data\.values\.D0"),
    "a count": (_set("counts", "R", value=255), r"data\.counts\.R: expected 256"),
    "no count": (lambda data: data["counts"].pop("F"), r"data\.counts\.F"),
    "a time": (_set("time", value="yesterday"), r"data\.time"),
    "a mode": (_set("running", value=1), r"data\.running"),
    "moving": (_set("moving", value=["R0-R256"]), r"data\.moving"),
    "moving kinds": (_set("moving", value=["R0-D1"]), r"data\.moving"),
    "moving nothing": (_set("moving", value=[""]), r"data\.moving"),
    "disabled": (_set("disabled", "R3", value=True), r"data\.disabled"),
    "no state": (_set("disabled", "X3", value=1), r"data\.disabled\.X3"),
    "an error of a value": (_set("errors", "R3", value="why"), r"data\.errors: expected no value of R3"),
    "a value without one": (_set("values", "R0", value="---- " * 15 + "----"), r"data\.errors: expected why"),
}  # fmt: skip


@pytest.mark.parametrize("kind", DAMAGE)
def test_damage_is_refused_and_named(kind: str) -> None:
    change, expected = DAMAGE[kind]
    document = json.loads(with_data().to_bytes())
    change(document["data"])
    with pytest.raises(DataError, match=expected) as error:
        Backup.parse(json.dumps(document).encode(), "press.json")
    assert error.value.exit_code == 5
    assert error.value.details["file"] == "press.json"


@pytest.mark.parametrize("value", [None, [], "data", 3])
def test_data_that_is_no_object(value: object) -> None:
    document = json.loads(with_data().to_bytes()) | {"data": value}
    with pytest.raises(DataError, match="data: expected an object"):
        Backup.parse(json.dumps(document).encode())


READ_BY_THE_RELEASED_VERSION = (
    "schema", "created", "tool", "source", "plc", "header", "ladder_words", "page_count", "passes", "proof",
    "sha256", "pages",
)  # fmt: skip
"""All that version 0.1.0 looks at; it asks for each key by its name, and for no other."""


def test_an_older_version_ignores_it() -> None:
    """Without the key that it does not ask for, the file is the one of a backup without data, to the byte."""
    document = json.loads(with_data().to_bytes())
    older = {key: document[key] for key in READ_BY_THE_RELEASED_VERSION if key in document}
    assert older.keys() | {"data"} == document.keys()
    assert older == json.loads(backup().to_bytes())
    assert Backup.parse(json.dumps(older).encode()) == backup()
