"""Every M-series command: its limits, and what each kind of wrong request is answered with."""

from __future__ import annotations

from dataclasses import replace

import pytest

from fatektool.errors import UsageError
from fatektool.simulator.build import build_simulation
from fatektool.simulator.models import MODELS
from fatektool.simulator.plc import SimulatedPlc
from fatektool.simulator.slaves.mseries.slave import MSeriesSlave
from fatektool.simulator.state import dump_state, parse_state
from tests.simulator.slaves.mseries_wire import ask, reply, request
from tests.simulator.wire import answers, sent

PAGES = SimulatedPlc(model=replace(MODELS["m-series"], ladder_words=64)).pages


@pytest.fixture
def plc() -> SimulatedPlc:
    return SimulatedPlc(model=replace(MODELS["m-series"], ladder_words=64), pages=PAGES)


@pytest.fixture
def slave(plc: SimulatedPlc) -> MSeriesSlave:
    return MSeriesSlave({1: plc})


FORMAT, VALUE, ADDRESS = "04", "02", "0a"

REFUSED = [
    # commands that are not of this protocol, the program's among them
    ("51", FORMAT),
    ("00", FORMAT),
    ("FF", FORMAT),
    ("4F0000", FORMAT),
    ("500000" + "00" * 128, FORMAT),
    # too much, too little
    ("4000", FORMAT),
    ("5300", FORMAT),
    ("41", FORMAT),
    ("410101", FORMAT),
    ("42", FORMAT),
    ("4201", FORMAT),
    ("4201'X'", FORMAT),
    ("4201'X'00", FORMAT),
    ("4201'X'001000", FORMAT),
    ("43", FORMAT),
    ("4301", FORMAT),
    ("4301'X'000000", FORMAT),
    ("4401'X'00", FORMAT),
    ("4502'Y'000001", FORMAT),
    ("4502'Y'0000010101", FORMAT),
    ("4601'R'00", FORMAT),
    ("4601'R'000C00", FORMAT),
    ("4702'R'000C0000", FORMAT),
    ("4701'R'000C00", FORMAT),
    ("4701'R'000C00000000", FORMAT),
    ("4701'DR'000C0000", FORMAT),
    ("4802'R'0001", FORMAT),
    ("4801'R'0001'R'0002", FORMAT),
    ("4902'Y'000001", FORMAT),
    ("4901'Y'000001'Y'", FORMAT),
    ("4901'R'000001", FORMAT),
    ("4E" + "78" * 257, FORMAT),
    # unknown elements, elements of the wrong kind
    ("4201'Q'0000", FORMAT),
    ("4201'x'0000", FORMAT),
    ("4201'W'0000", FORMAT),
    ("4201'R'0000", FORMAT),
    ("4401'WX'0000", FORMAT),
    ("4601'X'0000", FORMAT),
    ("4601'WR'0000", FORMAT),
    ("4801'Z'0000", FORMAT),
    ("4601580000", FORMAT),
    # control codes and states out of their range
    ("4102", VALUE),
    ("41FF", VALUE),
    ("4200'X'0000", VALUE),
    ("4205'X'0000", VALUE),
    ("4502'Y'00000102", VALUE),
    ("4901'Y'0000FF", VALUE),
    # n out of its range
    ("4600'R'0000", VALUE),
    ("4641'R'0000", VALUE),
    ("4621'DR'0000", VALUE),
    ("4621'DWM'0000", VALUE),
    ("4700'R'0000", VALUE),
    ("4741'R'0000" + "0000" * 65, VALUE),
    ("4721'DR'0000" + "00000000" * 33, VALUE),
    ("4800", VALUE),
    ("4841" + "'X'0000" * 65, VALUE),
    ("4821" + "'DR'0000" * 33, VALUE),
    ("4900", VALUE),
    ("4921" + "'Y'000001" * 33, VALUE),
    ("4911" + "'DR'000000000000" * 17, VALUE),
    # addresses past the model, packed words that do not exist
    ("4201'X'0100", ADDRESS),
    ("4400'X'0001", ADDRESS),
    ("4401'S'03E8", ADDRESS),
    ("4502'Y'00FF0101", ADDRESS),
    ("4601'R'1F88", ADDRESS),
    ("4602'R'1F87", ADDRESS),
    ("4601'R'FFFF", ADDRESS),
    ("4601'DR'1F87", ADDRESS),
    ("4601'RT'0100", ADDRESS),
    ("4601'RC'0100", ADDRESS),
    ("4601'D'1000", ADDRESS),
    ("4601'F'2000", ADDRESS),
    ("4601'DF'1FFF", ADDRESS),
    ("4601'WY'0004", ADDRESS),
    ("4601'WX'00F8", ADDRESS),
    ("4601'DWX'00E8", ADDRESS),
    ("4802'R'0001'X'FFFF", ADDRESS),
    ("4902'R'00010001'X'FFFF01", ADDRESS),
]


@pytest.mark.parametrize(("text", "code"), REFUSED)
def test_refused(slave: MSeriesSlave, plc: SimulatedPlc, text: str, code: str) -> None:
    assert ask(slave, text) == code
    assert plc.revision == 0


@pytest.mark.parametrize(
    ("text", "answer"),
    [
        ("4400'X'0000", "00" + "00" * 256),
        ("4300'M'06D2", "00" + "00" * 256),
        ("44FF'X'0001", "00" + "00" * 255),
        ("4500'M'0000" + "01" * 256, "00"),
        ("4640'R'1F48", "00" + "0000" * 64),
        ("4620'DR'1F48", "00" + "00000000" * 32),
        ("4610'WX'0000", "00" + "0000" * 16),
        ("4601'DR'1F86", "0000000000"),
        ("4601'DR'000F", "0000000000"),
        ("4601'RT'00FF", "000000"),
        ("4601'DRT'00FE", "0000000000"),
        ("4601'DRC'00FE", "0000000000"),
        ("4740'R'0000" + "FFFF" * 64, "00"),
        ("4720'DD'0000" + "12345678" * 32, "00"),
        ("4840" + "'X'0000" * 64, "00" * 65),
        ("4840" + "'WM'0000" * 64, "00" + "0000" * 64),
        ("4820" + "'DWM'0000" * 32, "00" + "00000000" * 32),
        ("482C" + "'DR'0000" * 20 + "'X'0000" * 24, "00" + "00000000" * 20 + "00" * 24),
        ("4920" + "'WM'00000001" * 32, "00"),
        ("4910" + "'DWM'000000000001" * 16, "00"),
        ("4E", ""),
        ("4E" + "55AA" * 128, "55aa" * 128),
    ],
)
def test_the_largest_that_is_allowed(slave: MSeriesSlave, text: str, answer: str) -> None:
    assert ask(slave, text) == answer


@pytest.mark.parametrize("symbol", ["WX", "WY", "WM", "WS", "WT", "WC", "RT", "RC", "R", "D", "F"])
def test_every_register_of_the_paper_and_its_double(slave: MSeriesSlave, symbol: str) -> None:
    written = "00000000" if symbol == "WX" else "5a5a8421"  # X follows its terminals
    assert ask(slave, f"4702'{symbol}'00105A5A8421") == "00"
    assert ask(slave, f"4602'{symbol}'0010") == "00" + written
    # In the double the lower address is the lower word.
    assert ask(slave, f"4801'D{symbol}'0010") == "00" + written[4:] + written[:4]


def test_file_registers(slave: MSeriesSlave, plc: SimulatedPlc) -> None:
    assert ask(slave, "4701'DF'1FFE12345678") == "00"
    assert ask(slave, "4602'F'1FFE") == "0056781234"
    assert ask(slave, "4901'F'0000BEEF") == "00"
    (again,) = parse_state(dump_state([plc]), "x")
    assert ask(MSeriesSlave({1: again}), "4801'F'0000") == "00beef"
    assert again.read_words("DF", 0x1FFE, 1) == [0x12345678]


def test_a_state_file_from_before_there_were_file_registers() -> None:
    (old,) = parse_state(dump_state([SimulatedPlc()]), "x")
    slave = MSeriesSlave({1: old})
    assert ask(slave, "4601'R'0000") == "000000"
    assert ask(slave, "4601'F'0000") == ADDRESS


def test_packed_words_lowest_bit_first(slave: MSeriesSlave) -> None:
    assert ask(slave, "4902'M'000801'M'001F01") == "00"
    assert ask(slave, "4602'WM'0008") == "0000010080"
    assert ask(slave, "4602'DWM'0000") == "008000010000000000"


def test_a_mixed_write_is_all_or_nothing(slave: MSeriesSlave) -> None:
    assert ask(slave, "4902'R'00011234'M'FFFF01") == ADDRESS
    assert ask(slave, "4601'R'0001") == "000000"


def test_disable_enable_set_reset(slave: MSeriesSlave) -> None:
    assert ask(slave, "4203'M'0005") == "00"
    assert ask(slave, "4201'M'0005") == "00"
    assert ask(slave, "4303'M'0004") == "00000100"
    assert ask(slave, "4503'M'0004010001") == "00"
    assert ask(slave, "4403'M'0004") == "00010101"
    assert ask(slave, "4204'M'0005") == "00"
    assert ask(slave, "4403'M'0004") == "00010001"
    assert ask(slave, "4202'M'0005") == "00"
    assert ask(slave, "4501'M'000501") == "00"
    assert ask(slave, "4401'M'0005") == "0001"


def test_status(slave: MSeriesSlave, plc: SimulatedPlc) -> None:
    """Bit 3 is the memory card, bit 5 the ID; the paper's example has both, in RUN."""
    plc.running = plc.rom_pack = plc.id_set = True
    assert ask(slave, "40") == "00290000"
    plc.running = plc.rom_pack = plc.id_set = False
    others = {1: "battery_low", 2: "ladder_checksum_error", 4: "watchdog", 6: "emergency_stop"}
    for bit, flag in others.items():
        setattr(plc, flag, True)
        assert ask(slave, "40") == f"00{1 << bit:02x}0000"
        setattr(plc, flag, False)


def test_detailed_status_has_the_64_bytes_of_facon(slave: MSeriesSlave) -> None:
    known = "00010240" + "00400100010000640064" + "07d203e800001f88100001000100"
    assert ask(slave, "53") == "00" + known + "00" * 36


@pytest.mark.parametrize(
    ("flag", "code"),
    [
        ("ladder_checksum_error", "05"),
        ("id_differs", "06"),
        ("syntax_error", "07"),
        ("unsupported_instruction", "09"),
    ],
)
def test_run_refused(slave: MSeriesSlave, plc: SimulatedPlc, flag: str, code: str) -> None:
    setattr(plc, flag, True)
    assert ask(slave, "4101") == code
    assert ask(slave, "4100") == "00"
    assert not plc.running
    setattr(plc, flag, False)
    assert ask(slave, "4101") == "00"
    assert plc.running


def test_lying_writes() -> None:
    built = build_simulation(protocol="mseries", faults=["lying-write=1"])
    line = built.line()
    for text in ("4501'Y'000001", "4203'Y'0000", "4701'R'00000001", "4901'R'00000001"):
        command = text[:2]
        assert sent(line, request(text)) == reply(command + "00")
    assert built.plcs[1].revision == 0
    assert sent(line, request("4501'Y'010001")) == reply("450A")
    assert sent(line, request("4101")) == reply("4100")
    assert built.plcs[1].running


def test_what_a_simulation_of_the_protocol_is() -> None:
    built = build_simulation((3,), protocol="mseries", ladder_words=64)
    assert built.plcs[3].model.name == "m-series"
    assert sent(built.line(), request("4601'F'0000", station=3)) == reply("46000000", station=3)
    assert build_simulation(model="fb-20mc", protocol="mseries").plcs[1].model.name == "fb-20mc"
    with pytest.raises(UsageError, match="protocol 'modbus': expected one of facon, mseries"):
        build_simulation(protocol="modbus")


def test_an_answer_of_another_station_has_its_own_crc(slave: MSeriesSlave) -> None:
    (answer,) = answers(slave, request("40"))
    assert slave.readdressed(answer, 7) == reply("4000000000", station=7)
