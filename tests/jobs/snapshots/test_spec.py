"""The specification of a snapshot: what it says, and that nothing else gets through."""

from __future__ import annotations

from typing import TYPE_CHECKING

import pytest
from hypothesis import given
from hypothesis import strategies as st

from fatektool.errors import DataError, FatektoolError
from fatektool.jobs.snapshots.snapshot import take_all, take_snapshot
from fatektool.jobs.snapshots.spec import Spec, parse_spec
from fatektool.protocol.elements import Element
from fatektool.protocol.values import ValueType
from fatektool.simulator.models import MODELS
from tests.cli.running import check
from tests.night import night
from tests.plant import error_of, small

if TYPE_CHECKING:
    from pathlib import Path

    from tests.plant import Plant

PRESS = b"""
interval_s = 0.5
[[item]]
element = "R12"
name = "pressure"
type = "i16"
scale = 0.1
offset = -20.0
unit = "bar"
groups = ["hydraulics", "daily"]
[[item]]
element = "D4:f32"
group = "hydraulics"
[[item]]
element = "Y0-Y2"
name = "valve"
[[item]]
element = "R100:2:hex"
unit = "code"
"""


def spec(text: str, *groups: str) -> Spec:
    return parse_spec(text.encode(), "press.toml", groups)


def test_all_that_it_can_say() -> None:
    made = small()
    made.plc.write_registers(Element("R", 12), [-5 & 0xFFFF])
    made.plc.write_registers(Element("R", 100), [0xAB])
    found = parse_spec(PRESS, "press.toml")
    assert found.interval_s == 0.5
    snapshot = take_snapshot(made.plc, found.items)
    check(snapshot.document(), "snapshot")
    assert snapshot.values == {
        "pressure": -20.5, "D4": 0.0, "valve[0]": False, "valve[1]": False, "valve[2]": False,
        "R100": "00AB", "R101": "0000",
    }  # fmt: skip
    assert snapshot.elements["pressure"] == {
        "element": "R12", "type": "i16", "raw": "FFFB", "unit": "bar", "scale": 0.1, "offset": -20.0,
    }  # fmt: skip
    assert snapshot.elements["D4"] == {"element": "DD4", "type": "f32", "raw": "00000000"}


def test_groups() -> None:
    def keys(*groups: str) -> list[str]:
        return [item.item.key for item in parse_spec(PRESS, "press.toml", groups).items]

    assert keys("hydraulics") == ["pressure", "D4"]
    assert keys("daily") == ["pressure"]
    assert keys("daily", "hydraulics") == ["pressure", "D4"]
    with pytest.raises(DataError, match="no item is in group weekly"):
        keys("weekly")


@pytest.mark.parametrize(
    ("text", "said"),
    [
        ("", "no [[item]]"),
        ("item = 5", "no [[item]]"),
        ("item = [5]", "no [[item]]"),
        ("x = 1\n[[item]]\nelement='R0'", "unknown key 'x'"),
        ("[[item]]", "item 1: expected element"),
        ("[[item]]\nelement='R0'\ncolour='red'", "unknown key 'colour'"),
        ("[[item]]\nelement='R0'\n[[item]]\nelement='Q1'", "item 2"),
        ("[[item]]\nelement='R0'\n[[item]]\nelement='R0:u16'", "item 2: 'R0' is used twice"),
        ("[[item]]\nelement='R0'\nname=''", "name"),
        ('[[item]]\nelement="R0"\nname="a\\nb"', "name"),
        ("[[item]]\nelement='R0'\nscale='x'", "scale"),
        ("[[item]]\nelement='R0'\nscale=nan", "scale"),
        ("[[item]]\nelement='R0'\noffset=inf", "offset"),
        ("[[item]]\nelement='R0'\noffset=true", "offset"),
        ("[[item]]\nelement='R0'\nscale=0", "scale"),
        ("[[item]]\nelement='R0'\nscale=1" + "0" * 400, "scale"),
        ("[[item]]\nelement='R0'\nscale=1" + "0" * 5000, "press.toml"),
        ("[[item]]\nelement='R0:hex'\nscale=2", "scale and offset are for numbers"),
        ("[[item]]\nelement='Y0'\noffset=2", "scale and offset are for numbers"),
        ("[[item]]\nelement='R0'\nunit=5", "unit"),
        ("[[item]]\nelement='R0'\ngroups=[5]", "groups"),
        ("[[item]]\nelement='R0'\ngroup={}", "group"),
        ("[[item]]\nelement='R0'\ntype='u8'", "unknown type"),
        ("[[item]]\nelement='R0:i16'\ntype='i16'", "expected an element"),
        ("[[item]]\nelement=2026-11-22", "element"),
        ("interval_s=0\n[[item]]\nelement='R0'", "interval_s"),
        ("interval_s='x'\n[[item]]\nelement='R0'", "interval_s"),
        ("interval_s=1e9\n[[item]]\nelement='R0'", "interval_s"),
        ("".join(f"[[item]]\nelement='R0:60000'\nname='n{n}'\n" for n in range(3)), "at most 100000"),
        ("a" + "=[" * 5000, "invalid TOML"),
    ],
)
def test_what_is_wrong_is_said(text: str, said: str) -> None:
    with pytest.raises(DataError) as caught:
        spec(text)
    assert said in caught.value.message
    assert len(caught.value.message) < 300


@given(
    st.binary(max_size=200)
    | st.integers(0, len(PRESS)).map(lambda at: PRESS[:at] + b"\xff\x00=" + PRESS[at + 1 :])
)
def test_any_bytes(data: bytes) -> None:
    try:
        parse_spec(data, "press.toml")
    except FatektoolError as error:
        assert error.exit_code == 5  # noqa: PT017  # any other error fails the test


def test_a_value_too_large_when_scaled_is_null() -> None:
    made = small()
    made.plc.write_registers(Element("DD", 0), [0x7F7FFFFF])
    snapshot = take_snapshot(made.plc, spec("[[item]]\nelement='D0:f32'\nscale=1e299").items)
    assert snapshot.values == {"D0": None}
    check(snapshot.document(), "snapshot")


def test_on_the_command_line(plant: Plant, place: Path) -> None:
    (place / "press.toml").write_bytes(PRESS)
    document = plant.json("snapshot", "snapshot", "--spec", "press.toml", "--group", "daily")
    assert document["values"] == {"pressure": -20.0}
    error_of(plant.cli("snapshot", "--spec", "none.toml"), 2)
    (place / "bad.toml").write_bytes(b"\xff")
    assert "bad.toml: invalid TOML" in error_of(plant.cli("snapshot", "--spec", "bad.toml"), 5)
    for words in (
        [],
        ["R0", "--all"],
        ["R0", "--spec", "press.toml"],
        ["--all", "--spec", "press.toml"],
        ["R0", "--group", "x"],
    ):
        error_of(plant.cli("snapshot", *words), 2)


@pytest.mark.parametrize("model", ["fbe-28mc", "fbs-20mc", *map(night, sorted(MODELS))])
def test_all_of_every_model(model: str) -> None:
    made = small(model=model)
    before = made.plc.link.counters.exchanges
    snapshot = take_all(made.plc)
    assert snapshot.errors == {}
    what = made.device.model
    assert len(snapshot.values) == (
        what.discrete_inputs + what.discrete_outputs + what.m_relays + what.s_relays
        + 2 * (what.timers + what.counters) + what.r_registers + what.d_registers
    )  # fmt: skip
    assert snapshot.values["R8071"] == 0
    assert snapshot.elements["X255"]["type"] == ValueType.BOOL.value
    assert made.plc.link.counters.exchanges - before < 220
