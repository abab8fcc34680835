"""The map of the paper, number by number, both ways; the user's own; and what it lacks."""

from __future__ import annotations

import pytest
from hypothesis import given
from hypothesis import strategies as st

from fatektool.errors import DataError, UsageError
from fatektool.protocol.elements import Element
from fatektool.protocol.modbus.map import (
    STANDARD,
    ModbusArea,
    ModbusMap,
    Reference,
    map_of_registers,
    parse_map,
)

PAPER = [  # first and last of each range, five digits and six
    ("00001", "000001", "Y0"),
    ("00256", "000256", "Y255"),
    ("01001", "001001", "X0"),
    ("01256", "001256", "X255"),
    ("02001", "002001", "M0"),
    ("04002", "004002", "M2001"),
    ("03913", "003913", "M1912"),
    ("06001", "006001", "S0"),
    ("07000", "007000", "S999"),
    ("09001", "009001", "T0"),
    ("09256", "009256", "T255"),
    ("09501", "009501", "C0"),
    ("09756", "009756", "C255"),
    ("40001", "400001", "R0"),
    ("44168", "404168", "R4167"),
    ("43841", "403841", "R3840"),
    ("43969", "403969", "R3968"),
    ("45001", "405001", "R5000"),
    ("45999", "405999", "R5998"),
    ("46001", "406001", "D0"),
    ("48999", "408999", "D2998"),
    ("49001", "409001", "RT0"),
    ("49256", "409256", "RT255"),
    ("49501", "409501", "RC0"),
    ("49700", "409700", "RC199"),
    ("49701", "409701", "DRC200"),
]


@pytest.mark.parametrize(("five", "six", "name"), PAPER)
def test_the_table_of_the_paper(five: str, six: str, name: str) -> None:
    element = Element.parse(name)
    for text in (five, six):
        reference = Reference.parse(text)
        assert (str(reference), reference.five_digits) == (six, five)
        found = STANDARD.element_at(reference)
        assert found is not None
        assert found.element == element
    place = STANDARD.place(element)
    assert Reference(place.area, place.offset) == Reference.parse(six)
    assert place.offset == int(six[1:]) - 1


def test_counters_of_32_bits_take_two_registers_each() -> None:
    assert STANDARD.place(Element("DRC", 200)).count == 2
    last = STANDARD.place(Element("DRC", 255))
    assert (last.offset + 1, last.offset + last.count) == (9811, 9812)
    halves = [STANDARD.element_at(Reference.parse(text)) for text in ("409811", "409812")]
    assert [(str(found.element), found.half) for found in halves if found] == [
        ("DRC255", "low word"),
        ("DRC255", "high word"),
    ]


@pytest.mark.parametrize(
    "text",
    ["000257", "001257", "004003", "005000", "010001", "100001", "300001", "404169", "406000", "409813"],
)
def test_references_of_nothing(text: str) -> None:
    assert STANDARD.element_at(Reference.parse(text)) is None


@pytest.mark.parametrize(
    "text", ["0", "4001", "200001", "500001", "400000", "465537", "4000001", "R1", "", "40 001"]
)
def test_what_is_no_reference(text: str) -> None:
    with pytest.raises(UsageError, match="is not a Modbus reference: expected 0, 1, 3 or 4"):
        Reference.parse(text)


@given(st.data())
def test_there_and_back(data: st.DataObject) -> None:
    found = data.draw(st.sampled_from(STANDARD.stretches))
    element = Element(found.symbol, found.first + data.draw(st.integers(0, found.count - 1)))
    place = STANDARD.place(element)
    assert place.count == found.width
    for half in range(place.count):
        back = STANDARD.element_at(Reference(place.area, place.offset + half))
        assert back is not None
        assert back.element == element


@pytest.mark.parametrize(
    ("name", "reference", "count"),
    [("DR12", "400013", 2), ("WM8", "002009", 16), ("DWY0", "000001", 32), ("DRT3", "409004", 2)],
)
def test_wide_elements_take_their_parts(name: str, reference: str, count: int) -> None:
    place = STANDARD.place(Element.parse(name))
    assert (str(Reference(place.area, place.offset)), place.count) == (reference, count)


@pytest.mark.parametrize(
    ("name", "said"),
    [
        ("F0", "F0 has no Modbus reference: the standard map has Y0-Y255 X0-X255"),
        ("R4168", "R4168 has no Modbus reference"),
        ("DR4167", "DR4167 has no Modbus reference"),
        ("D2999", "D2999 has no Modbus reference"),
        ("M2002", "M2002 has no Modbus reference"),
        ("WM1992", "WM1992 has no Modbus reference"),
        (
            "RC200",
            "RC200 has no Modbus reference: C0 to C199 have 16 bits, C200 to C255 have 32; use DRC200",
        ),
        ("DRC199", "C200 to C255 have 32; use RC199"),
    ],
)
def test_elements_without_a_reference(name: str, said: str) -> None:
    with pytest.raises(UsageError) as caught:
        STANDARD.place(Element.parse(name))
    assert said in str(caught.value)


def test_a_run_lies_within_one_stretch() -> None:
    assert STANDARD.place(Element("R", 4100), 68).count == 68
    with pytest.raises(UsageError, match="R4168 has no Modbus reference"):
        STANDARD.place(Element("R", 4100), 69)
    assert STANDARD.place(Element("DRC", 200), 3).count == 10  # C201 and C203 between them
    with pytest.raises(UsageError, match="have no consecutive Modbus references"):
        STANDARD.place(Element("DRC", 200), 3, writes=True)


# --- the user's own -------------------------------------------------------------------------------

EXAMPLE = [0xA55A, 0, 1000, 100, 10, 1100, 50, 50, 1000, 10, 100, 2000, 200]
"""R3968 to R3980 in the example of the paper."""


def at(modbus_map: ModbusMap, text: str) -> str | None:
    found = modbus_map.element_at(Reference.parse(text))
    return None if found is None else str(found.element)


def test_the_example_of_the_paper() -> None:
    own = map_of_registers(EXAMPLE)
    assert own.name == "custom"
    assert [at(own, text) for text in ("000001", "000100", "000101")] == ["M1000", "M1099", None]
    assert [at(own, text) for text in ("100010", "100011", "100060", "100061")] == [
        None,
        "M1100",
        "M1149",
        None,
    ]
    assert [at(own, text) for text in ("300051", "300060", "300061")] == ["R1000", "R1009", None]
    assert [at(own, text) for text in ("400100", "400101", "400300", "400301")] == [
        None,
        "R2000",
        "R2199",
        None,
    ]
    assert at(own, "403969") is None  # R3968 itself is gone
    text = "M1000-M1099=000001,M1100-M1149=100011,R1000-1009=300051,r2000-r2199=400101"
    assert parse_map(text).stretches == own.stretches[:2] + own.stretches[2:]


def test_without_a55a_inputs_stand_beside_the_standard_map() -> None:
    own = map_of_registers([0, *EXAMPLE[1:]])
    assert own.name == "standard"
    assert at(own, "000001") == "Y0"
    assert at(own, "400101") == "R100"
    assert at(own, "100011") == "M1100"
    assert at(own, "300051") == "R1000"
    assert parse_map("M1100-M1149=100011").name == "standard"


def test_groups_out_of_their_range_map_nothing() -> None:
    own = map_of_registers([0xA55A, 0, 2002, 1, 0, 0, 0, 0, 3840, 1, 0, 0, 3841])
    assert own.stretches == ()
    assert own.listed == "none"
    at_the_end = map_of_registers([0xA55A, 65530, 0, 100, 0, 0, 0, 0, 0, 0, 0, 0, 0])
    assert [(each.offset, each.count) for each in at_the_end.stretches] == [(65530, 6)]
    with pytest.raises(DataError, match="expected 13 registers, got 12"):
        map_of_registers(EXAMPLE[:-1])


def test_what_can_be_read_only() -> None:
    own = map_of_registers(EXAMPLE)
    assert own.place(Element("M", 1100)).area is ModbusArea.DISCRETE_INPUT
    with pytest.raises(UsageError, match="M1100 can be read over Modbus, but not written"):
        own.place(Element("M", 1100), writes=True)
    both = parse_map("R0-R9=300001,R0-R4=400001")
    assert both.place(Element("R", 3)).area is ModbusArea.HOLDING_REGISTER
    assert both.place(Element("R", 7)).area is ModbusArea.INPUT_REGISTER


@pytest.mark.parametrize(
    ("text", "said"),
    [
        ("M0-M9", "expected ELEMENT-ELEMENT=REFERENCE"),
        ("M0-R9=000001", "expected ELEMENT-ELEMENT=REFERENCE"),
        ("R0-R9=000001", "coil: expected 1 to 2001 of M, from M0 to M2001 on"),
        ("M0-M9=400001", "holding register: expected 1 to 3840 of R"),
        ("M9-M0=000001", "coil: expected 1 to"),
        ("M2002=000001", "coil: expected 1 to"),
        ("M0-M2001=000001", "coil: expected 1 to"),
        ("M0-M9=200001", "is not a Modbus reference"),
        ("M0-M9=065530", "continues after 065536"),
        ("M0-M9=000001,M20=000100", "coils are given twice"),
    ],
)
def test_maps_that_are_none(text: str, said: str) -> None:
    with pytest.raises(UsageError, match=said):
        parse_map(text)
