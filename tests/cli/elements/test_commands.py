"""``read``, ``write`` and ``discrete`` as their users type them."""

from __future__ import annotations

from typing import TYPE_CHECKING

import pytest

from fatektool.exchange.receiver import Receiver
from tests.plant import cut_after, error_of, recorded
from tests.rows import each

if TYPE_CHECKING:
    from fatektool.exchange.state import LinkState
    from tests.cli.running import Cli
    from tests.plant import Plant


def test_every_kind_and_type(plant: Plant) -> None:
    plant.write(
        "R0=65535", "R1:i16=-2", "R2:bcd=1234", "R3:hex=BEEF", "DR4=4294967295", "DR6:i32=-3", "D8:f32=-1.5",
        "WM0=0x5555", "DWM16=1", "Y0=on", "Y1=true", "Y2=1", "S0=off", "T1=on", "C1=on", "RT3=7", "RC3=8",
        "DRC10=70000", "D0:u32=305419896", "D2:bcd=99",
    )  # fmt: skip
    words = (
        "R0 R0001:1:i16 R2:bcd R3:hex DR4 DR6:i32 D8:f32 WM0 DWM16:hex y0-Y2 S0 T1 C1 RT3 RC3 DRC10 D0:u32 "
        "D2:1:bcd M0-M3 X0:2:bool r0"
    )
    document = plant.json("read", "read", *words.split())
    assert document["values"] == {
        "R0": -1, "R1": -2, "R2": 1234, "R3": "BEEF", "DR4": -1, "DR6": -3, "D8": -1.5,
        "WM0": 0x5555, "DWM16": "00000001", "Y0": True, "Y1": True, "Y2": True, "S0": False, "T1": True,
        "C1": True, "RT3": 7, "RC3": 8, "DRC10": 70000, "D0": 305419896, "D2": 99,
        "M0": True, "M1": False, "M2": True, "M3": False, "X0": False, "X1": False,
    }  # fmt: skip
    assert document["elements"]["D8"] == {"element": "DD8", "type": "f32", "raw": "BFC00000"}
    assert document["errors"] == {}
    assert plant.cli("read", "R0-R99").out.count("\n") == 100
    assert plant.cli("read", "D0-D6:u32", "-q").out.split()[::2] == ["D0", "D2", "D4", "D6"]


@each(
    "words",
    [
        ["R0:f32:f32"], ["R0:u8"], ["R70000"], ["R0-X5"], ["R9-R0"], ["R0:0"], ["R0:100001"],
        ["R65535:2"], ["WX4"], ["WX8:u32:2"], ["DWX9"], ["X0:i16"], ["X0:hex"], ["R0:bool"], ["DR0:u16"],
        ["WX0-WX8"], ["D0-D5:u32"], ["DR65535"], ["R65535:u32"], ["Q5"], ["R"], [""], ["R0", "R0:u16"],
        ["R-1"],
        ["R0\n"], ["R0 R1"], ["R\u0661"], ["--", "-R1"], ["R0:1:i16:2"], ["X10000"],
    ],
)  # fmt: skip
def test_a_wrong_selection_is_refused_before_a_byte_is_sent(
    plant: Plant, monkeypatch: pytest.MonkeyPatch, words: list[str]
) -> None:
    sent = recorded(monkeypatch)
    if words == ["R0\n"]:
        assert plant.cli("read", *words).code == 0  # white space around it does no harm
        return
    error_of(plant.cli("read", *words), 2)
    assert plant.json("error", "read", *words, code=2)["error"]["exit_code"] == 2
    assert sent == []


@each(
    "words",
    [
        ["R0=65536"], ["R0=-32769"], ["R0:i16=32768"], ["R0:u16=-1"], ["R0:bcd=10000"], ["R0:bcd=-1"],
        ["R0:hex=10000"], ["R0:hex=-5"], ["R0=1.5"], ["R0=0x"], ["R0=on"], ["R0=1_0"], ["DR0=4294967296"],
        ["D0:f32=1e39"], ["D0:f32=1e999"], ["D0:f32=nan"], ["D0:f32=inf"], ["Y0=2"], ["Y0=yes"], ["WX4=1"],
        ["R0"], ["R0="], ["=1"], ["R0:3=1,2"], ["R0:2=1,2,3"], ["R0=1", "R0=1"], ["R0=1", "DR0=1"],
        ["DR1=1", "DR2=1"], ["WM0=1", "M15=on"], ["WM0=1", "WM8=1"], ["DWM0=1", "WM24=1"],
        ["D4:f32=1", "D5=1"],
        ["DRC2=1", "RC3=1"], ["DRT2=1", "DRT3=1"], ["R0=" + "9" * 5000], ["R0=1", "R5=1,2"],
        ["D0:f32=" + "9" * 5000], ["R0:hex=" + "F" * 5000], ["DR0:i32=2147483648"],
    ],
)  # fmt: skip
def test_a_wrong_assignment_is_refused_before_a_byte_is_sent(
    plant: Plant, monkeypatch: pytest.MonkeyPatch, words: list[str]
) -> None:
    sent = recorded(monkeypatch)
    line = error_of(plant.cli("write", *words), 2)
    assert len(line) < 300
    assert sent == []


def test_ranges_take_one_value_or_one_each(plant: Plant) -> None:
    plant.write("R0-R9=5", "R10:3=1,2,3", "M0-M3=on,off,on,off", "D0:2:f32=1.5,-2")
    values = plant.json("read", "read", "R0-R12", "M0:4", "D0:2:f32")["values"]
    assert list(values.values()) == [5] * 10 + [1, 2, 3, True, False, True, False, 1.5, -2.0]


def test_write_says_what_did_not_take(plant: Plant) -> None:
    assert plant.cli("discrete", "disable", "M5", "Y1").code == 0
    words = ["write", "R1=5", "R3840=9", "R3903:i16=-9", "M5=on", "WY0=3", "X4=on", "R9000=1", "R3904=1"]
    document = plant.json("write", *words, code=4)
    assert document["written"] == 2
    failed = {each["element"]: each for each in document["not_taken"]}
    assert set(failed) == {"R3840", "R3903", "M5", "WY0", "X4", "R9000"}
    assert "read-only" in failed["R3840"]["reason"]
    assert (failed["R3903"]["wanted"], failed["R3903"]["got"]) == (-9, 0)
    assert "it is disabled" in failed["M5"]["reason"]
    assert (failed["M5"]["wanted"], failed["M5"]["got"]) == (True, False)
    assert "Y1 is disabled" in failed["WY0"]["reason"]
    assert failed["WY0"]["got"] == 1
    assert "terminal" in failed["X4"]["reason"]
    assert failed["R9000"]["got"] is None
    assert "illegal address" in failed["R9000"]["reason"]
    done = plant.cli(*words)
    assert done.code == 4
    where = f"station 1 on {plant.target} (FBE, 13K steps, STOP)"
    assert done.out == f"2 of 8 elements written and read back\n{where}\n"
    assert (
        "warning: R9000: not written: expected 1: refused, and it cannot be read either: the PLC refused"
        in done.err
    )


def test_a_line_that_dies_while_writing(plant: Plant, monkeypatch: pytest.MonkeyPatch) -> None:
    cut_after(monkeypatch, 2)
    line = error_of(plant.cli("write", "R0-R199=7"), 3)
    assert "some of the 200 values may have been written" in line
    assert plant.register(0) == 7
    assert plant.register(199) == 0


def test_a_line_that_is_dead_from_the_first_request(plant: Plant, monkeypatch: pytest.MonkeyPatch) -> None:
    cut_after(monkeypatch, 0)
    assert "the value may have been written" in error_of(plant.cli("write", "R0=7"), 3)


def test_a_line_that_dies_before_the_first_write(plant: Plant, monkeypatch: pytest.MonkeyPatch) -> None:
    """An answer was still owed to the process before, so a fence goes first, and finds nobody."""
    cut_after(monkeypatch, 0)
    init = Receiver.__init__

    def needing_a_fence(receiver: Receiver, state: LinkState) -> None:
        init(receiver, state)
        receiver.needs_fence = True

    monkeypatch.setattr(Receiver, "__init__", needing_a_fence)
    line = error_of(plant.cli("write", "R0=7"), 3)
    assert "nothing was written" in line
    assert "may have been written" not in line


def test_nan_and_refused_are_null_with_an_error(plant: Plant) -> None:
    plant.write("DD4=0x7FC00000", "R1=0xAAAA", "R2=5")
    document = plant.json("read", "read", "D4:f32", "R1:bcd", "R2", "R9000", code=4)
    assert document["values"] == {"D4": None, "R1": None, "R2": 5, "R9000": None}
    assert document["elements"]["D4"]["raw"] == "7FC00000"
    assert document["elements"]["R9000"]["raw"] is None
    assert set(document["errors"]) == {"D4", "R1", "R9000"}
    done = plant.cli("read", "D4:f32", "R2")
    assert done.out == "D4  -\nR2  5\n"
    assert done.err == "warning: D4: 7FC00000 is not a number as f32\n"


def test_many_refused_are_few_words(plant: Plant) -> None:
    done = plant.cli("read", "R8000-R9999")
    assert done.code == 4
    assert done.err.count("\n") == 2
    why = "R8072 is refused, and the PLC has R0 to R8071 by its status (53)"
    assert done.err.endswith(f"warning: R8073 to R9999 (1927): not asked: {why}\n")


def test_forcing(plant: Plant) -> None:
    plant.change(inputs={3: 1})
    assert plant.json("discrete", "discrete", "disable", "X3-X4", "M1")["discretes"] == {
        "X3": {"on": True, "disabled": True},
        "X4": {"on": False, "disabled": True},
        "M1": {"on": False, "disabled": True},
    }
    where = f"station 1 on {plant.target} (FBE, 13K steps, STOP)\n"
    assert plant.cli("discrete", "set", "X4", "M1").out == f"X4  on   DISABLED\nM1  on   DISABLED\n{where}"
    assert plant.cli("discrete", "reset", "X3", "-q").out == f"X3  off  DISABLED\n{where}"
    listed = plant.cli("discrete", "list", "X3-X5", "M1")
    assert " ".join(listed.out.split()) == "X3 off DISABLED X4 on DISABLED X5 off enabled M1 on DISABLED"
    assert plant.cli("discrete", "enable", "X3:2", "M1").out == (
        f"X3  on   enabled\nX4  off  enabled\nM1  on   enabled\n{where}"
    )
    states = plant.json("discrete", "discrete", "list", "Y10", "Y0-Y300", code=4)["discretes"]
    assert list(states)[:2] == ["Y10", "Y0"]


def test_a_force_that_does_not_take(plant: Plant) -> None:
    done = plant.cli("discrete", "set", "X0")
    assert done.code == 4
    assert "X0: no effect: an input follows its terminal; 'fatektool discrete disable X0'" in done.err
    document = plant.json("discrete", "discrete", "set", "Y0", "Y9000", "X1", code=4)
    assert document["discretes"]["Y0"] == {"on": True, "disabled": False}
    assert list(document["not_taken"]) == ["X1"]
    assert list(document["errors"]) == ["Y9000"]
    assert "refused to control" in document["errors"]["Y9000"]


@pytest.mark.parametrize(
    "words", [["set", "R0"], ["list", "WM0"], ["enable", "X0:hex"], ["flip", "X0"], ["list"]]
)
def test_discrete_takes_discretes(plant: Plant, monkeypatch: pytest.MonkeyPatch, words: list[str]) -> None:
    sent = recorded(monkeypatch)
    error_of(plant.cli("discrete", *words), 2)
    assert sent == []


def test_no_plc_named(cli: Cli) -> None:
    for words in (
        ["read", "R0"],
        ["write", "R0=1"],
        ["discrete", "list", "X0"],
        ["snapshot", "R0"],
        ["watch", "R0"],
    ):
        assert "no PLC named" in error_of(cli(*words), 2)


def test_a_dead_line(plant: Plant, monkeypatch: pytest.MonkeyPatch) -> None:
    cut_after(monkeypatch, 0)
    for words in (["read", "R0"], ["discrete", "set", "Y0"], ["snapshot", "R0"], ["watch", "R0"]):
        error_of(plant.cli(*words), 3)
