"""Every command: its limits, and what each kind of wrong request is answered with."""

from __future__ import annotations

import pytest

from fatektool.simulator.models import MODELS
from fatektool.simulator.plc import SimulatedPlc
from fatektool.simulator.slaves.facon.slave import FaconSlave
from tests.simulator.wire import answers, ask, frame

PAGE = bytes(range(128))
PAGE_HEX = PAGE.hex().upper()


@pytest.fixture
def plc() -> SimulatedPlc:
    return SimulatedPlc()


@pytest.fixture
def slave(plc: SimulatedPlc) -> FaconSlave:
    return FaconSlave({1: plc})


FORMAT, VALUE, ADDRESS = "4", "2", "A"

REFUSED = [
    # unknown or malformed commands
    ("51", FORMAT),
    ("00", FORMAT),
    ("4f0000", FORMAT),
    ("??", FORMAT),
    # too much, too little
    ("400", FORMAT),
    ("530", FORMAT),
    ("41", FORMAT),
    ("4111", FORMAT),
    ("42", FORMAT),
    ("421", FORMAT),
    ("421X", FORMAT),
    ("421X001", FORMAT),
    ("421X00160", FORMAT),
    ("430", FORMAT),
    ("4301", FORMAT),
    ("4301X00000", FORMAT),
    ("4401X000", FORMAT),
    ("4502Y00001", FORMAT),
    ("4502Y0000111", FORMAT),
    ("4601R0001", FORMAT),
    ("4601R000120", FORMAT),
    ("4702R000120000", FORMAT),
    ("4701R0001200000000", FORMAT),
    ("4802R00001", FORMAT),
    ("4801R00001R00002", FORMAT),
    ("4902Y00001", FORMAT),
    ("4901Y00001Y", FORMAT),
    ("4E" + "x" * 257, FORMAT),
    ("4F000", FORMAT),
    ("4F00000", FORMAT),
    ("500000", FORMAT),
    ("500000" + PAGE_HEX[:-1], FORMAT),
    ("500000" + PAGE_HEX + "0", FORMAT),
    # unknown elements, elements of the wrong kind
    ("421Q0000", FORMAT),
    ("4201R00000", VALUE),
    ("421R00000", FORMAT),
    ("4401WX0000", FORMAT),
    ("4601X0000", FORMAT),
    ("4601WR0000", FORMAT),
    ("4601DX00000", FORMAT),
    ("4801Z0000", FORMAT),
    ("4601r00012", FORMAT),
    # characters that are no digits of their field
    ("41x", VALUE),
    ("412", VALUE),
    ("420X0000", VALUE),
    ("425X0000", VALUE),
    ("44GGX0000", VALUE),
    ("440aX0000", VALUE),
    ("44+1X0000", VALUE),
    ("4401X00A0", VALUE),
    ("4502Y000012", VALUE),
    ("4601R0A012", VALUE),
    ("4701R00012000G", VALUE),
    ("4701R00012beef", VALUE),
    ("4701R00012 123", VALUE),
    ("4901Y00002", VALUE),
    ("4F00G0", VALUE),
    ("4F00b0", VALUE),
    ("500G00" + PAGE_HEX, VALUE),
    ("500000" + "g" + PAGE_HEX[1:], VALUE),
    # n out of its range
    ("4600R00000", VALUE),
    ("4641R00000", VALUE),
    ("4621DR00000", VALUE),
    ("4621DWM0000", VALUE),
    ("4700R00000", VALUE),
    ("4741R00000" + "0000" * 65, VALUE),
    ("4800", VALUE),
    ("4841" + "X0000" * 65, VALUE),
    ("4821" + "DR00000" * 33, VALUE),
    ("4900", VALUE),
    ("4921" + "Y00000" * 33, VALUE),
    ("4911" + "DR0000000000000" * 17, VALUE),
    # addresses past the model, packed words that do not exist
    ("421X0256", ADDRESS),
    ("4400X0001", ADDRESS),
    ("4401S1000", ADDRESS),
    ("4502Y025511", ADDRESS),
    ("4601R08072", ADDRESS),
    ("4602R08071", ADDRESS),
    ("4601R99999", ADDRESS),
    ("4601DR08071", ADDRESS),
    ("4601RT0256", ADDRESS),
    ("4601D03072", ADDRESS),
    ("4601F00000", ADDRESS),
    ("4601WY0004", ADDRESS),
    ("4601WX0248", ADDRESS),
    ("4601WM1992", ADDRESS),
    ("4601DWX0232", ADDRESS),
    ("4802R00001X9999", ADDRESS),
    ("4902R000010001X99991", ADDRESS),
    ("4F00CF", ADDRESS),
    ("5000CF" + PAGE_HEX, ADDRESS),
]


@pytest.mark.parametrize(("request_data", "code"), REFUSED)
def test_refused(slave: FaconSlave, plc: SimulatedPlc, request_data: str, code: str) -> None:
    assert ask(slave, request_data) == code
    assert plc.revision == 0


def test_an_error_bears_the_command_as_it_came(slave: FaconSlave) -> None:
    assert answers(slave, frame("\xff?1234")) == [frame("\xff?4")]


@pytest.mark.parametrize(
    ("request_data", "answer"),
    [
        ("4400X0000", "0" + "0" * 256),
        ("4300M1746", "0" + "0" * 256),
        ("44FFX0001", "0" + "0" * 255),
        ("4500M0000" + "1" * 256, "0"),
        ("4640R08008", "0" + "0000" * 64),
        ("4620DR08008", "0" + "00000000" * 32),
        ("4610WX0000", "0" + "0000" * 16),
        ("4601WM1984", "00000"),
        ("4601DR08070", "000000000"),
        ("4601DR00015", "000000000"),
        ("4601RT0255", "00000"),
        ("4601DRC0254", "000000000"),
        ("4740R00000" + "FFFF" * 64, "0"),
        ("4720DD00000" + "12345678" * 32, "0"),
        ("4840" + "X0000" * 64, "0" + "0" * 64),
        ("4820" + "DR00000" * 32, "0" + "00000000" * 32),
        ("482C" + "DR00000" * 20 + "X0000" * 24, "0" + "00000000" * 20 + "0" * 24),
        ("4920" + "Y00001" * 32, "0"),
        ("4910" + "DR0000000000001" * 16, "0"),
        ("4E", ""),
        ("4E" + "x" * 256, "x" * 256),
        ("4E\x00\xff", "\x00\xff"),
    ],
)
def test_the_largest_that_is_allowed(slave: FaconSlave, request_data: str, answer: str) -> None:
    assert ask(slave, request_data) == answer


def test_file_registers_where_the_model_has_them() -> None:
    slave = FaconSlave({1: SimulatedPlc(model=MODELS["fbs-60mc"])})
    assert ask(slave, "4702F0819012345678") == "0"
    assert ask(slave, "4601DF08190") == "056781234"


def test_32_bit_registers_low_word_first(slave: FaconSlave) -> None:
    assert ask(slave, "4702R0000012345678") == "0"
    assert ask(slave, "4601DR00000") == "056781234"
    assert ask(slave, "4701DR0000189ABCDEF") == "0"
    assert ask(slave, "4603R00000") == "01234CDEF89AB"


def test_packed_words_lowest_bit_first(slave: FaconSlave) -> None:
    assert ask(slave, "4501M00081") == "0"
    assert ask(slave, "4501M00311") == "0"
    assert ask(slave, "4602WM0008") == "0" + "0001" + "0080"
    assert ask(slave, "4602DWM0000") == "0" + "80000100" + "00000000"
    assert ask(slave, "4701DWM0008F0000001") == "0"
    assert ask(slave, "4421M0008") == "0" + "1" + "0" * 27 + "1111" + "0"


def test_a_mixed_write_is_all_or_nothing(slave: FaconSlave) -> None:
    assert ask(slave, "4902R000011234M20021") == "A"
    assert ask(slave, "4601R00001") == "00000"


def test_disable_enable_set_reset(slave: FaconSlave) -> None:
    assert ask(slave, "423M0005") == "0"
    assert ask(slave, "421M0005") == "0"
    assert ask(slave, "4303M0004") == "0010"
    assert ask(slave, "4503M0004101") == "0"
    assert ask(slave, "4403M0004") == "0111"
    assert ask(slave, "424M0005") == "0"
    assert ask(slave, "4403M0004") == "0101"
    assert ask(slave, "422M0005") == "0"
    assert ask(slave, "4501M00051") == "0"
    assert ask(slave, "4401M0005") == "01"


def test_status(slave: FaconSlave, plc: SimulatedPlc) -> None:
    assert ask(slave, "40") == "0005400"
    flags = [
        "running",
        "battery_low",
        "ladder_checksum_error",
        "rom_pack",
        "watchdog",
        "id_set",
        "emergency_stop",
    ]
    for bit, flag in enumerate(flags):
        setattr(plc, flag, True)
        assert ask(slave, "40") == f"0{1 << bit:02X}5400"
        assert ask(slave, "53")[:3] == f"0{1 << bit:02X}"
        setattr(plc, flag, False)


@pytest.mark.parametrize(
    ("flag", "code"),
    [
        ("ladder_checksum_error", "5"),
        ("id_differs", "6"),
        ("syntax_error", "7"),
        ("unsupported_instruction", "9"),
    ],
)
def test_run_refused(slave: FaconSlave, plc: SimulatedPlc, flag: str, code: str) -> None:
    setattr(plc, flag, True)
    assert ask(slave, "411") == code
    assert ask(slave, "410") == "0"
    assert not plc.running
    setattr(plc, flag, False)
    assert ask(slave, "411") == "0"
    assert plc.running


def test_program_pages(slave: FaconSlave, plc: SimulatedPlc) -> None:
    assert ask(slave, "4F00CE") == "0" + plc.pages[206].hex().upper()
    assert ask(slave, "5000CE" + PAGE_HEX) == "0"
    assert plc.pages[206] == PAGE
    assert ask(slave, "4F00CE") == "0" + PAGE_HEX


def test_program_is_read_but_not_written_in_run(slave: FaconSlave, plc: SimulatedPlc) -> None:
    before = plc.pages[1]
    plc.running = True
    assert ask(slave, "4F0001")[0] == "0"
    assert ask(slave, "500001" + PAGE_HEX) == "4"
    plc.rom_pack = True
    assert ask(slave, "500001" + PAGE_HEX) == "3"
    assert plc.pages[1] == before


def test_program_commands_refused() -> None:
    slave = FaconSlave({1: SimulatedPlc(program_commands=False)})
    assert ask(slave, "4F0000") == "4"
    assert ask(slave, "500000" + PAGE_HEX) == "4"
    assert ask(slave, "53")[0] == "0"


def test_without_the_error_character() -> None:
    plc = SimulatedPlc()
    slave = FaconSlave({1: plc}, error_character=False)
    assert ask(slave, "4F0000") == plc.pages[0].hex().upper()
    assert ask(slave, "53") == plc.detailed_status().hex().upper()
    assert ask(slave, "4F00CF") == "A"
    assert ask(slave, "40")[0] == "0"
