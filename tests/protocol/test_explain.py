"""Frames explained: every byte in a field, the values named, and no bytes that it fails on."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

import pytest
from hypothesis import given
from hypothesis import strategies as st

from fatektool.protocol.commands import (
    Loopback,
    ReadDetailedStatus,
    ReadPage,
    ReadRegisters,
    RunStop,
    WritePage,
)
from fatektool.protocol.elements import Element
from fatektool.protocol.explain import Explanation, FrameRole
from fatektool.protocol.fatek.facon.codec import FACON
from fatektool.protocol.registry import new_explainer
from tests.protocol.decoding import framed
from tests.protocol.strategies import exchanges, requests, stations
from tests.protocol.vectors import EXAMPLES, FRAMES, MISPRINTS, NAMES, Example, Misprint

if TYPE_CHECKING:
    from fatektool.protocol.commands import Request

PAGE = bytes(range(128))
R12 = ReadRegisters(Element("R", 12), 3)
roles = st.sampled_from([FrameRole.REQUEST, FrameRole.ANSWER, FrameRole.EITHER])


def explained(*pieces: tuple[bytes, FrameRole]) -> list[Explanation]:
    """A conversation explained; what must hold for any is asserted on the way."""
    explainer = new_explainer("facon")
    found = []
    for data, role in pieces:
        here = list(explainer.explain(data, role))
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


def one(raw: bytes, role: FrameRole = FrameRole.EITHER) -> Explanation:
    (explanation,) = explained((raw, role))
    return explanation


def data_fields(explanation: Explanation) -> list[tuple[str, str, str]]:
    """Name, characters and meaning of what stands between command and checksum."""
    assert [field.name for field in explanation.fields[:3]] == ["STX", "station", "command"]
    assert [field.name for field in explanation.fields[-2:]] == ["LRC", "ETX"]
    return [(field.name, field.raw.decode("latin-1"), field.meaning) for field in explanation.fields[3:-2]]


# --- the paper's examples -------------------------------------------------------------------------


@pytest.mark.parametrize("example", EXAMPLES, ids=NAMES)
def test_examples(example: Example) -> None:
    asks, answers = explained((example.asks, FrameRole.REQUEST), (example.answers, FrameRole.ANSWER))
    assert (asks.role, answers.role) == (FrameRole.REQUEST, FrameRole.ANSWER)
    for explanation in (asks, answers):
        assert (explanation.station, explanation.command) == (1, example.request.command)
        assert explanation.checksum_ok
        assert explanation.fault is None
        assert explanation.fields[2].meaning == example.request.command.words


@pytest.mark.parametrize("example", EXAMPLES, ids=NAMES)
def test_examples_typed_in_a_row(example: Example) -> None:
    """Without a direction, in one piece, request and answer are told apart but where they are the same."""
    asks, answers = explained((example.asks + example.answers, FrameRole.EITHER))
    either = isinstance(example.request, RunStop | Loopback)
    assert asks.role is (FrameRole.EITHER if either else FrameRole.REQUEST)
    assert answers.role is FrameRole.ANSWER
    assert asks.fault is None
    assert answers.fault is None


SHOWN = {
    "41 RUN": ([("control", "1", "RUN")], [("error", "0", "none")]),
    "42 disable X16": (
        [("control", "1", "disable"), ("element", "X0016", "X16")],
        [("error", "0", "none")],
    ),
    "43 enable status of Y10 to Y16": (
        [("n", "07", "7"), ("element", "Y0010", "Y10 to Y16")],
        [
            ("error", "0", "none"),
            ("Y10", "1", "disabled"),
            ("Y11", "0", "enabled"),
            ("Y12", "1", "disabled"),
            ("Y13", "0", "enabled"),
            ("Y14", "0", "enabled"),
            ("Y15", "0", "enabled"),
            ("Y16", "1", "disabled"),
        ],
    ),
    "44 read X50 to X55": (
        [("n", "06", "6"), ("element", "X0050", "X50 to X55")],
        [
            ("error", "0", "none"),
            ("X50", "0", "off"),
            ("X51", "1", "on"),
            ("X52", "0", "off"),
            ("X53", "1", "on"),
            ("X54", "1", "on"),
            ("X55", "0", "off"),
        ],
    ),
    "46 read R12 to R14": (
        [("n", "03", "3"), ("element", "R00012", "R12 to R14")],
        [
            ("error", "0", "none"),
            ("R12", "10A5", "4261"),
            ("R13", "7FC4", "32708"),
            ("R14", "0001", "1"),
        ],
    ),
    "47 write WY8 and WY24": (
        [
            ("n", "02", "2"),
            ("element", "WY0008", "WY8 to WY24"),
            ("WY8", "AAAA", "43690"),
            ("WY24", "5555", "21845"),
        ],
        [("error", "0", "none")],
    ),
    "48 read R1, Y9 and DWM0": (
        [
            ("n", "03", "3"),
            ("element", "R00001", "R1"),
            ("element", "Y0009", "Y9"),
            ("element", "DWM0000", "DWM0"),
        ],
        [
            ("error", "0", "none"),
            ("R1", "5C34", "23604"),
            ("Y9", "1", "on"),
            ("DWM0", "003547BA", "3491770"),
        ],
    ),
    "49 write Y0, Y1, WM8 and DR2": (
        [
            ("n", "04", "4"),
            ("element", "Y0000", "Y0"),
            ("Y0", "1", "on"),
            ("element", "Y0001", "Y1"),
            ("Y1", "0", "off"),
            ("element", "WM0008", "WM8"),
            ("WM8", "5555", "21845"),
            ("element", "DR00002", "DR2"),
            ("DR2", "000000FF", "255"),
        ],
        [("error", "0", "none")],
    ),
    "4E loopback of ABCDEFG": (
        [("test data", "ABCDEFG", "7 characters")],
        [("test data", "ABCDEFG", "7 characters")],
    ),
}


@pytest.mark.parametrize("name", SHOWN)
def test_fields(name: str) -> None:
    example = EXAMPLES[NAMES.index(name)]
    asks, answers = explained((example.asks, FrameRole.REQUEST), (example.answers, FrameRole.ANSWER))
    assert (data_fields(asks), data_fields(answers)) == SHOWN[name]


def test_brief_status() -> None:
    assert data_fields(one(EXAMPLES[0].answers)) == [
        ("error", "0", "none"),
        ("status 1", "29", "RUN, rom pack, id set"),
        ("status 2", "00", "a code that names no model"),
        ("status 3", "00", "reserved"),
    ]
    assert data_fields(one(framed(b"01400015400")))[2] == ("status 2", "54", "FBE, 13K steps")


def test_detailed_status() -> None:
    fields = data_fields(one(EXAMPLES[-1].answers))
    assert fields[:6] == [
        ("error", "0", "none"),
        ("status 1", "21", "RUN, id set"),
        ("main unit type", "01", "MC"),
        ("main unit points", "02", "28"),
        ("OS version", "31", "3.1"),
        ("ladder size", "3380", "13184 words"),
    ]
    assert fields[-3:] == [
        ("timers", "0100", "256"),
        ("counters", "0100", "256"),
        ("reserved", 72 * "0", ""),
    ]
    assert [field[0] for field in fields[6:10]] == (
        ["discrete inputs", "discrete outputs", "analog inputs", "analog outputs"]
    )


def test_pages() -> None:
    header = b"FB30\x33\x80" + 122 * b"\xff"
    assert data_fields(one(FACON.encode(1, ReadPage(0)))) == [("page number", "0000", "0, the header")]
    assert data_fields(one(FACON.encode(1, ReadPage(206)))) == [("page number", "00CE", "206")]
    assert data_fields(one(FACON.encode_answer(1, ReadPage(0), header)))[1][2] == (
        "64 words, first 4642 3330 3380 FFFF …"
    )
    written = data_fields(one(FACON.encode(1, WritePage(5, PAGE))))
    assert written[0] == ("page number", "0005", "5")
    assert written[1][2] == "64 words, first 0001 0203 0405 0607 …"


@pytest.mark.parametrize("request_", [ReadPage(1), ReadDetailedStatus()])
def test_an_answer_without_error_character(request_: Request[Any]) -> None:
    size = {0x4F: 256, 0x53: 128}[request_.command]
    bare = one(framed(b"01%02X" % request_.command + size * b"0"), FrameRole.ANSWER)
    assert bare.fault is None
    assert "error" not in [field[0] for field in data_fields(bare)]
    whole = one(framed(b"01%02X" % request_.command + (size + 1) * b"0"), FrameRole.ANSWER)
    assert data_fields(whole)[0] == ("error", "0", "none")


# --- conversations --------------------------------------------------------------------------------


def test_an_answer_alone_has_no_names() -> None:
    assert data_fields(one(EXAMPLES[6].answers, FrameRole.ANSWER)) == [
        ("error", "0", "none"),
        ("values", "10A57FC40001", "of the elements in the request"),
    ]


def test_the_request_of_another_station_or_command_names_nothing() -> None:
    other_station = FACON.encode(2, R12)
    other_command = FACON.encode(1, EXAMPLES[4].request)
    for asked in (other_station, other_command):
        *_, answers = explained((asked, FrameRole.REQUEST), (EXAMPLES[6].answers, FrameRole.ANSWER))
        assert data_fields(answers)[1][0] == "values"


def test_stations_are_kept_apart() -> None:
    other = ReadRegisters(Element("D", 7), 3)
    values = (1, 2, 3)
    *_, first, second = explained(
        (FACON.encode(1, R12) + FACON.encode(2, other), FrameRole.REQUEST),
        (FACON.encode_answer(2, other, values) + FACON.encode_answer(1, R12, values), FrameRole.ANSWER),
    )
    assert [field[0] for field in data_fields(first)[1:]] == ["D7", "D8", "D9"]
    assert [field[0] for field in data_fields(second)[1:]] == ["R12", "R13", "R14"]


def test_a_request_names_one_answer() -> None:
    *_, second = explained(
        (EXAMPLES[6].asks, FrameRole.REQUEST),
        (EXAMPLES[6].answers, FrameRole.ANSWER),
        (EXAMPLES[6].answers, FrameRole.ANSWER),
    )
    assert data_fields(second)[1][0] == "values"


@pytest.mark.parametrize("role", [FrameRole.ANSWER, FrameRole.EITHER])
def test_an_answer_that_does_not_fit_its_request_is_called_so(role: FrameRole) -> None:
    """It came late, from an earlier request; the request still waits for its own."""
    late = FACON.encode_answer(1, ReadRegisters(Element("R", 0), 1), (7,))
    _, stray, answers = explained(
        (FACON.encode(1, R12), FrameRole.REQUEST), (late, role), (EXAMPLES[6].answers, role)
    )
    assert stray.fault == "expected 12 characters of values, as requested, got 4"
    assert [field[0] for field in data_fields(answers)[1:]] == ["R12", "R13", "R14"]


def test_an_echo_is_the_request_again() -> None:
    """On a two-wire line the request comes in before its answer, and uses nothing up."""
    example = EXAMPLES[6]
    _, echo, answers = explained(
        (example.asks, FrameRole.REQUEST), (example.asks + example.answers, FrameRole.ANSWER)
    )
    assert (echo.role, echo.fault) == (FrameRole.REQUEST, None)
    assert data_fields(echo) == [("n", "03", "3"), ("element", "R00012", "R12 to R14")]
    assert [field[0] for field in data_fields(answers)[1:]] == ["R12", "R13", "R14"]


def test_damage_does_not_name_values() -> None:
    """A damaged request was not heard, and a damaged answer does not use up the request."""
    damaged = FACON.encode(1, ReadRegisters(Element("D", 0), 3)).replace(b"D", b"R")
    *_, answers = explained(
        (FACON.encode(1, R12) + damaged, FrameRole.REQUEST), (EXAMPLES[6].answers, FrameRole.ANSWER)
    )
    assert data_fields(answers)[1][0] == "R12"
    flipped = EXAMPLES[6].answers.replace(b"A5", b"A4")
    *_, broken, answers = explained(
        (FACON.encode(1, R12), FrameRole.REQUEST), (flipped + EXAMPLES[6].answers, FrameRole.ANSWER)
    )
    assert broken.role is FrameRole.BROKEN
    assert data_fields(answers)[1][0] == "R12"


@pytest.mark.parametrize(
    ("code", "meaning"),
    [
        ("3", "REFUSED: write prohibited, a ROM pack is fitted"),
        ("A", "REFUSED: illegal address, above the range of this PLC"),
        ("B", "REFUSED: a code that no paper lists"),
    ],
)
def test_refusals(code: str, meaning: str) -> None:
    for command in (b"46", b"4F", b"53", b"41", b"99"):
        explanation = one(framed(b"01" + command + code.encode()), FrameRole.ANSWER)
        assert data_fields(explanation) == [("error", code, meaning)]
        assert explanation.fault is None


def test_broadcast() -> None:
    explanation = one(FACON.encode(0, RunStop(run=False)), FrameRole.REQUEST)
    assert explanation.station == 0
    assert explanation.fields[1].meaning == "broadcast to all PLCs, none answers"


def test_station_255() -> None:
    explanation = one(framed(b"FF40"))
    assert explanation.station == 255
    assert explanation.fields[1].meaning == "255, any PLC, or an Ethernet module"


# --- what is wrong --------------------------------------------------------------------------------


@pytest.mark.parametrize("misprint", MISPRINTS, ids=lambda misprint: misprint.name)
def test_a_wrong_checksum(misprint: Misprint) -> None:
    explanation = one(misprint.raw)
    assert explanation.role is FrameRole.BROKEN
    assert explanation.checksum_ok is False
    assert explanation.station == 1
    assert explanation.fields[-2].raw == misprint.got.encode()
    assert explanation.fields[-2].meaning == f"WRONG: expected {misprint.expected}"
    assert explanation.fault == f"checksum: expected {misprint.expected}, got '{misprint.got}'"


def test_noise_between_frames() -> None:
    kinds = [
        (explanation.role, explanation.raw)
        for explanation in explained((b"\x03zz" + FRAMES[0] + b"\xff" + FRAMES[1], FrameRole.EITHER))
    ]
    assert kinds == [
        (FrameRole.BROKEN, b"\x03zz"),
        (FrameRole.REQUEST, FRAMES[0]),
        (FrameRole.BROKEN, b"\xff"),
        (FrameRole.ANSWER, FRAMES[1]),
    ]


@pytest.mark.parametrize("size", range(1, 8))
def test_a_frame_cut_off(size: int) -> None:
    explanation = one(FRAMES[0][:size])
    assert explanation.role is FrameRole.BROKEN
    assert explanation.fault == "cut off: no ETX (03)"
    assert explanation.station is None


@pytest.mark.parametrize("role", [FrameRole.EITHER, FrameRole.REQUEST, FrameRole.ANSWER])
@pytest.mark.parametrize("data", [b"", b"0", b"00", b"123"])
def test_an_unknown_command(role: FrameRole, data: bytes) -> None:
    explanation = one(framed(b"0199" + data), role)
    assert (explanation.command, explanation.checksum_ok) == (0x99, True)
    assert explanation.fields[2].meaning == "not in the paper"
    assert explanation.fault == "command 99 is not in the paper"
    assert data_fields(explanation) == (
        [("data", data.decode(), "data that no paper describes")] if data else []
    )


@pytest.mark.parametrize(
    ("body", "role"),
    [
        (b"0146", FrameRole.EITHER),
        (b"0146xyz", FrameRole.EITHER),
        (b"0146010A5F", FrameRole.ANSWER),  # not 4 digits a register
        (b"0146" + 261 * b"0", FrameRole.ANSWER),  # 65 registers
        (b"0144" + 258 * b"0", FrameRole.ANSWER),
        (b"01440012", FrameRole.ANSWER),
        (b"0148", FrameRole.ANSWER),
        (b"014800g", FrameRole.ANSWER),
        (b"01400", FrameRole.ANSWER),
        (b"01400290000F", FrameRole.ANSWER),
        (b"014F0AB", FrameRole.ANSWER),  # a page of one byte
        (b"014F0" + 254 * b"0", FrameRole.ANSWER),
        (b"01530" + 126 * b"0", FrameRole.ANSWER),
        (b"015000", FrameRole.ANSWER),
        (b"014700", FrameRole.ANSWER),
        (b"0147x", FrameRole.ANSWER),
        (b"0147g", FrameRole.ANSWER),
        (b"0142", FrameRole.REQUEST),
        (b"01400", FrameRole.REQUEST),
    ],
)
def test_right_in_checksum_and_wrong_in_content(body: bytes, role: FrameRole) -> None:
    explanation = one(framed(body), role)
    assert explanation.checksum_ok
    assert explanation.fault
    assert [field[1] for field in data_fields(explanation)] == ([body[4:].decode()] if body[4:] else [])


def test_a_discrete_that_is_neither_on_nor_off() -> None:
    *_, answers = explained(
        (EXAMPLES[8].asks, FrameRole.REQUEST), (framed(b"014805C347003547BA"), FrameRole.ANSWER)
    )
    assert answers.fault == "expected 0 or 1 for each discrete"


# --- any bytes ------------------------------------------------------------------------------------

bodies = st.one_of(
    st.binary(max_size=30),
    st.builds(
        lambda station, command, data: b"%02X%02X%b" % (station, command, data.encode()),
        st.integers(0, 255),
        st.sampled_from([*range(0x40, 0x54), 0x99]),
        st.text("0123456789ABCDEFXYMSTCRDW g", max_size=20),
    ),
)
pieces = st.one_of(
    st.sampled_from(FRAMES),
    bodies.map(framed),
    st.binary(max_size=40),
    requests.map(lambda request: FACON.encode(1, request)),
)


@given(st.lists(st.tuples(st.lists(pieces, max_size=4).map(b"".join), roles), max_size=6))
def test_any_conversation(conversation: list[tuple[bytes, FrameRole]]) -> None:
    explained(*conversation)


@given(st.binary(max_size=2000), roles)
def test_any_bytes(data: bytes, role: FrameRole) -> None:
    explained((data, role))


@given(stations, exchanges)
def test_any_exchange(station: int, exchange: tuple[Request[Any], Any]) -> None:
    request, answer = exchange
    asks, answers = explained(
        (FACON.encode(station, request), FrameRole.REQUEST),
        (FACON.encode_answer(station, request, answer), FrameRole.ANSWER),
    )
    assert (asks.role, asks.fault) == (FrameRole.REQUEST, None)
    assert (answers.role, answers.fault) == (FrameRole.ANSWER, None)


def test_more_than_a_decoder_keeps() -> None:
    """A trace of a babbling line may hold a record of any size: none of it is forgotten."""
    data = b"".join(FRAMES) * 400
    assert len(data) > 3 * (1 << 16)
    assert len(explained((data, FrameRole.EITHER))) == 400 * len(FRAMES)
    assert explained((b"x" * 200_000 + FRAMES[0], FrameRole.EITHER))[-1].raw == FRAMES[0]
    explained((b"\x02" * 10_000 + b"\x03" * 200_000 + b"\x0201", FrameRole.EITHER))
