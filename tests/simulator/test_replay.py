"""A recorded PLC: what it answered then, it answers again, and nothing else."""

from __future__ import annotations

import socket
from typing import TYPE_CHECKING

import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from fatektool.errors import DataError, UsageError
from fatektool.simulator.listen.servers import Server, running
from fatektool.simulator.replay import Recorded, Replay
from tests.night import examples
from tests.simulator.listen.listeners import connected, place, read
from tests.simulator.wire import frame

if TYPE_CHECKING:
    from collections.abc import Callable
    from pathlib import Path

    from fatektool.simulator.slaves.base import RequestFrame

STATUS, STOPPED, RUNS = frame("40"), frame("400005400"), frame("400015400")
PAGE = frame("4F0005")
ONE, TWO = frame("4F0" + "11" * 128), frame("4F0" + "22" * 128)
PING, PINGED = frame("4EABCD"), frame("4EABCD")
FRESH = frame("4E7F3A09")


def sent(at: float, data: bytes) -> Recorded:
    return Recorded(at, True, data)  # noqa: FBT003  # this is the name


def heard(at: float, data: bytes) -> Recorded:
    return Recorded(at, False, data)  # noqa: FBT003  # and its opposite


def asked(replay: Replay, *requests: bytes) -> list[list[tuple[float, bytes]]]:
    """What comes back to each request on a new line, asked at second 100; times after the request."""
    line = replay.line()
    return [
        [(round(due - 100, 6), data) for due, data in line.receive(request, 100.0)] for request in requests
    ]


def answers(replay: Replay, *requests: bytes) -> list[bytes]:
    """All bytes that come back to each request."""
    return [b"".join(data for _, data in pieces) for pieces in asked(replay, *requests)]


# --- the walk -------------------------------------------------------------------------------------


def test_each_request_walks_through_its_answers_and_keeps_the_last() -> None:
    replay = Replay(
        [
            sent(0.0, STATUS),
            heard(0.1, STOPPED),
            sent(1.0, PAGE),
            heard(1.1, ONE),
            sent(2.0, PAGE),
            sent(3.0, STATUS),
            heard(3.1, RUNS),
            sent(4.0, PAGE),
            heard(4.1, TWO),
        ]
    )
    assert answers(replay, PAGE, STATUS, PAGE, PAGE, PAGE) == [ONE, STOPPED, b"", TWO, TWO]
    assert answers(replay, STATUS, STATUS, PAGE) == [RUNS, RUNS, TWO]  # another line, the same PLC


def test_the_recorded_delay_and_pieces() -> None:
    records = [sent(5.0, PAGE), heard(5.3, ONE[:9]), heard(7.0, ONE[9:])]
    assert asked(Replay(records), PAGE) == [[(0.3, ONE[:9]), (2.0, ONE[9:])]]
    assert asked(Replay(records, speed=4), PAGE) == [[(0.075, ONE[:9]), (0.5, ONE[9:])]]
    assert asked(Replay(records, speed=0), PAGE) == [[(0.0, ONE[:9]), (0.0, ONE[9:])]]


def test_a_clock_that_was_set_back() -> None:
    records = [sent(5.0, PAGE), heard(4.0, ONE[:9]), heard(6.0, ONE[9:]), heard(3.0, b"z")]
    assert asked(Replay(records), PAGE) == [[(0.0, ONE[:9]), (1.0, ONE[9:]), (1.0, b"z")]]


def test_noise_and_a_late_answer_come_where_they_came() -> None:
    replay = Replay([sent(0.0, STATUS), sent(0.5, PAGE), heard(0.6, b"\xff" + STOPPED), heard(0.7, ONE)])
    assert asked(replay, STATUS, PAGE) == [[], [(0.1, b"\xff" + STOPPED), (0.2, ONE)]]


def test_what_came_before_the_first_request_answers_nothing() -> None:
    assert answers(Replay([heard(0.0, b"\xff\x02"), sent(0.5, PAGE), heard(0.6, ONE)]), PAGE) == [ONE]


def test_an_unknown_request_is_silence_and_is_counted() -> None:
    named: list[RequestFrame] = []
    replay = Replay([sent(0.0, PAGE), heard(0.1, ONE)], on_unknown=named.append)
    assert answers(replay, STATUS, frame("4F0005", station=2), STATUS, PAGE, FRESH) == [
        b"",
        b"",
        b"",
        ONE,
        b"",
    ]
    assert [request.raw for request in named] == [STATUS, frame("4F0005", station=2), STATUS, FRESH]
    assert [(request.raw, count) for request, count in replay.unknown.items()] == [
        (STATUS, 2),
        (frame("4F0005", station=2), 1),
        (FRESH, 1),
    ]
    assert replay.unknown_count == 4


def test_a_babbling_client_fills_no_memory() -> None:
    replay = Replay([sent(0.0, STATUS)])
    answers(replay, *(frame(f"4F{page:04X}") for page in range(3000)))
    assert replay.unknown_count == 3000
    assert len(replay.unknown) == 1000


@pytest.mark.parametrize("speed", [-1.0, float("nan")])
def test_a_speed_that_is_none(speed: float) -> None:
    with pytest.raises(UsageError, match="replay speed: expected 0 or more"):
        Replay([sent(0.0, STATUS)], speed=speed)


@pytest.mark.parametrize(
    "records",
    [[], [heard(0.0, STOPPED)], [sent(0.0, b"\xff")], [sent(0.0, bytes.fromhex("511000020140A18455AA"))]],
)
def test_a_recording_without_a_request(records: list[Recorded]) -> None:
    with pytest.raises(DataError, match="no facon request in the recording"):
        Replay(records)


# --- records that split and join ------------------------------------------------------------------


def test_a_request_in_two_records() -> None:
    replay = Replay([sent(0.0, b"zz" + PAGE[:5]), sent(0.2, PAGE[5:]), heard(0.3, ONE)])
    assert asked(replay, PAGE) == [[(0.1, ONE)]]


def test_requests_that_were_sent_at_once() -> None:
    """Each gets its own answer, whatever the order; what is left over is the last one's."""
    replay = Replay(
        [
            sent(0.0, STATUS + frame("4F0005", station=0) + PAGE),
            heard(0.1, b"n" + ONE),
            heard(0.2, STOPPED + b"z"),
        ]
    )
    assert asked(replay, PAGE, STATUS) == [[(0.1, b"n" + ONE), (0.1, b"z")], [(0.1, STOPPED)]]
    assert answers(Replay([sent(0.0, STATUS + PAGE)]), STATUS, PAGE) == [b"", b""]


def test_requests_that_come_at_once_are_answered_one_after_the_other() -> None:
    records = [sent(0.0, PAGE), heard(0.5, ONE), sent(1.0, STATUS), heard(1.1, STOPPED)]
    assert asked(Replay(records), PAGE + STATUS) == [[(0.5, ONE), (0.6, STOPPED)]]


@given(st.data())
def test_any_chunking_of_the_requests(data: st.DataObject) -> None:
    records = [sent(0.0, STATUS), heard(0.0, STOPPED), sent(1.0, PAGE), heard(1.0, ONE), sent(2.0, PING)]
    line = Replay([*records, heard(2.0, PINGED)]).line()
    stream = b"\x03\xff" + STATUS + b"\x02" + PAGE + FRESH + PAGE[:4]
    came = b""
    while stream:
        size = data.draw(st.integers(1, len(stream)))
        came += b"".join(piece for _, piece in line.receive(stream[:size], 0.0))
        stream = stream[size:]
    assert came == STOPPED + ONE + FRESH


def test_a_datagram_stands_by_itself() -> None:
    line = Replay([sent(0.0, PAGE), heard(0.0, ONE)]).line(whole_answers=True)
    assert line.datagram(PAGE[:5], 0.0) == []
    assert line.datagram(PAGE[5:], 0.0) == []
    assert line.datagram(PAGE, 0.0) == [(0.0, ONE)]


# --- loopbacks ------------------------------------------------------------------------------------


def test_a_loopback_of_any_content_is_answered_by_a_plc_that_answered_loopbacks() -> None:
    replay = Replay([sent(0.0, PING), heard(0.25, PINGED)])
    assert asked(replay, FRESH, PING, frame("4E"), FRESH) == [
        [(0.25, FRESH)],
        [(0.25, PING)],
        [(0.25, frame("4E"))],
        [(0.25, FRESH)],
    ]
    assert answers(replay, frame("4E1", station=2)) == [b""]
    assert replay.unknown_count == 1


def test_loopbacks_walk_too_with_all_that_came_beside() -> None:
    flipped = PINGED[:-4] + b"X" + PINGED[-3:]
    replay = Replay(
        [
            sent(0.0, PING),
            sent(1.0, frame("4E0001")),
            heard(1.1, STOPPED + frame("4E0001")),
            sent(2.0, PING),
            heard(2.1, flipped),
            sent(3.0, PING),
            heard(3.1, PINGED[:3]),
            heard(3.5, PINGED[3:] + b"z"),
            sent(4.0, PING),
        ]
    )
    assert asked(replay, *[FRESH] * 7) == [
        [],
        [(0.1, STOPPED + FRESH)],
        [(0.1, flipped)],
        [(0.5, FRESH + b"z")],  # its echo came in pieces, and is a whole one again
        [],
        [(0.5, FRESH)],  # the row is used up
        [(0.5, FRESH)],
    ]


def test_a_two_wire_line_echoes_the_fresh_loopback() -> None:
    assert answers(Replay([sent(0.0, PING), heard(0.1, PING + PINGED)]), FRESH) == [FRESH + FRESH]
    asks, says = (bytes.fromhex(text) for text in ("51100004014EFFFF918055AA", "52100004014EFFFF918055AA"))
    replay = Replay([sent(0.0, asks), heard(0.1, asks + says)], "mseries")
    fresh = bytes.fromhex("51 10 0006 01 4E 55AA 55AA C117 55AA")
    assert answers(replay, fresh) == [fresh + b"\x52" + fresh[1:]]


def test_silence_to_every_loopback_stays() -> None:
    replay = Replay([sent(0.0, PING), sent(1.0, PAGE), heard(1.1, ONE)])
    assert answers(replay, FRESH, PING, PAGE) == [b"", b"", ONE]
    assert replay.unknown_count == 0


def test_nobody_answers_a_broadcast() -> None:
    everyone = frame("4EABCD", station=0)
    assert answers(Replay([sent(0.0, everyone), heard(0.1, b"z")]), frame("4E99", station=0)) == [b"z"]


def test_mseries() -> None:
    """M-series paper, sections 2.5.1 and 2.5.8: 40, and 46 of R0 and R1."""
    status = bytes.fromhex("511000020140A18455AA"), bytes.fromhex("5210000601400001000077D555AA")
    registers = bytes.fromhex("511000060146025200000E7C55AA"), bytes.fromhex("52100007014600FF55FF4B74B355AA")
    replay = Replay(
        [sent(0.0, status[0]), heard(0.1, status[1]), sent(1.0, registers[0]), heard(1.5, registers[1])],
        "mseries",
    )
    assert asked(replay, registers[0], status[0]) == [[(0.5, registers[1])], [(0.1, status[1])]]
    line = replay.line()
    came = [line.receive(bytes([byte]), 0.0) for byte in b"\x51" + registers[0] + b"\x55"]
    assert came == [[]] * len(registers[0]) + [[(0.5, registers[1])], []]


# --- through listeners --------------------------------------------------------------------------------


def over_tcp(server: Server, _: Path) -> Callable[[bytes, int], bytes]:
    listener = server.open_tcp()

    def exchange(data: bytes, size: int) -> bytes:
        with connected(listener) as client:
            for byte in data:
                client.sendall(bytes([byte]))
            return read(client, size)

    return exchange


def over_udp(server: Server, _: Path) -> Callable[[bytes, int], bytes]:
    listener = server.open_udp()

    def exchange(data: bytes, size: int) -> bytes:
        with socket.socket(socket.AF_INET, socket.SOCK_DGRAM) as client:
            client.settimeout(10)
            client.sendto(data, place(listener))
            return client.recv(size + 1)

    return exchange


@pytest.mark.parametrize("opened", [over_tcp, over_udp])
def test_through_a_door(
    opened: Callable[[Server, Path], Callable[[bytes, int], bytes]], tmp_path: Path
) -> None:
    records = [sent(0.0, PAGE), heard(0.02, ONE), sent(1.0, PAGE), heard(1.0, TWO), sent(2.0, PING)]
    server = Server(Replay([*records, heard(2.0, PINGED)]))
    exchange = opened(server, tmp_path)
    with running(server):
        assert exchange(PAGE, len(ONE)) == ONE
        assert exchange(PAGE, len(TWO)) == TWO
        assert exchange(FRESH, len(FRESH)) == FRESH
        assert exchange(PAGE, len(TWO)) == TWO


@settings(max_examples=examples(50))
@given(st.lists(st.tuples(st.booleans(), st.binary(max_size=12)), max_size=8), st.binary(max_size=40))
def test_any_recording_and_any_bytes(pieces: list[tuple[bool, bytes]], data: bytes) -> None:
    records = [Recorded(float(at), *piece) for at, piece in enumerate(pieces)]
    line = Replay([sent(0.0, STATUS), *records]).line()
    dues = [due for due, _ in line.receive(data + STATUS, 0.0)]
    assert dues == sorted(dues)
