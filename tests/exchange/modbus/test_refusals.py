"""What a PLC or gateway says instead of an answer, and whose request it says it of."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

import pytest

from fatektool.client import Plc
from fatektool.errors import NoAnswer, PlcBusy, PlcRefused
from fatektool.jobs.elements.reads import read_elements
from fatektool.jobs.elements.writes import write_elements
from fatektool.protocol.commands import Control, ControlDiscrete, ReadRegisters, WriteRegisters
from fatektool.protocol.elements import Element
from fatektool.protocol.modbus.ascii import ASCII
from fatektool.protocol.modbus.data import GATEWAY
from fatektool.protocol.modbus.rtu import RTU
from fatektool.protocol.modbus.tcp import TCP
from tests.exchange.modbus.peer import Peer, Pieces, linked

if TYPE_CHECKING:
    from collections.abc import Callable

    from fatektool.protocol.commands import Request
    from fatektool.protocol.modbus.codec import ModbusCodec

R105 = Element("R", 105)
TO_R105, FROM_R105 = WriteRegisters(R105, (7,)), ReadRegisters(R105, 1)


def pdu(request: bytes, codec: ModbusCodec) -> bytes:
    """Function and data of a request: 01 to 06 alone are asked here."""
    if codec is TCP:
        return request[7:]
    return bytes.fromhex(request[3:-4].decode()) if codec is ASCII else request[1:-2]


def framed(answer: bytes, request: bytes, codec: ModbusCodec) -> bytes:
    return codec.framing.encode(1, answer, int.from_bytes(request[:2], "big"))


class Slave(Peer):
    """A Modbus slave that has R105 and M5 alone.

    Args:
        codec: how it is asked.
        instead: the exception that it gives to the request of this number and function, or None.
    """

    def __init__(
        self, codec: ModbusCodec, instead: Callable[[int, int], int | None] = lambda *_: None
    ) -> None:
        self.codec = codec
        self.instead = instead
        self.value = 0
        self.coil = False
        self.asked: list[bytes] = []
        self.times: list[float] = []

    def receive(self, data: bytes, now: float) -> Pieces:
        asked = pdu(data, self.codec)
        self.asked.append(asked)
        self.times.append(now)
        code = self.instead(len(self.asked), asked[0])
        answer = self._served(asked) if code is None else bytes([asked[0] | 0x80, code])
        return [(now + 0.01, framed(answer, data, self.codec))]

    def _served(self, asked: bytes) -> bytes:
        match asked[:3].hex():
            case "030069" if asked[3:5] == b"\0\1":
                return b"\x03\x02" + self.value.to_bytes(2, "big")
            case "060069":
                self.value = int.from_bytes(asked[3:5], "big")
                return asked
            case "0107d5":
                return bytes([1, 1, self.coil])
            case "0507d5":
                self.coil = asked[3] == 0xFF
                return asked
        return bytes([asked[0] | 0x80, 2])


each_framing = pytest.mark.parametrize("codec", [RTU, ASCII, TCP], ids=lambda codec: codec.name)


@each_framing
def test_a_slave_without_r0_takes_what_it_has(codec: ModbusCodec) -> None:
    """The link asks R0 to learn whether a serial line echoes. That it has none is an answer too."""
    slave = Slave(codec)
    plc = Plc(linked(slave, codec), "sim:")
    assert write_elements(plc, [(R105, 7)]) == []
    plc.link.ask(ControlDiscrete(Control.SET, Element("M", 5)))
    assert (slave.value, slave.coil) == (7, True)
    assert [asked[0] for asked in slave.asked[:2]] == ([6, 3] if codec is TCP else [3, 6])  # TCP has no echo
    with pytest.raises(PlcRefused, match="write registers R106"):
        plc.link.ask(WriteRegisters(Element("R", 106), (1,)))


@each_framing
@pytest.mark.parametrize("code", [5, 6])
@pytest.mark.parametrize("request_", [FROM_R105, TO_R105], ids=["read", "write"])
def test_who_is_busy_is_asked_again_after_growing_pauses(
    codec: ModbusCodec, code: int, request_: Request[Any]
) -> None:
    slave = Slave(codec)
    link = linked(slave, codec)
    if link.echoes is None:
        link.attempts.learn_echo()
    slave.asked.clear()
    slave.times.clear()
    slave.instead = lambda number, _: code if number <= 2 else None
    link.ask(request_)
    gaps = [after - before for before, after in zip(slave.times, slave.times[1:], strict=False)]
    assert gaps[0] == pytest.approx(0.51)
    if code == 6 or request_ is FROM_R105:
        assert gaps == pytest.approx([0.51, 1.01])
        assert {asked[0] for asked in slave.asked} == {6 if request_ is TO_R105 else 3}
    else:  # 05: it was taken on, so it is looked at before it is sent again
        assert [asked[0] for asked in slave.asked[:2]] == [6, 3]
        assert slave.value == 7


@each_framing
def test_a_write_that_was_taken_on_is_not_sent_again(codec: ModbusCodec) -> None:
    slave = Slave(codec)
    link = linked(slave, codec)

    def takes_it_on(_: int, function: int) -> int | None:
        if function != 6:
            return None
        slave.value = 7
        return 5

    slave.instead = takes_it_on
    link.ask(TO_R105)
    assert [asked[0] for asked in slave.asked].count(6) == 1


@each_framing
def test_who_stays_busy_is_told_as_busy(codec: ModbusCodec) -> None:
    slave = Slave(codec, lambda *_: 6)
    plc = Plc(linked(slave, codec), "sim:")
    with pytest.raises(PlcBusy) as caught:
        read_elements(plc, [R105, Element("R", 106)])
    assert caught.value.exit_code == 4
    assert "exception 06, the PLC is busy, also in 4 tries, 3.5 s in total" in caught.value.message
    assert "--retries 3" in str(caught.value.hint)
    assert len(slave.asked) == 4  # nothing is taken apart: it is no refusal of an element


def test_a_long_stream_waits_for_who_is_busy_now_and_then() -> None:
    slave = Slave(TCP, lambda number, _: 6 if number % 3 == 0 else None)
    plc = Plc(linked(slave, TCP), "sim:")
    for value in range(9):
        assert write_elements(plc, [(R105, value)]) == []
        assert slave.value == value


# --- gateways ---------------------------------------------------------------------------------------


@each_framing
@pytest.mark.parametrize(
    ("code", "told", "hint"),
    [
        (
            10,
            "the gateway reports: no path to the PLC (exception 0A)",
            "check that the gateway's table has this station",
        ),
        (
            11,
            "the gateway reports: no answer from the PLC (exception 0B)",
            "check that the PLC is on",
        ),
    ],
)
def test_what_a_gateway_says_is_told_with_advice_for_gateways(
    codec: ModbusCodec, code: int, told: str, hint: str
) -> None:
    slave = Slave(codec, lambda *_: code)
    with pytest.raises(NoAnswer) as caught:
        linked(slave, codec).ask(FROM_R105)
    assert told in caught.value.message
    assert str(caught.value.hint).startswith(hint)
    assert "shield" not in str(caught.value)
    tries = "in 4 tries, 0.0 s" if codec is TCP else "in 1 try and 4 other requests, 0.1 s"
    assert f"{tries} in total" in caught.value.message  # none of them was waited for


def test_a_write_that_did_not_leave_the_gateway_is_not_looked_for() -> None:
    for code, functions in ((10, {6}), (11, {3, 6})):
        slave = Slave(TCP, lambda *_, code=code: code)
        with pytest.raises(NoAnswer) as caught:
            linked(slave, TCP).ask(TO_R105)
        assert {asked[0] for asked in slave.asked} == functions
        assert ("it is not known whether the PLC executed it" in caught.value.message) == (code == 11)
        assert f"the gateway reports: {GATEWAY[code]} (exception {code:02X})" in caught.value.message
        assert "nothing received" not in caught.value.message
        assert "gateway" in str(caught.value.hint)


# --- numbers, and bytes that belong to nothing ---------------------------------------------------------


def test_answers_with_another_number_are_told_as_such() -> None:
    peer = Peer(lambda request, _: [(0.01, b"\x12\x34" + request[2:4] + bytes.fromhex("0005 01 03 02 0007"))])
    with pytest.raises(NoAnswer) as caught:
        linked(peer, TCP).ask(FROM_R105)
    assert "received an answer with transaction number 1234, expected 0004 as in the request" in str(
        caught.value
    )
    assert "must repeat the number" in str(caught.value.hint)
    assert "another command" not in caught.value.message


@each_framing
@pytest.mark.parametrize("stray", [b"\xf5" * 8, bytes(range(0xA0, 0xA8)), b"\xff" * 40])
def test_stray_bytes_around_each_answer_cost_time_and_nothing_else(codec: ModbusCodec, stray: bytes) -> None:
    """As many as a request has, so they could be its echo by number. By content they cannot."""
    slave = Slave(codec)

    class Dirty(Peer):
        def receive(self, data: bytes, now: float) -> Pieces:
            return [(at, stray + answer + stray) for at, answer in slave.receive(data, now)]

    plc = Plc(linked(Dirty(lambda *_: []), codec), "sim:")
    assert write_elements(plc, [(R105, 7)]) == []
    assert read_elements(plc, [R105]).values == {R105: 7}
    assert slave.value == 7
