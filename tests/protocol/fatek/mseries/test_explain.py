"""Explanations of M-series frames: every byte in a field, the values named, and no bytes that it fails on."""

from __future__ import annotations

from typing import Any

import pytest
from hypothesis import given
from hypothesis import strategies as st

from fatektool.protocol.commands import Command, ReadDetailedStatus, ReadRegisters
from fatektool.protocol.elements import Element
from fatektool.protocol.explain import Explanation, FrameRole
from fatektool.protocol.fatek.mseries.codec import MSERIES
from fatektool.protocol.registry import new_explainer
from fatektool.protocol.status import RawStatus
from tests.protocol.decoding import query, response, sealed
from tests.protocol.fatek.mseries.vectors import EXAMPLES, FRAMES, PAYLOADS
from tests.protocol.strategies import exchanges_of, requests_of, stations
from tests.protocol.vectors import FBE_28MC_BYTES, Example

ALL = EXAMPLES + PAYLOADS
BY_NAME = {example.name: example for example in ALL}
R12 = ReadRegisters(Element("R", 12), 3)


def explained(*pieces: bytes) -> list[Explanation]:
    """A conversation explained; what must hold for any is asserted on the way."""
    explainer = new_explainer("mseries")
    found = []
    for data in pieces:
        here = list(explainer.explain(data, FrameRole.EITHER))
        assert b"".join(explanation.raw for explanation in here) == data
        for explanation in here:
            assert b"".join(field.raw for field in explanation.fields) == explanation.raw
            assert all(field.name for field in explanation.fields)
            assert (explanation.station is None) == (explanation.command is None)
            assert (explanation.role is FrameRole.BROKEN) == (explanation.checksum_ok is not True)
            if explanation.role is FrameRole.BROKEN:
                assert explanation.fault
        found += here
    return found


def data_fields(explanation: Explanation) -> list[tuple[str, str, str]]:
    """Name, bytes and meaning of what stands between command and CRC."""
    names = [field.name for field in explanation.fields]
    assert names[:5] == ["header", "ID", "length", "station", "command"]
    assert names[-2:] == ["CRC", "terminator"]
    return [(field.name, field.raw.hex().upper(), field.meaning) for field in explanation.fields[5:-2]]


@pytest.mark.parametrize("example", ALL, ids=BY_NAME)
def test_examples(example: Example) -> None:
    for pieces in ((example.asks, example.answers), (example.asks + example.answers,)):
        asks, answers = explained(*pieces)
        assert (asks.role, answers.role) == (FrameRole.REQUEST, FrameRole.ANSWER)
        for explanation in (asks, answers):
            assert (explanation.station, explanation.command) == (1, example.request.command)
            assert explanation.checksum_ok
            assert explanation.fault is None
            assert explanation.fields[4].meaning == example.request.command.words


def test_fields() -> None:
    example = BY_NAME["49 write Y0, Y1, WM8 and DR2"]
    asks, answers = explained(example.asks, example.answers)
    assert data_fields(asks) == [
        ("n", "04", "4"),
        ("element", "590000", "Y0"),
        ("Y0", "01", "on"),
        ("element", "590001", "Y1"),
        ("Y1", "00", "off"),
        ("element", "574D0008", "WM8"),
        ("WM8", "5555", "21845"),
        ("element", "44520002", "DR2"),
        ("DR2", "000000FF", "255"),
    ]
    assert data_fields(answers) == [("error", "00", "none")]
    example = BY_NAME["48 read R1, Y9 and DWM0"]
    assert data_fields(explained(example.asks, example.answers)[1]) == [
        ("error", "00", "none"),
        ("R1", "5C34", "23604"),
        ("Y9", "01", "on"),
        ("DWM0", "003547BA", "3491770"),
    ]
    assert [(field.name, field.meaning) for field in asks.fields[:4]] == [
        ("header", "request"),
        ("ID", "binary protocol"),
        ("length", "25 bytes of payload"),
        ("station", "1"),
    ]


def test_status() -> None:
    (brief,) = explained(BY_NAME["40 RUN, memory card, ID"].answers)
    assert data_fields(brief) == [
        ("error", "00", "none"),
        ("status 1", "29", "RUN, memory card, id set"),
        ("status 2", "00", "reserved"),
        ("status 3", "00", "reserved"),
    ]
    (detailed,) = explained(response("01 53 00" + FBE_28MC_BYTES.hex()))
    assert data_fields(detailed)[5] == ("ladder size", "3380", "13184 words")
    (raw,) = explained(MSERIES.encode_answer(1, ReadDetailedStatus(), RawStatus(b"\1\2\3")))
    assert data_fields(raw)[1] == ("status", "010203", "in a layout that no paper describes")


def test_an_answer_alone_has_no_names() -> None:
    (answer,) = explained(response("01 46 00 10 A5 7F C4"))
    assert data_fields(answer)[1] == ("values", "10A57FC4", "of the elements in the request")


def test_an_answer_that_does_not_fit_its_request_is_called_so() -> None:
    late = MSERIES.encode_answer(1, ReadRegisters(Element("R", 0), 1), (7,))
    right = MSERIES.encode_answer(1, R12, (1, 2, 3))
    _, stray, answer = explained(MSERIES.encode(1, R12), late, right)
    assert stray.fault == "expected 6 bytes of values, as requested, got 2"
    assert [field[0] for field in data_fields(answer)[1:]] == ["R12", "R13", "R14"]


def test_an_echo_is_the_request_again() -> None:
    asks = MSERIES.encode(1, R12)
    _, echo, answer = explained(asks, asks + MSERIES.encode_answer(1, R12, (1, 2, 3)))
    assert (echo.role, echo.fault) == (FrameRole.REQUEST, None)
    assert data_fields(answer)[1][0] == "R12"


@pytest.mark.parametrize(
    ("code", "meaning"), [(0x0A, "illegal address"), (0x0B, "a code that the M-series paper does not list")]
)
def test_refusals(code: int, meaning: str) -> None:
    for command in (0x41, 0x46, 0x53, 0x4F):
        (explanation,) = explained(sealed(0x52, bytes([1, command, code])))
        (field,) = data_fields(explanation)
        assert field[:2] == ("error", f"{code:02X}")
        assert field[2].startswith(f"REFUSED: {meaning}")


def test_a_wrong_crc() -> None:
    raw = FRAMES[0][:-4] + b"\x84\xa1\x55\xaa"
    (explanation,) = explained(raw)
    assert (explanation.role, explanation.checksum_ok) == (FrameRole.BROKEN, False)
    assert explanation.fault == "checksum: expected A1 84, got 84 A1"
    assert explanation.fields[-2].meaning == "WRONG: expected A1 84"


def test_noise_and_what_is_cut_off() -> None:
    found = explained(b"\x00\xaa" + FRAMES[0] + b"\x51" + FRAMES[1] + FRAMES[2][:7])
    assert [(one.role, one.raw) for one in found] == [
        (FrameRole.BROKEN, b"\x00\xaa"),
        (FrameRole.REQUEST, FRAMES[0]),
        (FrameRole.BROKEN, b"\x51"),
        (FrameRole.ANSWER, FRAMES[1]),
        (FrameRole.BROKEN, FRAMES[2][:7]),
    ]
    assert found[-1].fault == "an incomplete frame"


@pytest.mark.parametrize("command", [0x00, 0x4F, 0x50, 0x99])
def test_a_command_that_the_paper_has_not(command: int) -> None:
    for header in (0x51, 0x52):
        (explanation,) = explained(sealed(header, bytes([1, command, 0, 5])))
        assert explanation.checksum_ok
        assert explanation.fields[4].meaning == "not in the paper"
        assert explanation.fault
        assert data_fields(explanation) == [("data", "0005", "data that no paper describes")]


@pytest.mark.parametrize(
    "payload",
    [
        "01 46",
        "01 46 01 02",
        "01 46 00 01",
        "01 46 00" + 65 * "0001",
        "01 44 00" + 257 * "00",
        "01 48 00",
        "01 40 00",
        "01 47 00 00",
        "01 41",
        "01 53",
    ],
)
def test_right_in_crc_and_wrong_in_content(payload: str) -> None:
    (explanation,) = explained(response(payload))
    assert explanation.checksum_ok
    assert explanation.fault


def test_stations() -> None:
    (everyone,) = explained(query("00 41 00"))
    assert everyone.fields[3].meaning == "broadcast to all PLCs, none answers"
    (nobody,) = explained(query("FF 40"))
    assert nobody.fields[3].meaning == "255, any PLC, or an Ethernet module"


payloads = st.builds(
    lambda command, data: bytes([1, command]) + data,
    st.sampled_from([*Command, 0x99]),
    st.binary(max_size=30),
)
pieces = st.one_of(
    st.sampled_from(FRAMES),
    st.builds(sealed, st.sampled_from([0x51, 0x52]), payloads),
    st.binary(max_size=40),
    requests_of(MSERIES).map(lambda request: MSERIES.encode(1, request)),
)


@given(st.lists(st.lists(pieces, max_size=4).map(b"".join), max_size=6))
def test_any_conversation(conversation: list[bytes]) -> None:
    explained(*conversation)


@given(stations, exchanges_of(MSERIES))
def test_any_exchange(station: int, exchange: tuple[Any, Any]) -> None:
    request, answer = exchange
    asks, answers = explained(
        MSERIES.encode(station, request), MSERIES.encode_answer(station, request, answer)
    )
    assert (asks.role, asks.fault) == (FrameRole.REQUEST, None)
    assert (answers.role, answers.fault) == (FrameRole.ANSWER, None)


def test_more_than_a_decoder_keeps() -> None:
    data = b"".join(FRAMES) * 300
    assert len(data) > 1 << 16
    assert len(explained(data)) == 300 * len(FRAMES)
    assert explained(b"x" * 200_000 + FRAMES[0])[-1].raw == FRAMES[0]
