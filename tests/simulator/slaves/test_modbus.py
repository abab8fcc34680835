"""The simulated Modbus slave, byte for byte, against frames of these tests' own."""

from __future__ import annotations

from typing import TYPE_CHECKING

import pytest

from fatektool.simulator.build import build_plcs
from fatektool.simulator.slaves.modbus.ascii import AsciiFraming
from fatektool.simulator.slaves.modbus.rtu import RtuFraming
from fatektool.simulator.slaves.modbus.slave import ModbusSlave
from fatektool.simulator.slaves.modbus.tcp import TcpFraming
from fatektool.simulator.state import dump_state, parse_state
from tests.exchange.modbus.peer import sealed
from tests.protocol.modbus.vectors import EXCHANGES, ascii_frame, rtu, tcp
from tests.simulator.wire import answers

if TYPE_CHECKING:
    from collections.abc import Callable

    from fatektool.simulator.plc import SimulatedPlc
    from fatektool.simulator.slaves.modbus.framing import SlaveFraming


@pytest.fixture
def plc() -> SimulatedPlc:
    return build_plcs([17], "fbs-20mc")[17]


@pytest.fixture
def slave(plc: SimulatedPlc) -> ModbusSlave:
    return ModbusSlave({17: plc}, RtuFraming())


def ask(slave: ModbusSlave, text: str) -> str:
    """The answer's PDU to a PDU, in hex; its station and CRC are checked here."""
    (answer,) = answers(slave, sealed("11" + text))
    assert answer == sealed(answer[:-2].hex())
    assert answer[0] == 0x11
    return answer[1:-2].hex(" ").upper()


def prepared(plc: SimulatedPlc) -> None:
    """What the worked examples find there."""
    plc.write_discretes("Y", 19, bytes.fromhex("".join(f"0{bit:d}" for bit in EXCHANGES[0].answer)))
    plc.write_discretes("M", 196, bytes.fromhex("".join(f"0{bit:d}" for bit in EXCHANGES[1].answer)))
    plc.write_words("R", 107, EXCHANGES[2].answer)
    plc.write_words("R", 8, EXCHANGES[3].answer)
    plc.write_words("R", 3972, [0, 0, 2000, 0, 0, 2000])  # M0 at 100001, R0 at 300001
    for at in (56, 57, 58):
        plc.write_discretes("Y", at, b"\0")


@pytest.mark.parametrize(
    ("framing", "framed"),
    [(RtuFraming, rtu), (AsciiFraming, ascii_frame), (TcpFraming, tcp)],
    ids=["rtu", "ascii", "tcp"],
)
def test_the_worked_examples(
    plc: SimulatedPlc, framing: Callable[[], SlaveFraming], framed: Callable[[str], bytes]
) -> None:
    prepared(plc)
    for exchange in EXCHANGES:
        for chunks in ([framed(exchange.asks)], [bytes([byte]) for byte in framed(exchange.asks)]):
            slave = ModbusSlave({17: plc}, framing())
            found = [answer for chunk in chunks for answer in answers(slave, chunk)]
            (answer,) = found
            if exchange.function == 2:  # the example leaves bits on behind the last one that was asked for
                assert len(answer) == len(framed(exchange.answers))
            else:
                assert answer == framed(exchange.answers)
    assert plc.read_words("R", 1, 2) == [10, 258]


@pytest.mark.parametrize(
    ("asked", "answered"),
    [
        ("03 1068 0001", "83 02"),  # R4168
        ("03 1067 0002", "83 02"),  # goes past R4167
        ("03 0000 007E", "83 03"),
        ("03 0000 0000", "83 03"),
        ("01 0000 07D1", "81 03"),
        ("01 0100 0001", "81 02"),  # past Y255
        ("02 0000 0001", "82 02"),  # no inputs are laid yet
        ("04 0000 0001", "84 02"),
        ("05 0000 1234", "85 03"),
        ("06 2710 0001", "86 02"),
        ("0F 0000 0000 00", "8F 03"),
        ("0F 0000 0009 01 FF", "8F 03"),
        ("10 0000 0002 02 0001", "90 03"),
        ("08 0000 A537", "88 01"),
        ("2B 0E 01 00", "AB 01"),
        ("07", "87 01"),
    ],
)
def test_exceptions(slave: ModbusSlave, plc: SimulatedPlc, asked: str, answered: str) -> None:
    before = plc.revision
    assert ask(slave, asked.replace(" ", "")) == answered
    (found,) = [
        answer for byte in sealed("11" + asked) for answer in answers(slave, bytes([byte]))
    ]  # a byte at a time
    assert found[1:-2].hex(" ").upper() == answered
    assert plc.revision == before


def test_counters_of_16_and_32_bits(slave: ModbusSlave, plc: SimulatedPlc) -> None:
    plc.write_words("RC", 199, [0x1111, 0x2222])
    assert ask(slave, "03 25E3 0003") == "03 06 11 11 22 22 00 00"  # C199, C200 low, C200 high
    assert ask(slave, "10 25E4 0002 04 5678 1234") == "10 25 E4 00 02"
    assert plc.read_long_counters(0, 2) == [0x5678, 0x1234]
    assert plc.read_words("RC", 200, 1) == [0x5678]
    assert ask(slave, "03 2653 0001") == "03 02 00 00"  # C255, high
    assert ask(slave, "03 2654 0001") == "83 02"
    (kept,) = parse_state(dump_state([plc]), "test")
    assert kept.read_long_counters(0, 2) == [0x5678, 0x1234]


def test_a_write_is_made_whole_or_not_at_all(slave: ModbusSlave, plc: SimulatedPlc) -> None:
    assert ask(slave, "10 1067 0002 04 0001 0002") == "90 02"
    assert plc.read_words("R", 4167, 1) == [0]
    assert ask(slave, "0F 00FF 0002 01 03") == "8F 02"
    assert plc.read_discretes("Y", 255, 1) == b"\0"


def test_the_map_is_what_r3968_says_at_that_moment(slave: ModbusSlave, plc: SimulatedPlc) -> None:
    plc.write_words("R", 2000, [7])
    plc.write_discretes("M", 1000, b"\1")
    plc.write_words("R", 3969, [0, 1000, 100, 10, 1100, 50, 50, 1000, 10, 100, 2000, 200])
    assert ask(slave, "03 0064 0001") == "03 02 00 00"  # R100 still
    assert ask(slave, "02 000A 0001") == "02 01 00"  # whatever R3968 is
    assert ask(slave, "04 0032 000A").startswith("04 14")
    assert ask(slave, "06 0F80 A55A") == "06 0F 80 A5 5A"
    assert ask(slave, "03 0064 0001") == "03 02 00 07"
    assert ask(slave, "01 0000 0001") == "01 01 01"
    assert ask(slave, "05 0063 FF00") == "05 00 63 FF 00"
    assert plc.read_discretes("M", 1099, 1) == b"\1"
    for gone in ("03 0063 0001", "03 012C 0001", "01 0064 0001", "03 0F80 0001"):
        assert ask(slave, gone).endswith("02")
    assert ask(slave, "06 012B 0009") == "06 01 2B 00 09"
    assert plc.read_words("R", 2199, 1) == [9]
    plc.write_words("R", 3968, [0])
    assert ask(slave, "03 0F80 0001") == "03 02 00 00"


def test_everyone_executes_a_broadcast_and_nobody_answers() -> None:
    plcs = build_plcs([1, 2], "fbs-20mc")
    slave = ModbusSlave(plcs, RtuFraming())
    assert answers(slave, sealed("00 06 0005 0009")) == []
    assert [plc.read_words("R", 5, 1) for plc in plcs.values()] == [[9], [9]]
    assert answers(slave, sealed("03 06 0005 0001")) == []  # nobody's station


@pytest.mark.parametrize(
    "noise",
    ["00", "ff ff", "11", "11 03", "11 10 00", "11 08", "03 00 6b 00 03 76 87", "11 03 00 6b 00 03 76 88"],
)
def test_noise_before_a_request_costs_nothing(slave: ModbusSlave, noise: str) -> None:
    (answer,) = answers(slave, bytes.fromhex(noise) + sealed("11 03 0000 0001"))
    assert answer == sealed("11 03 02 0000")


def test_a_request_that_broke_off_is_given_up(slave: ModbusSlave) -> None:
    asked = sealed("11 03 0000 0001")
    assert answers(slave, sealed("11 10 0000 0003 06 0001 0002 0003")[:9]) == []
    found = [answer for _ in range(3) for answer in answers(slave, asked)]
    assert found
    assert set(found) == {sealed("11 03 02 0000")}


def test_readdressed_frames_have_their_checksum() -> None:
    assert RtuFraming().readdressed(sealed("11 03 02 0007"), 5) == sealed("05 03 02 0007")
    assert AsciiFraming().readdressed(b":110302000 7E3\r\n".replace(b" ", b""), 5) == b":0503020007EF\r\n"
    assert TcpFraming().readdressed(bytes.fromhex("0001 0000 0005 11 03 02 0007"), 5)[6] == 5
