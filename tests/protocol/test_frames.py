"""Frames, checksums and error texts by the name of a protocol, against the papers' own bytes."""

from __future__ import annotations

from typing import TYPE_CHECKING

import pytest
from hypothesis import given
from hypothesis import strategies as st

import fatektool
from fatektool.errors import UsageError
from fatektool.protocol import frames
from fatektool.protocol.commands import ReadBriefStatus
from fatektool.protocol.explain import FrameRole
from fatektool.protocol.modbus.pdu import crc_bytes as pymodbus_crc
from fatektool.protocol.plc_errors import MEANINGS
from fatektool.protocol.registry import codec_named, new_explainer
from fatektool.protocols import PROTOCOLS
from tests.protocol import vectors
from tests.protocol.fatek.mseries import vectors as mseries_vectors

if TYPE_CHECKING:
    from tests.protocol.vectors import Example


def examples() -> list[tuple[str, Example]]:
    return [("facon", example) for example in vectors.EXAMPLES] + [
        ("mseries", example) for example in mseries_vectors.EXAMPLES
    ]


@pytest.mark.parametrize(("protocol", "example"), examples(), ids=lambda value: getattr(value, "name", value))
def test_the_papers_examples(protocol: str, example: Example) -> None:
    assert frames.frame(example.request, 1, protocol) == example.asks
    assert frames.answer_frame(example.request, example.answer, 1, protocol) == example.answers


def test_the_checksum_of_each_protocol() -> None:
    """Bytes of the papers, and of the Modbus specification's own example."""
    assert fatektool.checksum(b"\x02014603R00012") == b"75"
    assert fatektool.checksum(bytes.fromhex("0002 0140"), "mseries") == bytes.fromhex("A184")
    assert fatektool.checksum(bytes.fromhex("010300000002"), "modbus-rtu") == bytes.fromhex("C40B")
    assert fatektool.checksum(bytes.fromhex("010300000002"), "modbus-ascii") == b"FA"
    with pytest.raises(UsageError, match="no checksum"):
        fatektool.checksum(b"", "modbus-tcp")
    with pytest.raises(UsageError, match="expected one of facon, mseries"):
        fatektool.checksum(b"", "nope")


@given(st.binary(max_size=5000))
def test_the_checksum_of_any_bytes(data: bytes) -> None:
    assert fatektool.checksum(data) == f"{sum(data) % 256:02X}".encode()
    assert fatektool.checksum(data, "modbus-rtu") == pymodbus_crc(data)


def test_error_texts() -> None:
    assert fatektool.error_text(0) == "no error"
    for code, meaning in MEANINGS.items():
        assert fatektool.error_text(code) == meaning
    assert fatektool.error_text(2, "modbus-rtu") == "illegal data address, not in the PLC's Modbus map"
    assert fatektool.error_text(0xB, "modbus-tcp") == "the gateway reports: no answer from the PLC"
    assert fatektool.error_text(0xE) == "a code that no paper lists"
    assert fatektool.error_text(9, "mseries") == "cannot run, function not supported"
    assert fatektool.error_text(3, "mseries") == "a code that the M-series paper does not list"
    assert fatektool.error_text(0x7F, "modbus-tcp") == "a code that Modbus does not list"


@given(
    st.sampled_from(list(PROTOCOLS)),
    st.integers(0, 0x7F),
    st.binary(max_size=60),
    st.integers(0, 247),
    st.booleans(),
)
def test_any_command_with_any_data(
    protocol: str, command: int, data: bytes, station: int, answer: bool
) -> None:
    """What is built is a whole frame with a right checksum, whatever stands in it."""
    try:
        raw = frames.raw_frame(command, data, station, protocol, answer=answer)
    except UsageError:
        assert protocol == "facon"
        assert {2, 3} & set(data)
        return
    if protocol.startswith("modbus"):
        return  # a function that is in no map has no length that a decoder could know
    decoder = codec_named(protocol).decoder()
    decoder.feed(raw)
    found = decoder.next_frame()
    assert found is not None
    assert (found.station, found.command, found.data) == (station, command, data)


@pytest.mark.parametrize("protocol", PROTOCOLS)
def test_an_error_is_explained_as_one(protocol: str) -> None:
    command = 0x03 if protocol.startswith("modbus") else 0x46
    raw = frames.error_frame(command, 2, 9, protocol)
    (shown,) = new_explainer(protocol).explain(raw, FrameRole.ANSWER)
    assert (shown.role, shown.station, shown.fault) == (FrameRole.ANSWER, 9, None)
    assert fatektool.error_text(2, protocol) in " ".join(field.meaning for field in shown.fields)


@pytest.mark.parametrize(("protocol", "code"), [("facon", 16), ("facon", 0), ("mseries", 256)])
def test_error_codes_have_a_range(protocol: str, code: int) -> None:
    with pytest.raises(UsageError, match="error code: expected 1 to"):
        frames.error_frame(0x46, code, 1, protocol)


def test_what_no_frame_can_hold() -> None:
    for protocol in PROTOCOLS:
        with pytest.raises(UsageError):
            frames.raw_frame(0x46, b"x" * 600, 1, protocol)
        with pytest.raises(UsageError):
            frames.frame(ReadBriefStatus(), 999, protocol)
        with pytest.raises(UsageError):
            frames.raw_frame(0x100, b"", 1, protocol)
    with pytest.raises(UsageError):
        frames.raw_frame(3, b"", 248, "modbus-rtu")
