"""Bits as typed values and back: every type, its edges, and what it refuses."""

from __future__ import annotations

import math
import struct

import pytest
from hypothesis import given
from hypothesis import strategies as st

from fatektool.errors import DataError, UsageError
from fatektool.protocol.elements import KINDS
from fatektool.protocol.values import NUMBERS, Value, ValueType, decode, default_type, encode
from tests.rows import each

BOOL, U16, I16, U32, I32, F32, BCD, HEX, STR, STR_HIGH = ValueType
WHOLE = "expected a whole number such as 4261, -1 or 0x10A5"


def float_bits(number: float) -> int:
    return int.from_bytes(struct.pack(">f", number), "big")


def test_the_types() -> None:
    assert [kind.value for kind in ValueType] == [
        "bool",
        "u16",
        "i16",
        "u32",
        "i32",
        "f32",
        "bcd",
        "hex",
        "str",
        "strh",
    ]
    assert {kind: kind.bits for kind in ValueType} == {
        BOOL: 1, U16: 16, I16: 16, U32: 32, I32: 32, F32: 32, BCD: None, HEX: None,
        STR: None, STR_HIGH: None,
    }  # fmt: skip
    assert {U16, I16, U32, I32, F32, BCD} == NUMBERS


@each(
    ("symbols", "kind"),
    [
        ("X Y M S T C", BOOL), ("R D F RT RC", I16), ("DR DD DF DRT DRC", I32),
        ("WX WY WM WS WT WC", U16), ("DWX DWY DWM DWS DWT DWC", U32),
    ],
)  # fmt: skip
def test_the_type_when_none_is_asked_for(symbols: str, kind: ValueType) -> None:
    """A register is a signed number, a word of discretes a row of bits."""
    for symbol in symbols.split():
        assert default_type(KINDS[symbol]) is kind


# --- both ways ------------------------------------------------------------------------------------


@each(
    ("kind", "bits", "raw", "value"),
    [
        (BOOL, 1, 0, False),
        (BOOL, 1, 1, True),
        (U16, 16, 0, 0),
        (U16, 16, 0x10A5, 4261),
        (U16, 16, 0xFFFF, 65535),
        (I16, 16, 0, 0),
        (I16, 16, 0x7FFF, 32767),
        (I16, 16, 0x8000, -32768),
        (I16, 16, 0xFFFF, -1),
        (U32, 32, 0xFFFF_FFFF, 4294967295),
        (U32, 32, 0x8000_0000, 2147483648),
        (I32, 32, 0x7FFF_FFFF, 2147483647),
        (I32, 32, 0x8000_0000, -2147483648),
        (I32, 32, 0xFFFF_FFFF, -1),
        (I32, 32, 0x0000_8000, 32768),
        (F32, 32, 0x3FC0_0000, 1.5),
        (F32, 32, 0xC2F6_E979, -123.45600128173828),
        (F32, 32, 0x0000_0000, 0.0),
        (F32, 32, 0x0000_0001, 1.401298464324817e-45),  # the least there is
        (F32, 32, 0x7F7F_FFFF, 3.4028234663852886e38),  # the largest
        (BCD, 16, 0x0000, 0),
        (BCD, 16, 0x9999, 9999),
        (BCD, 16, 0x0042, 42),
        (BCD, 32, 0x1234_5678, 12345678),
        (BCD, 32, 0x9999_9999, 99999999),
        (HEX, 16, 0x00A5, "00A5"),
        (HEX, 16, 0xFFFF, "FFFF"),
        (HEX, 32, 0x0000_10A5, "000010A5"),
    ],
)
def test_both_ways(kind: ValueType, bits: int, raw: int, value: Value) -> None:
    found = decode(raw, kind, bits)
    assert found == value
    assert type(found) is type(value)
    assert encode(str(found), kind, bits) == raw


def test_minus_zero_keeps_its_sign() -> None:
    found = decode(0x8000_0000, F32, 32)
    assert isinstance(found, float)
    assert math.copysign(1, found) == -1
    assert encode(str(found), F32, 32) == 0x8000_0000


@given(st.integers(0, 0xFFFF), st.sampled_from([U16, I16, HEX]))
def test_any_16_bits_come_back(raw: int, kind: ValueType) -> None:
    assert encode(str(decode(raw, kind, 16)), kind, 16) == raw


@given(st.integers(0, 0xFFFF_FFFF), st.sampled_from([U32, I32, HEX]))
def test_any_32_bits_come_back(raw: int, kind: ValueType) -> None:
    assert encode(str(decode(raw, kind, 32)), kind, 32) == raw


@given(st.integers(0, 0xFFFF_FFFF))
def test_any_float_comes_back_or_is_none(raw: int) -> None:
    if raw >> 23 & 0xFF == 0xFF:
        with pytest.raises(DataError, match="is not a number as f32"):
            decode(raw, F32, 32)
    else:
        assert encode(repr(decode(raw, F32, 32)), F32, 32) == raw


@given(st.integers(0, 0xFFFF_FFFF), st.sampled_from([16, 32]))
def test_any_bits_are_bcd_or_none(raw: int, bits: int) -> None:
    raw &= (1 << bits) - 1
    digits = f"{raw:0{bits // 4}X}"
    if any(digit in "ABCDEF" for digit in digits):
        with pytest.raises(DataError, match=rf"^{digits} is not a BCD number$"):
            decode(raw, BCD, bits)
    else:
        assert encode(str(decode(raw, BCD, bits)), BCD, bits) == raw


@given(st.integers(-(1 << 40), 1 << 40), st.sampled_from([16, 32]))
def test_without_a_type_signed_and_unsigned_are_taken(number: int, bits: int) -> None:
    if -(1 << (bits - 1)) <= number < 1 << bits:
        assert encode(str(number), None, bits) == number % (1 << bits)
    else:
        with pytest.raises(UsageError, match=rf"expected -{1 << (bits - 1)} to {(1 << bits) - 1}"):
            encode(str(number), None, bits)


@given(st.floats(width=32, allow_nan=False, allow_infinity=False))
def test_any_number_as_a_float(number: float) -> None:
    assert encode(repr(number), F32, 32) == float_bits(number)


# --- bits that are no value -----------------------------------------------------------------------


@pytest.mark.parametrize("raw", [0x7F80_0000, 0xFF80_0000, 0x7FC0_0000, 0x7F80_0001, 0xFFFF_FFFF])
def test_bits_that_are_no_float(raw: int) -> None:
    with pytest.raises(DataError) as caught:
        decode(raw, F32, 32)
    assert caught.value.message == f"{raw:08X} is not a number as f32"


@pytest.mark.parametrize(("raw", "bits"), [(0x000A, 16), (0xA000, 16), (0x1234_567F, 32)])
def test_bits_that_are_no_bcd(raw: int, bits: int) -> None:
    with pytest.raises(DataError) as caught:
        decode(raw, BCD, bits)
    assert caught.value.message == f"{raw:0{bits // 4}X} is not a BCD number"


# --- as people write them -------------------------------------------------------------------------


@each("kind", [None, BOOL])
@each(
    ("text", "raw"),
    [("on", 1), ("ON", 1), ("true", 1), ("1", 1), ("off", 0), ("False", 0), ("0", 0), (" on ", 1)],
)
def test_discretes(text: str, raw: int, kind: ValueType | None) -> None:
    assert encode(text, kind, 1) == raw


@each("text", ["", "2", "yes", "o", "onn", "01", "-1", "1.0", "o n", "\u0661"])
def test_no_discrete(text: str) -> None:
    with pytest.raises(UsageError) as caught:
        encode(text, BOOL, 1)
    assert caught.value.message == f"value {text!r}: expected on or off, true or false, 1 or 0"


@each(
    ("text", "kind", "bits", "raw"),
    [
        ("4261", None, 16, 4261),
        (" 4261\t", None, 16, 4261),
        ("+4261", U16, 16, 4261),
        ("007", U16, 16, 7),
        ("-0", U16, 16, 0),
        ("-1", None, 16, 0xFFFF),
        ("65535", None, 16, 0xFFFF),
        ("-32768", None, 16, 0x8000),
        ("0x5555", None, 16, 0x5555),
        ("0X5a5A", U16, 16, 0x5A5A),
        ("-0x10", I16, 16, 0xFFF0),
        ("0b101", None, 16, 5),
        ("0B11", U16, 16, 3),
        ("-1", I32, 32, 0xFFFF_FFFF),
        ("5555", HEX, 16, 0x5555),
        ("0x5555", HEX, 16, 0x5555),
        ("0Xab", HEX, 16, 0xAB),
        ("0b11", HEX, 16, 0x0B11),  # digits of hex, all of them
        ("000000000000FFFF", HEX, 16, 0xFFFF),
        ("1e3", HEX, 16, 0x1E3),
        ("42", BCD, 16, 0x42),
        ("1", F32, 32, 0x3F80_0000),
        ("1.", F32, 32, 0x3F80_0000),
        (".5", F32, 32, 0x3F00_0000),
        ("+1.5", F32, 32, 0x3FC0_0000),
        (" -3e-2 ", F32, 32, 0xBCF5_C28F),
        ("1E2", F32, 32, 0x42C8_0000),
        ("1e-999", F32, 32, 0),
        ("3.4028235e38", F32, 32, 0x7F7F_FFFF),
        ("0.1", F32, 32, 0x3DCC_CCCD),
    ],
)
def test_numbers(text: str, kind: ValueType | None, bits: int, raw: int) -> None:
    assert encode(text, kind, bits) == raw


@each("kind", [None, U16, I16, BCD])
@each(
    "text",
    [
        "", "-", "+", "--1", "+-1", "1_0", "1 0", "1,0", "1.0", "1e3", "0x", "0b", "0b2", "0xG", "0x1_0",
        "0o7", "ten", "on", "\u0661", "\uff11", "\u00b2", "1\x00", "12h", "$12", "NaN", "0x-1",
    ],
)  # fmt: skip
def test_no_whole_number(text: str, kind: ValueType | None) -> None:
    with pytest.raises(UsageError) as caught:
        encode(text, kind, 16)
    assert caught.value.message == f"value {text!r}: {WHOLE}"


@each("text", ["", "0x", "-1", "+1", "0x-1", "0x0x12", "0x0X12", "12G4", "1_0", "1.5", "\uff11"])
def test_no_hex(text: str) -> None:
    with pytest.raises(UsageError) as caught:
        encode(text, HEX, 16)
    assert caught.value.message == f"value {text!r}: expected hex digits such as 10A5 or 0x10A5"


@pytest.mark.parametrize(
    "text",
    [
        "",
        ".",
        "-",
        "e5",
        "1e",
        "1e+",
        "1,5",
        "1.5.1",
        "nan",
        "inf",
        "-Infinity",
        "0x10",
        "1_0.0",
        "1 5",
        "\u0661.5",
    ],
)
def test_no_number(text: str) -> None:
    with pytest.raises(UsageError) as caught:
        encode(text, F32, 32)
    assert caught.value.message == f"value {text!r}: expected a number such as 1.5 or -3e-2"


@pytest.mark.parametrize(
    ("text", "kind", "bits", "expected"),
    [
        ("65536", None, 16, "expected -32768 to 65535 for 16 bits"),
        ("-32769", None, 16, "expected -32768 to 65535 for 16 bits"),
        ("4294967296", None, 32, "expected -2147483648 to 4294967295 for 32 bits"),
        ("65536", U16, 16, "expected 0 to 65535 for u16"),
        ("-1", U16, 16, "expected 0 to 65535 for u16"),
        ("32768", I16, 16, "expected -32768 to 32767 for i16"),
        ("0x8000", I16, 16, "expected -32768 to 32767 for i16"),
        ("-1", U32, 32, "expected 0 to 4294967295 for u32"),
        ("2147483648", I32, 32, "expected -2147483648 to 2147483647 for i32"),
        ("10000", BCD, 16, "expected 0 to 9999 for bcd"),
        ("-1", BCD, 16, "expected 0 to 9999 for bcd"),
        ("100000000", BCD, 32, "expected 0 to 99999999 for bcd"),
        ("10000", HEX, 16, "expected 0 to 65535 for hex"),
        ("100000000", HEX, 32, "expected 0 to 4294967295 for hex"),
    ],
)
def test_out_of_range(text: str, kind: ValueType | None, bits: int, expected: str) -> None:
    with pytest.raises(UsageError) as caught:
        encode(text, kind, bits)
    assert caught.value.message == f"value {text}: {expected}"


@pytest.mark.parametrize("text", ["3.4028236e38", "1e39", "-1e39", "1e400", "-1e400", "9" * 400])
def test_too_large_for_a_float(text: str) -> None:
    """Not infinity, which no one asked for."""
    with pytest.raises(UsageError, match="too large for f32"):
        encode(text, F32, 32)


@each("kind", [None, U32, I32, BCD, HEX, F32])
@each("text", ["9" * 5000, "0x" + "F" * 5000, "-" + "9" * 5000, "1" * 999])
def test_thousands_of_digits(text: str, kind: ValueType | None) -> None:
    with pytest.raises(UsageError, match=r"^value "):
        encode(text, kind, 32)


@pytest.mark.parametrize("text", ["9" * 5000, "-" + "9" * 5000, "0x" + "0" * 5000])
def test_a_message_does_not_repeat_thousands_of_digits(text: str) -> None:
    with pytest.raises(UsageError) as caught:
        encode(text, None, 32)
    assert caught.value.message == f"value {text[:20]}…: expected -2147483648 to 4294967295"


@given(st.text(max_size=12), st.sampled_from([None, *ValueType]), st.sampled_from([1, 16, 32]))
def test_any_text_is_a_value_or_refused(text: str, kind: ValueType | None, bits: int) -> None:
    if kind is F32:
        bits = 32
    try:
        raw = encode(text, kind, bits)
    except UsageError:
        return
    assert 0 <= raw < 1 << bits
