"""The worked examples of the M-series paper, section 2.5, byte for byte, their CRCs right."""

from __future__ import annotations

import pytest

from fatektool.simulator.memory import DiscreteAction
from fatektool.simulator.models import MODELS
from fatektool.simulator.plc import SimulatedPlc
from fatektool.simulator.slaves.mseries.slave import MSeriesSlave
from tests.simulator.slaves.mseries_wire import crc, reply, request
from tests.simulator.wire import answers

VECTORS = {
    "40": ("511000020140A18455AA", "5210000601400001000077D555AA"),
    "41 stop": ("5110000301410045D455AA", "5210000301410045D455AA"),
    "42 set Y100": ("511000060142035900648E6955AA", "52100003014200452455AA"),
    "43 X0..X3": ("51100006014304580000E2F655AA", "5210000701430001010101C54955AA"),
    "44 Y0..Y14": (
        "5110000601440F59000004D255AA",
        "52100012014400000000000000000000000000000000BB8955AA",
    ),
    "45 Y0..Y2": ("51100009014503590000000100210D55AA", "52100003014500471455AA"),
    "46 R0, R1": ("511000060146025200000E7C55AA", "52100007014600FF55FF4B74B355AA"),
    "47 R0..R2": ("5110000C014703520000FF55FF4BFF41C41655AA", "52100003014700467455AA"),
    "48 DR15, D1": ("5110000A0148024452000F44000148B255AA", "52100009014800999900000000DF1855AA"),
    "49 Y0, Y1, WM8, DR2": (
        "511000190149045900000159000100574D0008555544520002000000FF137A55AA",
        "52100003014900421455AA",
    ),
    "4E": ("51100004014EFFFF918055AA", "52100004014EFFFF918055AA"),
}


@pytest.fixture
def plc() -> SimulatedPlc:
    """The PLC that all the examples were read from."""
    plc = SimulatedPlc(model=MODELS["m-series"])
    plc.running = True
    for address in range(4):
        plc.control_discrete(DiscreteAction.DISABLE, "X", address)
    plc.write_words("R", 0, [0xFF55, 0xFF4B])
    plc.write_words("DR", 15, [0x99990000])
    return plc


@pytest.fixture(params=VECTORS)
def name(request: pytest.FixtureRequest) -> str:
    return str(request.param)


@pytest.fixture
def vector(plc: SimulatedPlc, name: str) -> tuple[MSeriesSlave, bytes, bytes]:
    asked, answered = VECTORS[name]
    return MSeriesSlave({1: plc}), bytes.fromhex(asked), bytes.fromhex(answered)


def test_the_tests_own_crc_is_the_papers() -> None:
    for frame in (bytes.fromhex(text) for pair in VECTORS.values() for text in pair):
        assert crc(frame[2:-4]) == frame[-4:-2]


def test_whole(vector: tuple[MSeriesSlave, bytes, bytes]) -> None:
    slave, asked, answered = vector
    assert answers(slave, asked) == [answered]


def test_byte_by_byte(vector: tuple[MSeriesSlave, bytes, bytes]) -> None:
    slave, asked, answered = vector
    given = [answers(slave, asked[at : at + 1]) for at in range(len(asked))]
    assert given == [[]] * (len(asked) - 1) + [[answered]]


def test_noise_before_and_bytes_trailing(vector: tuple[MSeriesSlave, bytes, bytes]) -> None:
    slave, asked, answered = vector
    noise = b"\x55\xaa\x51\xffnoise\x51\x51\x10\x55\xaa"
    status = request("53")
    assert answers(slave, noise + asked + status[:5]) == [answered]
    # What trailed is the start of the next request.
    assert answers(slave, status[5:]) == [reply("5300" + slave.plcs[1].detailed_status().hex())]
    assert answers(slave, asked) == [answered]


def test_two_in_one_chunk(vector: tuple[MSeriesSlave, bytes, bytes]) -> None:
    slave, asked, answered = vector
    assert answers(slave, asked + asked) == [answered, answered]


def test_what_the_writes_left(plc: SimulatedPlc) -> None:
    slave = MSeriesSlave({1: plc})
    for name in ("41 stop", "42 set Y100", "45 Y0..Y2", "47 R0..R2"):
        answers(slave, bytes.fromhex(VECTORS[name][0]))
    assert not plc.running
    assert plc.read_discretes("Y", 100, 1) == b"\x01"
    assert plc.read_discretes("Y", 0, 3) == b"\x00\x01\x00"
    assert plc.read_words("R", 0, 3) == [0xFF55, 0xFF4B, 0xFF41]
    answers(slave, bytes.fromhex(VECTORS["49 Y0, Y1, WM8, DR2"][0]))
    assert plc.read_discretes("Y", 0, 2) == b"\x01\x00"
    assert plc.read_words("WM", 8, 1) == [0x5555]
    assert plc.read_words("R", 2, 2) == [0xFF, 0]


@pytest.mark.parametrize(
    ("asked", "answered"),
    [
        ("4307'Y'000A", "430001000100000001"),
        ("4406'X'0032", "4400000100010100"),
        ("4603'R'000C", "460010A57FC40001"),
        ("4803'R'0001'Y'0009'DWM'0000", "48005C3401003547BA"),
        ("4702'WY'0010AAAA5555", "4700"),
        ("4E'ABCDEFG'", "4E41424344454647"),
    ],
)
def test_the_examples_without_a_frame(asked: str, answered: str) -> None:
    """Those that the paper gives as a payload alone."""
    plc = SimulatedPlc(model=MODELS["m-series"])
    for address in (51, 53, 54):
        plc.set_input(address, 1)
    for address in (10, 12, 16):
        plc.control_discrete(DiscreteAction.DISABLE, "Y", address)
    plc.write_words("R", 12, [0x10A5, 0x7FC4, 0x0001])
    plc.write_words("R", 1, [0x5C34])
    plc.write_discretes("Y", 9, b"\x01")
    plc.write_words("DWM", 0, [0x003547BA])
    assert answers(MSeriesSlave({1: plc}), request(asked)) == [reply(answered)]
