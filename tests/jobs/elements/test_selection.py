"""What a user asks for in elements: every form, and every refusal with what to do."""

from __future__ import annotations

import pytest
from hypothesis import given
from hypothesis import strategies as st

from fatektool.errors import UsageError
from fatektool.jobs.elements.selection import Item, overlapping, parse_item, parse_items
from fatektool.protocol.elements import KINDS, Element
from fatektool.protocol.values import ValueType
from tests.rows import each


def shown(items: list[Item]) -> list[str]:
    return [f"{item.key} {item.element} {item.type.value}" for item in items]


@each(
    ("text", "items"),
    [
        ("R12", ["R12 R12 i16"]),
        ("r0012", ["R12 R12 i16"]),
        (" X16 ", ["X16 X16 bool"]),
        ("DR2", ["DR2 DR2 i32"]),
        ("DWM0", ["DWM0 DWM0 u32"]),
        ("WM8", ["WM8 WM8 u16"]),
        ("DRC3", ["DRC3 DRC3 i32"]),
        ("R0-R2", ["R0 R0 i16", "R1 R1 i16", "R2 R2 i16"]),
        ("R0-2", ["R0 R0 i16", "R1 R1 i16", "R2 R2 i16"]),
        ("r0-R002", ["R0 R0 i16", "R1 R1 i16", "R2 R2 i16"]),
        ("R5-R5", ["R5 R5 i16"]),
        ("R5:1", ["R5 R5 i16"]),
        ("R5:0002", ["R5 R5 i16", "R6 R6 i16"]),
        ("X8:3", ["X8 X8 bool", "X9 X9 bool", "X10 X10 bool"]),
        ("WY8:2", ["WY8 WY8 u16", "WY24 WY24 u16"]),
        ("WY8-WY24", ["WY8 WY8 u16", "WY24 WY24 u16"]),
        ("DWM0:2", ["DWM0 DWM0 u32", "DWM32 DWM32 u32"]),
        ("DR0:2", ["DR0 DR0 i32", "DR2 DR2 i32"]),
        ("DRT1-DRT5", ["DRT1 DRT1 i32", "DRT3 DRT3 i32", "DRT5 DRT5 i32"]),
        ("R12:i16", ["R12 R12 i16"]),
        ("R12:I16", ["R12 R12 i16"]),
        ("R12:2:i16", ["R12 R12 i16", "R13 R13 i16"]),
        ("R12-R13:bcd", ["R12 R12 bcd", "R13 R13 bcd"]),
        ("R12:hex", ["R12 R12 hex"]),
        ("DR2:hex", ["DR2 DR2 hex"]),
        ("DR2:bcd", ["DR2 DR2 bcd"]),
        ("DR2:f32", ["DR2 DR2 f32"]),
        ("X0:bool", ["X0 X0 bool"]),
        # A type of 32 bits over elements of 16 takes two for each.
        ("D4:f32", ["D4 DD4 f32"]),
        ("D4:2:f32", ["D4 DD4 f32", "D6 DD6 f32"]),
        ("D4-D8:i32", ["D4 DD4 i32", "D6 DD6 i32", "D8 DD8 i32"]),
        ("R1:u32", ["R1 DR1 u32"]),
        ("F0:u32", ["F0 DF0 u32"]),
        ("RT7:u32", ["RT7 DRT7 u32"]),
        ("RC200:i32", ["RC200 DRC200 i32"]),
        ("WM8:u32", ["WM8 DWM8 u32"]),
        ("WX0:2:u32", ["WX0 DWX0 u32", "WX32 DWX32 u32"]),
    ],
)
def test_forms(text: str, items: list[str]) -> None:
    assert shown(parse_item(text)) == items


def test_the_largest() -> None:
    assert len(parse_item("R0-R65535")) == 65536
    assert parse_item("DR65534")[0].element == Element("DR", 65534)
    assert len(parse_item("M0-M9999")) == 10000


@pytest.mark.parametrize(
    "text",
    [
        "", " ", "R", "12", "R-1", "R1.5", "R1,R2", "R1 R2", "R0..R9", "R0-", "R0:", "-R5", "R0-R1-R2",
        "R0::u16",
        "R0:u16:3", "R0-R5:", "R1_0", "R\u0661", "R0:\uff12", "R0:u 16", "R0 - R5", "R0=5", "R0:3:i16:x",
    ],
)  # fmt: skip
def test_no_selection(text: str) -> None:
    with pytest.raises(UsageError) as caught:
        parse_item(text)
    assert caught.value.message == (
        f"{text!r}: expected an element, optionally with a range or count and a type, "
        "such as R12, R0-R99, X0:16, D4:f32"
    )


@pytest.mark.parametrize(
    ("text", "expected"),
    [
        ("Q5", "unknown element kind 'Q': expected one of X "),
        ("R0-Q5", "unknown element kind 'Q': expected one of X "),
        ("R65536", "element R65536: address out of range: expected 0 to 65535, got 65536"),
        ("R65534:4", "element R65536: address out of range: expected 0 to 65535, got 65536"),
        ("R0-R70000", "element R70000: address out of range: expected 0 to 65535, got 70000"),
        ("R65535:u32", "element DR65535: address out of range: expected 0 to 65534, got 65535"),
        ("WM9984:f32", "element DWM9984: address out of range: expected 0 to 9968, got 9984"),
        ("WM4", "element WM4: expected an address that is a multiple of 8, got 4; WM0 contains M4"),
        (
            "R0:float",
            "'R0:float': unknown type 'float': expected one of bool, u16, i16, u32, i32, f32, bcd, hex",
        ),
        (
            "R0-R9:16",
            "'R0-R9:16': unknown type '16': expected one of bool, u16, i16, u32, i32, f32, bcd, hex",
        ),
        ("R0:0", "'R0:0': count: expected 1 to 100000, got 0"),
        ("R0:100001", "'R0:100001': count: expected 1 to 100000, got 100001"),
        ("R0:12345678901", "'R0:12345678901': count: expected 1 to 100000, got 12345678901"),
        ("R9-R0", "'R9-R0': expected a range of one kind, from the lower to the higher address"),
        ("R0-D9", "'R0-D9': expected a range of one kind, from the lower to the higher address"),
        ("R0-DR8", "'R0-DR8': expected a range of one kind, from the lower to the higher address"),
        ("DR0-DR3", "'DR0-DR3': DR3 is not reached from DR0 in steps of 2; the nearest below is DR2"),
        ("WM0-WM24", "'WM0-WM24': WM24 is not reached from WM0 in steps of 16; the nearest below is WM16"),
        ("D0-D3:f32", "'D0-D3:f32': D3 is not reached from D0 in steps of 2; the nearest below is D2"),
        ("X0:u16", "X0: u16 does not fit 1 bit: expected bool"),
        ("X0:f32", "X0: f32 does not fit 1 bit: expected bool"),
        ("M0:bcd", "M0: bcd does not fit 1 bit: expected bool"),
        ("M0:hex", "M0: hex does not fit 1 bit: expected bool"),
        ("R0:bool", "R0: bool does not fit 16 bits: expected u16, i16, bcd, hex"),
        ("DR0:i16", "DR0: i16 does not fit 32 bits: expected u32, i32, f32, bcd, hex"),
    ],
)
def test_refusals(text: str, expected: str) -> None:
    with pytest.raises(UsageError) as caught:
        parse_item(text)
    assert str(caught.value).startswith(expected)


def test_a_count_too_long_to_read_is_refused() -> None:
    with pytest.raises(UsageError, match="count: expected 1 to 100000"):
        parse_item("R0:" + "9" * 5000)


@given(st.text(max_size=14))
def test_any_text_is_a_selection_or_refused(text: str) -> None:
    try:
        items = parse_item(text)
    except UsageError:
        return
    assert items
    assert len({item.key for item in items}) == len(items)


@given(st.sampled_from(sorted(KINDS)), st.integers(0, 50), st.integers(1, 40))
def test_range_and_count_are_two_ways_to_say_one_thing(symbol: str, place: int, count: int) -> None:
    kind = KINDS[symbol]
    first = Element(symbol, place * kind.step)
    last = first.after(count - 1)
    by_count = parse_item(f"{first}:{count}")
    assert parse_item(f"{first}-{last}") == by_count
    assert [item.element for item in by_count] == [first.after(n) for n in range(count)]


# --- several --------------------------------------------------------------------------------------


def test_the_same_twice_is_one() -> None:
    assert shown(parse_items(["R1", "R0-R2", "r1"])) == ["R1 R1 i16", "R0 R0 i16", "R2 R2 i16"]
    assert parse_items([]) == []


def test_one_element_as_two_types() -> None:
    with pytest.raises(UsageError) as caught:
        parse_items(["D4:f32", "D4"])
    assert caught.value.message == "D4 is selected twice, as f32 and i16"


def test_elements_that_share_registers_may_be_read() -> None:
    assert shown(parse_items(["R0", "DR0", "R1:f32"])) == ["R0 R0 i16", "DR0 DR0 i32", "R1 DR1 f32"]


def test_too_many() -> None:
    with pytest.raises(UsageError) as caught:
        parse_items(["R0-R65535", "D0-D65535"])
    assert caught.value.message == "expected at most 100000 elements"


# --- what overlaps --------------------------------------------------------------------------------


def elements(text: str) -> list[Element]:
    return [Element.parse(word) for word in text.split()]


@pytest.mark.parametrize(
    "text",
    [
        "", "R0", "R0 R1", "R0 D0 F0", "DR0 R2", "M0 WM8", "WM0 WM16", "DWM0 DWM32", "X0 Y0",
        "RC0 C0 WC8", "RC0 RT0", "DRC0 DRC2", "RC0 DRC1",
    ],
)  # fmt: skip
def test_nothing_overlaps(text: str) -> None:
    assert overlapping(elements(text)) is None


@pytest.mark.parametrize(
    ("text", "both"),
    [
        ("R0 R0", "R0 R0"),
        ("R1 R5 DR0", "R1 DR0"),
        ("DR0 DR1", "DR0 DR1"),
        ("M3 WM0", "M3 WM0"),
        ("WM0 WM8", "WM0 WM8"),
        ("DWM8 M39", "DWM8 M39"),
        ("DRC0 DRC1", "DRC0 DRC1"),  # two single ones each
        ("RC1 DRC0", "RC1 DRC0"),
        ("DRT4 RT5", "DRT4 RT5"),
    ],
)
def test_what_overlaps(text: str, both: str) -> None:
    assert overlapping(elements(text)) == tuple(elements(both))


def test_one_object_twice_overlaps_too() -> None:
    element = Element("R", 0)
    assert overlapping([element, element]) == (element, element)


def test_items_are_plain_values() -> None:
    assert parse_item("D4:f32") == [Item("D4", Element("DD", 4), ValueType.F32)]
