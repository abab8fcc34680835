"""Elements: the table of the paper's section 4.1, row by row, and how people write them."""

from __future__ import annotations

import re

import pytest
from hypothesis import given
from hypothesis import strategies as st

from fatektool.errors import UsageError
from fatektool.protocol.elements import KINDS, Element
from fatektool.protocol.fatek.facon.text import TEXT
from tests.protocol.strategies import elements

Row = tuple[str, int, int, int, bytes, bytes]

# kind, bits, next one, multiple of, first and last as the paper writes them
TABLE: list[Row] = [
    ("X", 1, 1, 1, b"X0000", b"X9999"),
    ("Y", 1, 1, 1, b"Y0000", b"Y9999"),
    ("M", 1, 1, 1, b"M0000", b"M9999"),
    ("S", 1, 1, 1, b"S0000", b"S9999"),
    ("T", 1, 1, 1, b"T0000", b"T9999"),
    ("C", 1, 1, 1, b"C0000", b"C9999"),
    ("WX", 16, 16, 8, b"WX0000", b"WX9984"),
    ("WY", 16, 16, 8, b"WY0000", b"WY9984"),
    ("WM", 16, 16, 8, b"WM0000", b"WM9984"),
    ("WS", 16, 16, 8, b"WS0000", b"WS9984"),
    ("WT", 16, 16, 8, b"WT0000", b"WT9984"),
    ("WC", 16, 16, 8, b"WC0000", b"WC9984"),
    ("DWX", 32, 32, 8, b"DWX0000", b"DWX9968"),
    ("DWY", 32, 32, 8, b"DWY0000", b"DWY9968"),
    ("DWM", 32, 32, 8, b"DWM0000", b"DWM9968"),
    ("DWS", 32, 32, 8, b"DWS0000", b"DWS9968"),
    ("DWT", 32, 32, 8, b"DWT0000", b"DWT9968"),
    ("DWC", 32, 32, 8, b"DWC0000", b"DWC9968"),
    ("RT", 16, 1, 1, b"RT0000", b"RT9999"),
    ("RC", 16, 1, 1, b"RC0000", b"RC9999"),
    ("R", 16, 1, 1, b"R00000", b"R65535"),
    ("D", 16, 1, 1, b"D00000", b"D65535"),
    ("DRT", 32, 2, 1, b"DRT0000", b"DRT9998"),
    ("DRC", 32, 2, 1, b"DRC0000", b"DRC9998"),
    ("DR", 32, 2, 1, b"DR00000", b"DR65534"),
    ("DD", 32, 2, 1, b"DD00000", b"DD65534"),
]
rows = pytest.mark.parametrize("row", TABLE, ids=[row[0] for row in TABLE])


def test_the_table_is_whole() -> None:
    assert set(KINDS) == {row[0] for row in TABLE} | {"F", "DF"}


def test_file_registers() -> None:
    kind = KINDS["F"]
    assert (kind.bits, kind.stride, kind.step, kind.words, kind.last) == (16, 1, 1, 1, 65535)
    kind = KINDS["DF"]
    assert (kind.bits, kind.stride, kind.step, kind.words, kind.last) == (32, 2, 1, 2, 65534)
    assert str(Element.parse("df00012").after(1)) == "DF14"


@rows
def test_kind(row: Row) -> None:
    symbol, bits, stride, step, first, last = row
    kind = KINDS[symbol]
    assert (kind.symbol, kind.bits, kind.stride, kind.step) == (symbol, bits, stride, step)
    assert kind.words == {1: 1, 16: 1, 32: 2}[bits]
    assert len(first) == {1: 5, 16: 6, 32: 7}[bits]
    for written in (first, last):
        element = Element.parse(written.decode())
        assert TEXT.element(element) == written
        assert TEXT.take_element(written, 0) == (element, len(written))
    assert Element(symbol, 0).after(1) == Element(symbol, stride)


@rows
def test_past_the_last(row: Row) -> None:
    symbol, _, _, step, _, last = row
    end = int(last[len(symbol) :])
    for address in (end + step, -step):
        with pytest.raises(UsageError, match=rf"expected 0 to {end}, got {address}"):
            Element(symbol, address)


@pytest.mark.parametrize("symbol", [row[0] for row in TABLE if row[3] == 8])
def test_alignment(symbol: str) -> None:
    for address in range(9, 16):
        with pytest.raises(UsageError) as caught:
            Element(symbol, address)
        assert f"multiple of 8, got {address}" in caught.value.message
        assert caught.value.hint == f"{symbol}8 contains {symbol[-1]}{address}"
        assert caught.value.details == {"element": f"{symbol}{address}"}
    assert Element(symbol, 16).address == 16


@pytest.mark.parametrize(
    ("text", "symbol", "address"),
    [
        ("R12", "R", 12),
        ("r12", "R", 12),
        ("R00012", "R", 12),
        ("x0016", "X", 16),
        ("X00016", "X", 16),
        ("dwm0", "DWM", 0),
        ("Dwm0000", "DWM", 0),
        (" DR2 ", "DR", 2),
        ("R000012", "R", 12),
        ("f65535", "F", 65535),
    ],
)
def test_as_people_write_them(text: str, symbol: str, address: int) -> None:
    element = Element.parse(text)
    assert element == Element(symbol, address)
    assert str(element) == f"{symbol}{address}"


@pytest.mark.parametrize(
    "text",
    [
        "",
        "R",
        "12",
        "R-1",
        "R+1",
        "R1_0",
        "R 1",
        "R1.0",
        "R0x1",
        "R1\x00",
        "R\u0661",
        "\u017f1",
        "Rone",
        "WXYZ1",
        "R1R2",
    ],
)
def test_no_element(text: str) -> None:
    with pytest.raises(UsageError, match="expected symbol and decimal address such as R12") as caught:
        Element.parse(text)
    assert repr(text) in caught.value.message


@pytest.mark.parametrize("text", ["Q1", "W1", "DX0", "DM0", "RX0", "DWR0", "L0", "AAA0"])
def test_unknown_kind(text: str) -> None:
    with pytest.raises(UsageError, match="unknown element kind") as caught:
        Element.parse(text)
    for symbol in KINDS:
        assert re.search(rf"\b{symbol}\b", caught.value.message)


@pytest.mark.parametrize("text", ["R65536", "R100000", "X10000", "DR65535", "R4294967296"])
def test_an_address_out_of_range_is_called_so(text: str) -> None:
    with pytest.raises(UsageError, match="address out of range: expected 0 to"):
        Element.parse(text)


@pytest.mark.parametrize(
    ("first", "count", "last"),
    [
        ("X0", 255, "X255"),
        ("WY8", 1, "WY24"),
        ("WX0", 63, "WX1008"),
        ("DWM0", 2, "DWM64"),
        ("R12", 2, "R14"),
        ("DR0", 1, "DR2"),
        ("DR1", 31, "DR63"),
        ("RT0", 0, "RT0"),
        ("WX9968", 1, "WX9984"),
    ],
)
def test_after(first: str, count: int, last: str) -> None:
    assert str(Element.parse(first).after(count)) == last


@pytest.mark.parametrize("last", ["X9999", "WX9976", "WX9984", "DWM9944", "R65535", "DR65533"])
def test_nothing_after_the_last(last: str) -> None:
    with pytest.raises(UsageError, match="out of range"):
        Element.parse(last).after(1)


def test_elements_sort_by_kind_and_address() -> None:
    mixed = [Element("R", 12), Element("D", 5), Element("R", 2)]
    assert [str(element) for element in sorted(mixed)] == ["D5", "R2", "R12"]
    assert len({Element("R", 2), Element.parse("r2")}) == 1


@given(elements(), st.integers(0, 3), st.booleans())
def test_round_trip(element: Element, zeros: int, lower: bool) -> None:
    assert Element.parse(str(element)) == element
    assert Element.parse(TEXT.element(element).decode()) == element
    text = f"{element.symbol}{'0' * zeros}{element.address}"
    assert Element.parse(text.lower() if lower else text) == element
    assert TEXT.take_element(b"07" + TEXT.element(element) + b"ABCD", 2) == (
        element,
        2 + len(TEXT.element(element)),
    )


@given(st.text(max_size=12))
def test_any_text_is_an_element_or_refused(text: str) -> None:
    try:
        element = Element.parse(text)
    except UsageError:
        return
    assert Element.parse(str(element)) == element
