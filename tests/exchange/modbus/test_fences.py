"""Answers that do not name their question: the fence is a read of a length that nothing else had."""

from __future__ import annotations

from typing import TYPE_CHECKING

import pytest

from fatektool.errors import NoAnswer, PlcRefused
from fatektool.exchange.batch import read_all
from fatektool.protocol.commands import (
    Control,
    ControlDiscrete,
    ReadDiscretes,
    ReadRegisters,
    WriteRegisters,
)
from fatektool.protocol.elements import Element
from fatektool.protocol.modbus.ascii import ASCII
from fatektool.protocol.modbus.map import parse_map
from fatektool.protocol.modbus.rtu import RTU
from fatektool.protocol.modbus.tcp import TCP
from tests.exchange.modbus.peer import LINE, Peer, Pieces, linked, registers, sealed

if TYPE_CHECKING:
    from fatektool.protocol.modbus.codec import ModbusCodec

R100, R200 = (ReadRegisters(Element("R", address), 1) for address in (100, 200))


def served(request: bytes) -> bytes:
    """A PLC whose registers hold their own address, and whose coils are off."""
    first, count = int.from_bytes(request[2:4], "big"), int.from_bytes(request[4:6], "big")
    if request[1] == 3:
        return sealed(f"01 03 {2 * count:02X}" + "".join(f"{first + n:04X}" for n in range(count)))
    return sealed(f"01 01 {(count + 7) // 8:02X}" + "00" * ((count + 7) // 8))


def test_a_late_answer_is_never_the_next_ones() -> None:
    held: list[bytes] = []

    def late_once(request: bytes, number: int) -> Pieces:
        if number == 1:
            held.append(served(request))
            return []
        pieces = [(0.01, held.pop())] if held else []
        return [*pieces, (0.01, served(request))]

    peer = Peer(late_once)
    link = linked(peer)
    assert link.ask(R100) == (100,)
    assert link.ask(R200) == (200,)
    fence = peer.heard[1]
    assert fence[1:6] != peer.heard[0][1:6]
    assert (fence[1], fence[5]) != (3, 1)  # not of the length of what is owed
    assert link.counters.fences == 1


def test_fences_in_a_row_are_all_different() -> None:
    """One whose answer is lost is owed too, and may come when the next one is out."""
    held: list[bytes] = []

    def one_behind(request: bytes, number: int) -> Pieces:
        held.append(served(request))
        return [(0.01, held[number - 2])] if number > 1 else []

    peer = Peer(one_behind)
    link = linked(peer)
    with pytest.raises(NoAnswer):
        link.ask(R100)
    shapes = [(raw[1], raw[4:6]) for raw in peer.heard]
    assert len(set(shapes)) == len(shapes) == 5


@pytest.mark.parametrize("codec", [RTU, ASCII], ids=lambda codec: codec.name)
def test_the_codec_finds_a_fence_as_long_as_there_is_one(codec: ModbusCodec) -> None:
    asked: set[bytes] = set()
    found = []
    while (fence := codec.fence(b"\0\x05", asked)) is not None:
        asked.add(codec.shape(fence))
        found.append(fence)
    assert len(found) == len(asked) == 64  # 32 lengths of registers, 32 of coils
    assert all(codec.encode(1, fence) for fence in found)


def test_a_fence_is_not_of_the_shape_of_what_is_asked_next() -> None:
    def twice(request: bytes, number: int) -> Pieces:
        return [(0.01, served(request)), (0.011, served(request))] if number > 1 else []

    peer = Peer(twice)
    link = linked(peer)
    assert link.ask(R100) == (100,)
    assert link.ask(R200) == (200,)
    assert read_all(link, [R100, R200, R100]) == [(100,), (200,), (100,)]


@pytest.mark.parametrize("registers_only", [False, True])
def test_an_exception_to_an_earlier_question_refuses_nothing(registers_only: bool) -> None:
    """It may come first when the fence is out, and be of the same function."""
    held = [sealed("01 83 02")]

    def refuses_late(request: bytes, number: int) -> Pieces:
        if number == 1:
            return []
        return [*((0.01, held.pop()) for _ in held[:]), (0.01, served(request))]

    codec = RTU.mapped(parse_map("R100-R299=400101")) if registers_only else RTU
    assert linked(Peer(refuses_late), codec).ask(R100) == (100,)


def test_a_fence_that_is_always_refused_leaves_it_to_silence() -> None:
    """The refusal of what the link asks for itself is not told as that of what it was asked."""

    def has_r100_alone(request: bytes, number: int) -> Pieces:
        if number == 1:
            return []
        r100 = request[1:6] == bytes.fromhex("03 0064 0001")
        return [(0.01, served(request) if r100 else sealed(f"01 {request[1] | 0x80:02X} 02"))]

    peer = Peer(has_r100_alone)
    link = linked(peer)
    assert link.ask(R100) == (100,)
    assert len(peer.heard) == 1 + 4 + 1
    assert peer.times[-1] - peer.times[-2] > 0.5
    with pytest.raises(PlcRefused, match="R200"):
        link.ask(R200)


# --- a map too small for a fence ------------------------------------------------------------------


def test_a_map_of_one_register_leaves_it_to_silence() -> None:
    codec = RTU.mapped(parse_map("R100=400101"))

    def slow_once(_: bytes, number: int) -> Pieces:
        return [(0.8 if number == 1 else 0.01, registers(1, number))]

    peer = Peer(slow_once)
    link = linked(peer, codec)
    assert link.ask(R100) == (2,)
    assert len(peer.heard) == 2  # the late answer to the first was heard and dropped
    assert peer.times[1] > 0.8 + 0.5
    assert link.counters.fences == 0


def test_a_line_that_is_never_silent_gives_no_answer() -> None:
    codec = RTU.mapped(parse_map("R100=400101"))
    babble: Pieces = [(0.6 + 0.2 * n, b"\xff") for n in range(40)]
    link = linked(Peer(lambda *_: babble), codec)
    with pytest.raises(NoAnswer, match="without a valid frame"):
        link.ask(R100)


# --- numbers --------------------------------------------------------------------------------------


def tcp_answer(request: bytes, value: int) -> bytes:
    return request[:4] + bytes.fromhex("0005 01 03 02") + value.to_bytes(2, "big")


def test_over_tcp_the_number_tells_and_no_fence_is_put_up() -> None:
    held: list[bytes] = []

    def late_once(request: bytes, number: int) -> Pieces:
        answer = tcp_answer(request, int.from_bytes(request[8:10], "big"))
        if number == 1:
            held.append(answer)
            return []
        return [(0.01, held.pop()), (0.01, answer)] if held else [(0.01, answer)]

    peer = Peer(late_once)
    link = linked(peer, TCP)
    assert link.ask(R100) == (100,)
    assert link.ask(R200) == (200,)
    assert [int.from_bytes(raw[:2], "big") for raw in peer.heard] == [1, 2, 3]
    assert link.counters.fences == 0
    assert read_all(link, [R100, R200] * 5) == [(100,), (200,)] * 5
    assert len(peer.heard) == 13  # nothing is asked twice


def test_numbers_begin_anew() -> None:
    link = linked(Peer(lambda request, _: [(0.01, tcp_answer(request, 7))]), TCP)
    link.sender._number = 0xFFFE
    for _ in range(3):
        assert link.ask(R100) == (7,)
    assert link.sender._number == 1


def test_a_slow_plc_over_tcp_is_given_more_time() -> None:
    """An answer comes 0.8 s after its request: late for the first try, known by its number."""
    link = linked(Peer(lambda request, _: [(0.8, tcp_answer(request, 7))]), TCP, retries=5)
    assert link.ask(R100) == (7,)


def test_what_a_gateway_says_is_no_refusal() -> None:
    def gateway(request: bytes, number: int) -> Pieces:
        said = request[:4] + bytes.fromhex("0003 01 83 0B")
        return [(0.01, said if number < 3 else tcp_answer(request, 9))]

    assert linked(Peer(gateway), TCP).ask(R100) == (9,)
    link = linked(Peer(lambda request, _: gateway(request, 0)), TCP)
    with pytest.raises(
        NoAnswer, match=r"the gateway reports: no answer from the PLC \(exception 0B\)"
    ) as told:
        link.ask(R100)
    assert str(told.value.hint).startswith("check that the PLC is on")


# --- what is written ------------------------------------------------------------------------------


def test_the_echo_of_another_write_is_not_taken() -> None:
    write = WriteRegisters(Element("R", 5), (7,))

    def wrong_first(request: bytes, _: int) -> Pieces:
        if request[1] == 6:
            return [(0.01, sealed("01 06 00 06 00 07"))]
        return [(0.01, served(request))]

    link = linked(Peer(wrong_first), retries=1)
    with pytest.raises(NoAnswer):
        link.ask(write)
    assert link.counters.strays > 0


def test_on_an_echoing_line_a_write_waits_for_its_second_copy() -> None:
    """05 and 06 answer what they were asked: only who knows that the line echoes can tell."""
    dead = linked(Peer(lambda request, _: [(0.0, request)]))
    with pytest.raises(NoAnswer, match="its own request only"):
        dead.ask(ControlDiscrete(Control.SET, Element("Y", 3)))

    def echoes(request: bytes, _: int) -> Pieces:
        answer = request if request[1] == 5 else served(request)
        return [(0.0, request), (0.01, answer)]

    peer = Peer(echoes)
    link = linked(peer)
    link.ask(ControlDiscrete(Control.SET, Element("Y", 3)))
    assert link.echoes is True
    assert [raw[1] for raw in peer.heard] == [3, 5]


def test_requests_whose_echo_passes() -> None:
    assert RTU.echo_may_pass(WriteRegisters(Element("R", 5), (7,)))
    assert not RTU.echo_may_pass(WriteRegisters(Element("R", 5), (7, 8)))
    assert not RTU.echo_may_pass(R100)
    # The address 03E8H reads as three bytes, which is what an answer to seventeen inputs has.
    assert RTU.echo_may_pass(ReadDiscretes(Element("X", 0), 17))
    assert not RTU.echo_may_pass(ReadDiscretes(Element("X", 0), 25))


# --- the silence between frames -------------------------------------------------------------------


def test_an_rtu_line_is_silent_for_three_and_a_half_characters() -> None:
    peer = Peer(lambda request, _: [(0.01, served(request))])
    link = linked(peer, serial=True)
    for _ in range(3):
        link.ask(R100)
    read_all(link, [R100, R200] * 4)
    gaps = [after - before - 0.01 for before, after in zip(peer.times, peer.times[1:], strict=False)]
    assert min(gaps) == pytest.approx(3.5 * LINE.byte_time_s)
    assert max(gaps) == pytest.approx(3.5 * LINE.byte_time_s)
    beyond = linked(Peer(lambda request, _: [(0.01, served(request))]))
    beyond.ask(R100)
    assert beyond.sender._quiet_s == 0  # a gateway keeps it itself


def test_behind_a_doubt_of_somebody_else_only_silence_is_a_fence() -> None:
    assert RTU.fence(b"\0\x05", set()) is not None
    assert RTU.fence(b"\0\x05", None) is None
