"""Cutting M-series frames out of a stream, and what a PLC is silent about."""

from __future__ import annotations

import pytest
from hypothesis import given
from hypothesis import strategies as st

from fatektool.simulator.plc import SimulatedPlc
from fatektool.simulator.slaves.mseries.frame import MAX_FRAME, MSeriesCutter
from fatektool.simulator.slaves.mseries.slave import MSeriesSlave
from tests.rows import each
from tests.simulator.slaves.mseries_wire import framed, reply, request
from tests.simulator.wire import answers

ASK, ANSWER = request("40"), reply("4000000000")
PAGES = SimulatedPlc().pages


@pytest.fixture
def slave() -> MSeriesSlave:
    return MSeriesSlave({1: SimulatedPlc()})


@pytest.mark.parametrize(
    "silent",
    [
        b"",
        b"\x51\x10",
        b"\x55\xaa",
        ASK[:-4] + b"\x84\xa1\x55\xaa",
        ASK[:-2] + b"\xaa\x55",
        ASK[:-1] + b"\xab",
        b"\x52" + ASK[1:],
        b"\x51\x11" + ASK[2:],
        request("40", station=2),
        request("40", station=0xFF),
        framed(b""),
        framed(b"\x01"),
        framed(b"\x01\x4e" + bytes(511)),
        b"\x51\x10\xff\xff",
        b"\x51\x10\x00\x00",
    ],
)
def test_silent(slave: MSeriesSlave, silent: bytes) -> None:
    assert answers(slave, silent) == []
    assert answers(slave, ASK) == [ANSWER]


@each("at", range(len(ASK)))
@each("bit", range(8))
def test_one_wrong_bit_is_silence_and_costs_no_other_request(slave: MSeriesSlave, at: int, bit: int) -> None:
    wrong = bytearray(ASK)
    wrong[at] ^= 1 << bit
    assert answers(slave, bytes(wrong)) == []
    assert answers(slave, ASK) == [ANSWER]


@pytest.mark.parametrize(
    "data",
    [b"\x55\xaa", ASK, ASK * 8, b"\x51\x10\x00\x02", b"\x51\x10\x02\x00\x01\x4e", b"\x51" * 255, ANSWER * 3],
)
def test_a_payload_may_hold_anything(slave: MSeriesSlave, data: bytes) -> None:
    loopback = framed(b"\x01\x4e" + data)
    assert answers(slave, loopback) == [b"\x52" + loopback[1:]]
    given = [answer for at in range(len(loopback)) for answer in answers(slave, loopback[at : at + 1])]
    assert given == [b"\x52" + loopback[1:]]


def test_a_frame_within_written_data_is_not_executed() -> None:
    plc = SimulatedPlc()
    slave = MSeriesSlave({1: plc})
    write = request("4706'R'0000" + request("4101").hex() + "00")
    assert [answer for at in range(len(write)) for answer in answers(slave, write[at : at + 1])] == [
        reply("4700")
    ]
    assert not plc.running


@pytest.mark.parametrize(
    "noise",
    [
        b"\x51",
        b"\x51\x10",
        b"\x51\x10\x00",
        b"\x51\x10\x00\x02",
        b"\x51\x10\x00\x20",
        b"\x51\x10\x02\x00",
        b"\x51\x10\x00\x20\x01",
        b"\x51\x10\x00\x20\x01\x40",
        b"\x51\x10\x00\xff\xff\x4e",
        b"\x51\x10\x00\x20\x01\x60abc",
        b"\x51\x10\x00\x01\x01\x00\x00\x55\xaa",
        ASK[:-1],
    ],
)
def test_a_lying_header_does_not_hold_back_the_request_behind_it(slave: MSeriesSlave, noise: bytes) -> None:
    assert answers(slave, noise + ASK) == [ANSWER]
    slave.reset()
    assert answers(slave, noise) == []
    assert answers(slave, ASK) == [ANSWER]


def test_no_request_is_lost_behind_one_that_was_cut_off(slave: MSeriesSlave) -> None:
    long = framed(b"\x01\x4e" + bytes(100))
    heard = answers(slave, long[:20])
    sent = 0
    while not heard:
        heard = answers(slave, ASK)
        sent += 1
    lacking = len(long) - 20
    assert sent == -(-lacking // len(ASK))
    heard += answers(slave, ASK)
    assert heard == [ANSWER] * (sent + 1)


def test_what_is_found_behind_a_false_frame_ends_with_it() -> None:
    cutter = MSeriesCutter()
    false = b"\x51\x10\x00\x30\x01\x4e"
    (found,) = cutter.feed(false + ASK + bytes(56 - len(false) - len(ASK)))
    assert found == (56, ASK)
    cutter.feed(false + ASK)
    assert cutter.feed(bytes(56 - len(false) - len(ASK)))[0] == (56 - len(false) - len(ASK), ASK)


def test_the_longest_frame(slave: MSeriesSlave) -> None:
    longest = framed(b"\x01\x4e" + bytes(510))
    assert len(longest) == MAX_FRAME
    assert answers(slave, longest) == [reply("4E04")]


@pytest.mark.parametrize("begun", [b"\x51\x10\x01\x02\x01\x4e", b"\x51\x10\x02\x00", b"\x51\x10\x00"])
def test_buffer_is_bounded(begun: bytes) -> None:
    cutter = MSeriesCutter()
    for _ in range(100):
        for piece in (begun, b"x" * 100, b"\x51"):
            cutter.feed(piece)
            assert len(cutter._begun) < MAX_FRAME
    cutter.feed(bytes(MAX_FRAME))
    assert cutter._begun == b""
    assert cutter.feed(ASK) == [(len(ASK), ASK)]


def test_end_counts_in_the_chunk_just_fed() -> None:
    cutter = MSeriesCutter()
    assert cutter.feed(b"??" + ASK + ASK[:3]) == [(12, ASK)]
    assert cutter.feed(ASK[3:] + ASK) == [(7, ASK), (17, ASK)]


def test_reset_forgets_what_has_begun() -> None:
    cutter = MSeriesCutter()
    cutter.feed(ASK[:4])
    cutter.reset()
    assert cutter.feed(ASK[4:]) == []


def test_broadcast_is_executed_by_all_and_answered_by_none() -> None:
    plcs = {station: SimulatedPlc(station) for station in (1, 7, 254)}
    slave = MSeriesSlave(plcs)
    for text in ("4101", "4701'R'000CBEEF", "40", "FF", "4701'R'FFFF0000", "4E"):
        assert answers(slave, request(text, station=0)) == []
    assert [plc.running for plc in plcs.values()] == [True] * 3
    assert [plc.read_words("R", 12, 1) for plc in plcs.values()] == [[0xBEEF]] * 3


def test_stations_have_memories_of_their_own() -> None:
    slave = MSeriesSlave({station: SimulatedPlc(station) for station in (1, 0xFE)})
    assert answers(slave, request("4701'R'000C0001") + request("4701'R'000C0002", station=0xFE)) == [
        reply("4700"),
        reply("4700", station=0xFE),
    ]
    assert answers(slave, request("4601'R'000C", station=0xFE)) == [reply("46000002", station=0xFE)]
    assert answers(slave, request("4601'R'000C")) == [reply("46000001")]


BYTES = st.one_of(
    st.binary(max_size=600),
    st.lists(
        st.one_of(
            st.sampled_from([ASK, ASK[:-1], b"\x51", b"\x51\x10", b"\x51\x10\x00\x30", b"\x55\xaa"]),
            st.binary(max_size=20),
            st.builds(
                lambda command, data: framed(bytes((1, command)) + data),
                st.sampled_from([*range(0x40, 0x4A), 0x4E, 0x4F, 0x50, 0x53]),
                st.binary(max_size=300),
            ),
            st.builds(
                lambda command, count, symbol, rest: framed(bytes((1, command, count)) + symbol + rest),
                st.sampled_from(range(0x42, 0x4A)),
                st.integers(0, 70),
                st.sampled_from([b"X", b"Y", b"WM", b"R", b"D", b"DR", b"DWX", b"DF", b"Q"]),
                st.binary(min_size=2, max_size=140),
            ),
        ),
        max_size=8,
    ).map(b"".join),
)


@given(BYTES, st.lists(st.integers(1, 700), max_size=6))
def test_any_bytes_in_any_chunking(data: bytes, cuts: list[int]) -> None:
    # A longest frame of nothing behind it, so that whatever has begun ends.
    data += bytes(MAX_FRAME)
    whole = answers(MSeriesSlave({1: SimulatedPlc(pages=PAGES)}), data)
    slave = MSeriesSlave({1: SimulatedPlc(pages=PAGES)})
    pieces: list[bytes] = []
    for cut in sorted(cuts, reverse=True):
        data, piece = data[:cut], data[cut:]
        pieces.insert(0, piece)
    assert [answer for piece in [data, *pieces] for answer in answers(slave, piece)] == whole
