"""The worked examples of the FACON paper, section 4.2, byte for byte."""

from __future__ import annotations

from dataclasses import replace

import pytest

from fatektool.simulator.memory import DiscreteAction
from fatektool.simulator.models import MODELS
from fatektool.simulator.plc import SimulatedPlc
from fatektool.simulator.slaves.facon.slave import FaconSlave
from tests.simulator.wire import answers

VECTORS = {
    "40": ("0230313430433703", "023031343030323930303030323203"),
    "41 run": ("023031343131463903", "023031343130463803"),
    "42 disable X16": ("0230313432315830303136313903", "023031343230463903"),
    "43 Y10..Y16": ("023031343330375930303130344203", "02303134333031303130303031344403"),
    "44 X50..X55": ("023031343430365830303530344503", "023031343430303130313130314503"),
    "45 Y0..Y3": ("02303134353034593030303031303031304203", "023031343530464303"),
    "46 R12..R14": ("02303134363033523030303132373503", "023031343630313041353746433430303031383903"),
    "47 WY8, WY24": ("023031343730325759303030384141414135353535383003", "023031343730464503"),
    "48 R1, Y9, DWM0": (
        "02303134383033523030303031593030303944574D30303030334603",
        "02303134383035433334313030333534374241433503",
    ),
    "49 Y0, Y1, WM8, DR2": (
        "02303134393034593030303031593030303130574D3030303835353535445230303030323030303030304646334303",
        "023031343930303003",
    ),
    "4E": ("023031344541424344454647423803", "023031344541424344454647423803"),
    "53 FBE-28MC": (
        "0230313533434203",
        "02303135333032313031303233313333383030313030303130303030363430303634303744323033453830303030"
        "3146383830433030303130303031" + "30" * 74 + "413203",
    ),
}


@pytest.fixture
def plc() -> SimulatedPlc:
    """The PLC that all the examples were read from."""
    plc = SimulatedPlc()
    for address in (51, 53, 54):
        plc.set_input(address, 1)
    for address in (10, 12, 16):
        plc.control_discrete(DiscreteAction.DISABLE, "Y", address)
    plc.write_words("R", 12, [0x10A5, 0x7FC4, 0x0001])
    plc.write_words("R", 1, [0x5C34])
    plc.write_discretes("Y", 9, b"\x01")
    plc.write_words("DWM", 0, [0x003547BA])
    plc.id_set = True
    plc.running = True
    return plc


@pytest.fixture(params=VECTORS)
def vector(request: pytest.FixtureRequest, plc: SimulatedPlc) -> tuple[FaconSlave, bytes, bytes]:
    if request.param == "40":
        # The example has a ROM pack, and leaves the model's byte 0.
        plc.rom_pack = True
        plc.model = replace(MODELS["fbe-28mc"], status2=0)
    asked, answered = VECTORS[request.param]
    return FaconSlave({1: plc}), bytes.fromhex(asked), bytes.fromhex(answered)


def test_whole(vector: tuple[FaconSlave, bytes, bytes]) -> None:
    slave, asked, answered = vector
    assert answers(slave, asked) == [answered]


def test_byte_by_byte(vector: tuple[FaconSlave, bytes, bytes]) -> None:
    slave, asked, answered = vector
    given = [answers(slave, asked[at : at + 1]) for at in range(len(asked))]
    assert given == [[]] * (len(asked) - 1) + [[answered]]


def test_noise_before_and_bytes_trailing(vector: tuple[FaconSlave, bytes, bytes]) -> None:
    slave, asked, answered = vector
    assert answers(slave, b"\x03\xffnoise\x0201" + asked + b"\x02014") == [answered]
    # What trailed is the start of the next request.
    assert answers(slave, b"EC\x03") == []
    assert answers(slave, asked) == [answered]


def test_two_in_one_chunk(vector: tuple[FaconSlave, bytes, bytes]) -> None:
    slave, asked, answered = vector
    assert answers(slave, asked + asked) == [answered, answered]


def test_what_the_writes_left(plc: SimulatedPlc) -> None:
    slave = FaconSlave({1: plc})
    for name in ("42 disable X16", "45 Y0..Y3", "47 WY8, WY24"):
        answers(slave, bytes.fromhex(VECTORS[name][0]))
    assert plc.read_disabled("X", 15, 3) == b"\x00\x01\x00"
    assert plc.read_discretes("Y", 0, 4) == b"\x01\x00\x00\x01"
    # Y10, Y12 and Y16 are disabled: AAAA at Y8 does not take there.
    assert plc.read_words("WY", 8, 2) == [0xAAAA & ~0b1_0001_0100, 0x5555]
    answers(slave, bytes.fromhex(VECTORS["49 Y0, Y1, WM8, DR2"][0]))
    assert plc.read_discretes("Y", 0, 2) == b"\x01\x00"
    assert plc.read_words("WM", 8, 1) == [0x5555]
    assert plc.read_words("R", 2, 2) == [0xFF, 0]
