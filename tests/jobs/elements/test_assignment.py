"""What a user wants written: every form, and every refusal with what to do."""

from __future__ import annotations

import pytest
from hypothesis import given
from hypothesis import strategies as st

from fatektool.errors import UsageError
from fatektool.jobs.elements.assignment import parse_assignment, parse_assignments


def shown(text: str) -> list[str]:
    return [f"{item.element} {value:X}" for item, value in parse_assignment(text)]


@pytest.mark.parametrize(
    ("text", "written"),
    [
        ("R12=4261", ["R12 10A5"]),
        (" r12 = 4261 ", ["R12 10A5"]),
        ("R12=-1", ["R12 FFFF"]),  # without a type both are taken
        ("R12=65535", ["R12 FFFF"]),
        ("R12=0x5555", ["R12 5555"]),
        ("R12:i16=-1", ["R12 FFFF"]),
        ("R12:hex=5555", ["R12 5555"]),
        ("R12:BCD=42", ["R12 42"]),
        ("R12:bcd =42", ["R12 42"]),
        ("Y0=on", ["Y0 1"]),
        ("Y0=OFF", ["Y0 0"]),
        ("Y0:bool=true", ["Y0 1"]),
        ("WY8=0xFF", ["WY8 FF"]),
        ("DWM0=-1", ["DWM0 FFFFFFFF"]),
        ("DR2=4294967295", ["DR2 FFFFFFFF"]),
        ("D4:f32=1.5", ["DD4 3FC00000"]),
        ("D4:f32 = 1.5", ["DD4 3FC00000"]),
        ("D4:2:f32=1.5,-2", ["DD4 3FC00000", "DD6 C0000000"]),
        ("R0:3=1,2,3", ["R0 1", "R1 2", "R2 3"]),
        ("R0:3= 1, 2 ,3 ", ["R0 1", "R1 2", "R2 3"]),
        ("R0-R2=7", ["R0 7", "R1 7", "R2 7"]),
        ("R0-R1=-1,65535", ["R0 FFFF", "R1 FFFF"]),
        ("M0:4=on,off,1,0", ["M0 1", "M1 0", "M2 1", "M3 0"]),
    ],
)
def test_forms(text: str, written: list[str]) -> None:
    assert shown(text) == written


@pytest.mark.parametrize("text", ["", "R12", "R12=", "R12= ", "R12:3"])
def test_no_assignment(text: str) -> None:
    with pytest.raises(UsageError) as caught:
        parse_assignment(text)
    assert caught.value.message == f"{text!r}: expected ELEMENT=VALUE, such as R12=4261, Y0=on or D4:f32=1.5"


@pytest.mark.parametrize(
    ("text", "expected"),
    [
        ("R0:3=1,2", "'R0:3=1,2': expected 1 value or 3, got 2"),
        ("R0:3=1,2,3,4", "'R0:3=1,2,3,4': expected 1 value or 3, got 4"),
        ("R0=1,2", "'R0=1,2': expected 1 value, got 2"),
        ("R0=1,", "'R0=1,': expected 1 value, got 2"),
        ("R0:2=1,", "R1: value '': expected a whole number such as 4261, -1 or 0x10A5"),
        ("R0==1", "R0: value '=1': expected a whole number such as 4261, -1 or 0x10A5"),
        ("R0=1_0", "R0: value '1_0': expected a whole number such as 4261, -1 or 0x10A5"),
        ("R0=1.5", "R0: value '1.5': expected a whole number such as 4261, -1 or 0x10A5"),
        ("R0=65536", "R0: value 65536: expected -32768 to 65535 for 16 bits"),
        ("R0:u16=-1", "R0: value -1: expected 0 to 65535 for u16"),
        ("R0:U16 =-1", "R0: value -1: expected 0 to 65535 for u16"),
        ("R0:2:i16=1,40000", "R1: value 40000: expected -32768 to 32767 for i16"),
        ("R0:hex=xyz", "R0: value 'xyz': expected hex digits such as 10A5 or 0x10A5"),
        ("D4:f32=nan", "D4: value 'nan': expected a number such as 1.5 or -3e-2"),
        ("D4:f32=1e39", "D4: value 1e39: too large for f32"),
        ("Y0=2", "Y0: value '2': expected on or off, true or false, 1 or 0"),
        ("Y0:bcd=1", "Y0: bcd does not fit 1 bit: expected bool"),
        ("Q0=1", "unknown element kind 'Q'"),
        ("=1", "'': expected an element"),
        ("WM4=1", "element WM4: expected an address that is a multiple of 8"),
        ("R0:float=1", "'R0:float': unknown type 'float': expected one of bool, u16"),
    ],
)
def test_refusals(text: str, expected: str) -> None:
    with pytest.raises(UsageError) as caught:
        parse_assignment(text)
    assert caught.value.message.startswith(expected)


def test_a_bad_value_names_its_element() -> None:
    with pytest.raises(UsageError) as caught:
        parse_assignment("R0:2=1,x")
    assert caught.value.details == {"element": "R1"}


@given(st.text(max_size=16))
def test_any_text_is_an_assignment_or_refused(text: str) -> None:
    try:
        found = parse_assignment(text)
    except UsageError:
        return
    assert all(0 <= value < 1 << item.element.kind.bits for item, value in found)


# --- several --------------------------------------------------------------------------------------


def test_several() -> None:
    found = parse_assignments(["R0=1", "Y0=on", "D0:f32=1"])
    assert [(str(item.element), value) for item, value in found] == [
        ("R0", 1),
        ("Y0", 1),
        ("DD0", 0x3F80_0000),
    ]
    assert parse_assignments([]) == []


@pytest.mark.parametrize(
    ("texts", "both"),
    [
        (["R0=1", "R0=1"], "R0 and R0"),
        (["R0:3=1", "R2=5"], "R2 and R2"),
        (["DR0=1", "R1=5"], "DR0 and R1"),
        (["M8=on", "WM0=5"], "M8 and WM0"),
        (["RC0:u32=1", "RC1=5"], "DRC0 and RC1"),
        (["D0:f32=1", "D1:f32=1"], "DD0 and DD1"),
    ],
)
def test_targets_that_overlap(texts: list[str], both: str) -> None:
    with pytest.raises(UsageError) as caught:
        parse_assignments(texts)
    assert caught.value.message == f"{both} overlap: expected each discrete and register once"
