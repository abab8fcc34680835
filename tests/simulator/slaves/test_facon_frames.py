"""Cutting frames out of a stream, and what a PLC is silent about."""

from __future__ import annotations

import pytest
from hypothesis import given
from hypothesis import strategies as st

from fatektool.simulator.plc import SimulatedPlc
from fatektool.simulator.slaves.facon.frame import MAX_FRAME, FaconCutter
from fatektool.simulator.slaves.facon.slave import FaconSlave
from tests.simulator.wire import answers, frame

STATUS = frame("40")


@pytest.fixture
def slave() -> FaconSlave:
    return FaconSlave({1: SimulatedPlc()})


@pytest.mark.parametrize(
    "silent",
    [
        b"",
        b"\x02\x03",
        b"\x020140\x03",
        b"\x0201\x03",
        STATUS[:-3] + b"C8\x03",
        STATUS[:-3] + b"c8\x03",
        STATUS[:-3] + b"+7\x03",
        STATUS[:-3] + b"7\x03",
        frame("40", station=2),
        frame("40", station=0xFF),
        b"\x020g40FD\x03",
        b"\x02 140B7\x03",
        b"\x020a41f9\x03",
        b"\x02" + b"0" * MAX_FRAME + b"\x03",
    ],
)
def test_silent(slave: FaconSlave, silent: bytes) -> None:
    assert answers(slave, silent) == []
    assert len(answers(slave, STATUS)) == 1


def test_a_checksum_in_lower_case_is_read(slave: FaconSlave) -> None:
    """As some clients in the field send it; the answer has upper case."""
    assert answers(slave, b"\x020140c7\x03") == answers(slave, b"\x020140C7\x03")


def test_a_station_in_lower_case_is_read() -> None:
    slave = FaconSlave({0x1A: SimulatedPlc(0x1A)})
    small = b"\x021a40"
    (answer,) = answers(slave, small + b"%02x\x03" % (sum(small) % 256))
    assert [answer] == answers(slave, frame("40", station=0x1A))
    assert answer.startswith(b"\x021A400")


def test_stx_starts_afresh(slave: FaconSlave) -> None:
    assert len(answers(slave, STATUS[:6] + STATUS)) == 1


def test_frame_of_500_characters_is_the_longest() -> None:
    cutter = FaconCutter()
    longest = frame("4E" + "x" * 500)
    assert len(longest) == MAX_FRAME
    assert cutter.feed(longest) == [(MAX_FRAME, longest)]
    assert cutter.feed(frame("4E" + "x" * 501)) == []


def test_buffer_is_bounded() -> None:
    cutter = FaconCutter()
    cutter.feed(b"\x02")
    for _ in range(100):
        cutter.feed(b"x" * 100)
        assert len(cutter._begun) <= MAX_FRAME
    assert cutter.feed(STATUS) == [(len(STATUS), STATUS)]


def test_reset_forgets_what_has_begun() -> None:
    cutter = FaconCutter()
    cutter.feed(STATUS[:4])
    cutter.reset()
    assert cutter.feed(STATUS[4:]) == []


def test_end_counts_in_the_chunk_just_fed() -> None:
    cutter = FaconCutter()
    assert cutter.feed(b"??" + STATUS + STATUS[:3]) == [(10, STATUS)]
    assert cutter.feed(STATUS[3:] + STATUS) == [(5, STATUS), (13, STATUS)]


def test_broadcast_is_executed_by_all_and_answered_by_none() -> None:
    plcs = {station: SimulatedPlc(station) for station in (1, 7, 254)}
    slave = FaconSlave(plcs)
    assert answers(slave, frame("411", station=0)) == []
    assert answers(slave, frame("4701R00012BEEF", station=0)) == []
    assert answers(slave, frame("40", station=0)) == []
    assert answers(slave, frame("??", station=0)) == []
    assert [plc.running for plc in plcs.values()] == [True] * 3
    assert [plc.read_words("R", 12, 1) for plc in plcs.values()] == [[0xBEEF]] * 3


def test_stations_have_memories_of_their_own() -> None:
    slave = FaconSlave({station: SimulatedPlc(station) for station in (1, 2)})
    assert answers(slave, frame("4701R000120001") + frame("4701R000120002", station=2)) == [
        frame("470"),
        frame("470", station=2),
    ]
    assert answers(slave, frame("4601R00012", station=2)) == [frame("4600002", station=2)]
    assert answers(slave, frame("4601R00012")) == [frame("4600001")]


BYTES = st.one_of(
    st.binary(max_size=600),
    st.lists(
        st.one_of(
            st.sampled_from([STATUS, frame("4F0000"), b"\x02", b"\x03", b"\x0201"]),
            st.binary(max_size=20),
            st.text("0123456789ABCDEFXYMSTCWDRF", max_size=30).map(frame),
            st.builds(
                lambda command, data: frame(command + data),
                st.sampled_from(
                    ["40", "41", "42", "43", "44", "45", "46", "47", "48", "49", "4E", "4F", "50", "53"]
                ),
                st.text("0123456789ABFXYMSTCWDR", max_size=300),
            ),
        ),
        max_size=8,
    ).map(b"".join),
)


@given(BYTES, st.lists(st.integers(1, 700), max_size=6))
def test_any_bytes_in_any_chunking(data: bytes, cuts: list[int]) -> None:
    whole = answers(FaconSlave({1: SimulatedPlc(pages=PAGES)}), data)
    slave = FaconSlave({1: SimulatedPlc(pages=PAGES)})
    pieces: list[bytes] = []
    for cut in sorted(cuts, reverse=True):
        data, piece = data[:cut], data[cut:]
        pieces.insert(0, piece)
    chunked = [answer for piece in [data, *pieces] for answer in answers(slave, piece)]
    assert chunked == whole


PAGES = SimulatedPlc().pages
