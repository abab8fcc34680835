"""Status bytes: the paper's FBE-28MC, an FBs-20MC, and codes that no paper names."""

from __future__ import annotations

import json
import struct

import pytest
from hypothesis import given
from hypothesis import strategies as st

from fatektool.errors import FrameError
from fatektool.protocol.commands import BRIEF_BYTES, DETAILED_BYTES, ReadBriefStatus
from fatektool.protocol.fatek.facon.data import DATA
from fatektool.protocol.status import BRIEF, DETAILED, BriefStatus, DetailedStatus, StatusFlags
from tests.protocol.vectors import FBE_28MC, FBE_28MC_BYTES

FBS_20MC_BYTES = bytes.fromhex(
    "21 01 02 40 8000 0100 0100 0064 0064 07D2 03E8 0000 1F88 1000 0100 0100" + 36 * "00"
)

FLAGS = [
    "running",
    "battery_low",
    "ladder_checksum_error",
    "rom_pack",
    "watchdog_timeout",
    "id_set",
    "emergency_stop",
]
SYSTEM = [
    "unit_type",
    "main_unit_points",
    "os_version",
    "ladder_words",
    "discrete_inputs",
    "discrete_outputs",
    "analog_inputs",
    "analog_outputs",
    "m_relays",
    "s_relays",
    "l_relays",
    "r_registers",
    "d_registers",
    "timers",
    "counters",
]


def detailed(**changed: int) -> DetailedStatus:
    """The FBE-28MC with some bytes changed, ``byte3=0x40``, counted from 1 as the paper does."""
    data = bytearray(FBE_28MC_BYTES)
    for name, value in changed.items():
        data[int(name.removeprefix("byte")) - 1] = value
    return DetailedStatus.parse(bytes(data))


def test_the_layouts_are_as_long_as_the_answers() -> None:
    assert (BRIEF.size, DETAILED.size) == (BRIEF_BYTES, DETAILED_BYTES) == (3, 64)


@pytest.mark.parametrize(("bit", "name"), list(enumerate(FLAGS)))
def test_each_flag_has_its_bit(bit: int, name: str) -> None:
    assert StatusFlags.parse(1 << bit).document() == {other: other == name for other in FLAGS}
    assert StatusFlags.parse(0x7F ^ 1 << bit).document() == {other: other != name for other in FLAGS}


def test_the_reserved_bit_says_nothing() -> None:
    assert StatusFlags.parse(0x80) == StatusFlags.parse(0)


@given(st.integers(0, 255))
def test_flags_are_a_number_again(byte: int) -> None:
    document = StatusFlags.parse(byte).document()
    assert list(document) == FLAGS
    assert sum(value << bit for bit, value in enumerate(document.values())) == byte & 0x7F


@pytest.mark.parametrize(
    ("code", "model"),
    [
        (0xFF, "FB, 8K steps"),
        (0x53, "FBE, 8K steps"),
        (0x54, "FBE, 13K steps"),
        (0x55, "FBN, 8K steps"),
        (0x56, "FBN, 13K steps"),
        (0x00, None),
        (0x40, None),
        (0x57, None),
    ],
)
def test_models(code: int, model: str | None) -> None:
    assert BriefStatus.parse(bytes([1, code, 0])).model == model


def test_a_real_unit_whose_model_no_paper_lists() -> None:
    status = DATA.parse_answer(ReadBriefStatus(), b"0014000")
    assert status.flags.running
    assert (status.status2, status.status3, status.model) == (0x40, 0, None)


@pytest.mark.parametrize("size", [0, 2, 4])
def test_brief_status_is_three_bytes(size: int) -> None:
    with pytest.raises(FrameError, match=f"brief status: expected 3 bytes, got {size}"):
        BriefStatus.parse(bytes(size))


@pytest.mark.parametrize("size", [0, 63, 65, 128])
def test_detailed_status_is_64_bytes(size: int) -> None:
    with pytest.raises(FrameError, match=f"detailed status: expected 64 bytes, got {size}"):
        DetailedStatus.parse(bytes(size))


def test_fbe_28mc() -> None:
    assert DetailedStatus.parse(FBE_28MC_BYTES) == FBE_28MC
    assert FBE_28MC.system.document() == {
        "unit_type": {"code": 1, "name": "MC"},
        "main_unit_points": {"code": 2, "points": 28},
        "os_version": "3.1",
        "ladder_words": 13184,
        "discrete_inputs": 256,
        "discrete_outputs": 256,
        "analog_inputs": 100,
        "analog_outputs": 100,
        "m_relays": 2002,
        "s_relays": 1000,
        "l_relays": 0,
        "r_registers": 8072,
        "d_registers": 3072,
        "timers": 256,
        "counters": 256,
    }


def test_fbs_20mc() -> None:
    status = DetailedStatus.parse(FBS_20MC_BYTES)
    system = status.system
    assert status.flags == FBE_28MC.flags
    assert (system.os_version, system.main_unit_points, system.points) == ("4.0", 2, 20)
    assert (system.ladder_words, system.d_registers) == (32768, 4096)
    assert system.unit_type_name == "MC"


@pytest.mark.parametrize(("code", "points"), [(0, None), (1, 20), (2, 28), (3, 40), (4, None), (255, None)])
def test_points_of_older_units(code: int, points: int | None) -> None:
    for version in (0x00, 0x30, 0x31, 0x39):
        assert detailed(byte3=code, byte4=version).system.points == points


@pytest.mark.parametrize(
    ("code", "points"),
    [(0, 10), (1, 14), (2, 20), (3, 24), (4, 32), (5, 40), (6, 60), (7, None), (255, None)],
)
def test_points_of_fbs_units(code: int, points: int | None) -> None:
    for version in (0x40, 0x4F, 0x50, 0x90):
        assert detailed(byte3=code, byte4=version).system.points == points


@pytest.mark.parametrize(
    ("byte", "version"), [(0x30, "3.0"), (0x31, "3.1"), (0x40, "4.0"), (0x47, "4.7"), (0xAF, "A.F")]
)
def test_os_version_is_a_digit_a_nibble(byte: int, version: str) -> None:
    assert detailed(byte4=byte).system.os_version == version


@pytest.mark.parametrize(("code", "name"), [(0, "MA/MU"), (1, "MC"), (2, None), (255, None)])
def test_unit_types(code: int, name: str | None) -> None:
    system = detailed(byte2=code).system
    assert system.unit_type_name == name
    assert system.document()["unit_type"] == {"code": code, "name": name}


@given(st.binary(min_size=64, max_size=64))
def test_any_64_bytes(data: bytes) -> None:
    status = DetailedStatus.parse(data)
    document = status.system.document()
    assert list(document) == SYSTEM
    assert tuple(document[name] for name in SYSTEM[3:]) == struct.unpack(">12H", data[4:28])
    assert json.loads(json.dumps(document)) == document
    assert status.raw == data
    assert status.flags == StatusFlags.parse(data[0])
