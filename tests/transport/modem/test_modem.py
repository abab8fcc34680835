"""A modem in memory, on a clock of its own: each result, each retry, each way out, each at its time."""

from __future__ import annotations

import pytest

from fatektool.client import Plc
from fatektool.errors import LineError, TransportClosed
from fatektool.exchange.link import Link
from fatektool.protocol.fatek.facon.codec import FACON
from fatektool.simulator.build import build_simulation
from fatektool.transport.base import LineSettings
from fatektool.transport.memory import MemoryTransport
from fatektool.transport.modem.commands import Result, result_of
from fatektool.transport.modem.device import ModemTransport
from fatektool.transport.modem.dial import Call
from tests.rows import each
from tests.transport.modem.scripted import SILENCE, ScriptedModem

NUMBER = "0228082192"


class Port(MemoryTransport):
    """A port in memory, with DTR if the modem has it."""

    def __init__(self, modem: ScriptedModem) -> None:
        super().__init__(modem, "/dev/ttyUSB0")
        self._modem = modem
        self.dtr = [True]

    def set_dtr(self, *, on: bool) -> bool:
        self.dtr.append(on)
        if self._modem.dtr and not on:
            self._coming.extend(self._modem.lose_dtr(self.clock()))
        return self._modem.dtr


def called(modem: ScriptedModem, call: Call | None = None) -> ModemTransport:
    """A transport that is connected."""
    transport = ModemTransport(Port(modem), call or Call(NUMBER))
    try:
        transport.connect()
    except BaseException:
        transport.close()
        raise
    modem.settle(transport.clock())
    return transport


def no_connection(modem: ScriptedModem, call: Call | None = None) -> LineError:
    with pytest.raises(LineError) as caught:
        called(modem, call)
    error = caught.value
    assert error.exit_code == 3
    assert error.hint
    assert "\n" not in str(error)
    assert not modem.online
    return error


def dialled(modem: ScriptedModem) -> list[str]:
    return [command for command in modem.commands if command.startswith("ATD")]


def facon(transport: ModemTransport) -> Plc:
    return Plc(Link(transport, FACON, 1, LineSettings()), "modem")


# --- the way there ---------------------------------------------------------------------------------------


@each("outcome", ["CONNECT", "CONNECT 9600", "CONNECT 9600/ARQ/V32/LAPM"])
@each("echo", [True, False])
@each("figures", [True, False])
@each("stubborn", [True, False])
def test_facon_over_a_call(outcome: str, *, echo: bool, figures: bool, stubborn: bool) -> None:
    plc = build_simulation(ladder_words=400)
    modem = ScriptedModem([outcome], plc.line(), echo=echo, figures=figures, stubborn=stubborn)
    with called(modem) as transport:
        assert modem.online
        asked = facon(transport)
        assert asked.brief_status().flags.running is False
        assert asked.read_page(1) == plc.plcs[1].pages[1]
        assert asked.link.counters.trouble == 0
    assert not modem.online
    assert (modem.hung_up, modem.guard_broken) == (1, False)
    assert dialled(modem) == [f"ATDT{NUMBER}"]


def test_the_commands_in_their_order() -> None:
    modem = ScriptedModem()
    with called(modem, Call("0,022", init=("AT&F", "ATX3"), pulse=True, wait_s=90.5, guard_s=0.5)):
        pass
    assert modem.commands == [
        "ATE0Q0V1",
        "AT&F",
        "ATX3",
        "ATE0Q0V1",
        "ATS7=91",
        "ATS2=43S12=25",
        "ATDP0,022",
        "ATH",
    ]


def test_a_modem_without_those_registers_calls_all_the_same() -> None:
    modem = ScriptedModem(answers={"ATS7=60": "ERROR", "ATS2=43S12=50": "ERROR"})
    with called(modem):
        assert modem.online


def test_what_it_says_behind_connect_is_nobodys_answer() -> None:
    modem = ScriptedModem(["CONNECT 9600\r\nPROTOCOL: LAP-M\r\nCOMPRESSION: NONE"])
    with called(modem) as transport:
        assert transport.drain() == b""


@each(
    ("line", "result"),
    [
        ("OK", Result.OK),
        ("0", Result.OK),
        ("connect", Result.CONNECT),
        ("CONNECT 115200/V42BIS", Result.CONNECT),
        ("1", Result.CONNECT),
        ("5", Result.CONNECT),
        ("10", Result.CONNECT),
        ("NO CARRIER", Result.NO_CARRIER),
        (" NO CARRIER ", Result.NO_CARRIER),
        ("3", Result.NO_CARRIER),
        ("ERROR", Result.ERROR),
        ("+CME ERROR: 3", Result.ERROR),
        ("4", Result.ERROR),
        ("NO DIALTONE", Result.NO_DIALTONE),
        ("NO DIAL TONE", Result.NO_DIALTONE),
        ("6", Result.NO_DIALTONE),
        ("BUSY", Result.BUSY),
        ("7", Result.BUSY),
        ("NO ANSWER", Result.NO_ANSWER),
        ("8", Result.NO_ANSWER),
        ("VOICE", Result.VOICE),
        ("BLACKLISTED", Result.BARRED),
        ("DELAYED 60", Result.BARRED),
        ("2", None),
        ("RING", None),
        ("RINGING", None),
        ("CARRIER 9600", None),
        ("ATDT7", None),
        ("13", None),
        ("OKAY", None),
        ("", None),
    ],
)
def test_what_a_line_means(line: str, result: Result | None) -> None:
    assert result_of(line) is result


# --- no connection ------------------------------------------------------------------------------------------


@each("figures", [False, True])
@each(
    ("outcome", "tries", "advice"),
    [
        ("BUSY", 3, "call later"),
        ("NO CARRIER", 3, "check the number"),
        ("NO ANSWER", 3, "that it answers calls"),
        ("NO DIALTONE", 1, "telephone line is plugged in"),
        ("ERROR", 1, "does not accept the number"),
        ("OK", 1, "did not call"),
    ],
)
def test_each_outcome_has_its_own_words(outcome: str, tries: int, advice: str, *, figures: bool) -> None:
    modem = ScriptedModem([outcome], figures=figures, stubborn=figures)
    error = no_connection(modem)
    count = "3 tries" if tries == 3 else "1 try"
    said = ", ".join([outcome] * tries)
    assert error.message == f"/dev/ttyUSB0: no connection to {NUMBER} in {count}: the modem reported {said}"
    assert advice in (error.hint or "")
    assert error.details == {"result": outcome, "tries": tries}
    assert len(dialled(modem)) == tries


@pytest.mark.parametrize(("outcome", "advice"), [("VOICE", "a person"), ("BLACKLISTED", "so soon")])
def test_who_should_not_be_called_again_is_not(outcome: str, advice: str) -> None:
    modem = ScriptedModem([outcome])
    assert advice in (no_connection(modem).hint or "")
    assert len(dialled(modem)) == 1


def test_a_call_without_an_outcome_is_given_up_after_its_time() -> None:
    modem = ScriptedModem([SILENCE])
    transport = ModemTransport(Port(modem), Call(NUMBER))
    with transport, pytest.raises(LineError, match="nothing for 60 s, nothing for 60 s, nothing for 60 s"):
        transport.connect()
    assert (len(dialled(modem)), modem.aborted) == (3, 3)
    assert transport.clock() == pytest.approx(3 * 60 + 2 * 11, abs=0.1)


def test_the_third_try_may_find_a_connection() -> None:
    modem = ScriptedModem(["BUSY", SILENCE, "CONNECT 2400"])
    transport = called(modem)
    assert modem.online
    assert transport.clock() == pytest.approx(60 + 2 * 11 + 0.2, abs=0.1)
    transport.close()
    assert not modem.online


def test_tries_and_their_pause_are_the_callers() -> None:
    modem = ScriptedModem(["BUSY"])
    transport = ModemTransport(Port(modem), Call(NUMBER, tries=5, pause_s=0))
    with (
        transport,
        pytest.raises(LineError, match=r"5 tries: the modem reported BUSY(, BUSY){4}"),
    ):
        transport.connect()
    assert transport.clock() < 1


def test_a_connection_in_the_moment_it_is_given_up_is_one() -> None:
    class Crossing(ScriptedModem):
        def receive(self, data: bytes, now: float) -> list[tuple[float, bytes]]:
            if data == b"\r" and self.dialling_until is not None:
                self.dialling_until = now
                return []  # too late: the other modem's carrier is there, and CONNECT is on its way
            return super().receive(data, now)

    modem = Crossing(["CONNECT"], ring_s=60.5)
    with called(modem):
        pass
    assert (modem.online, modem.hung_up) == (False, 1)


def test_a_silent_modem_is_no_silent_call() -> None:
    modem = ScriptedModem(dead=True)
    error = no_connection(modem)
    assert error.message.startswith("/dev/ttyUSB0: no modem answers ATE0Q0V1 at ")
    assert error.message.endswith("nothing received")
    assert "check that the modem is on" in (error.hint or "")


@pytest.mark.parametrize("said", [b"\xff\x00\x7f", b"ATE0Q0V1\r", b"\r\nHELLO\r\n" * 99])
def test_what_is_no_modem(said: bytes) -> None:
    modem = ScriptedModem(echo=False, answers={"ATE0Q0V1": said})
    error = no_connection(modem)
    assert "which is not a result" in error.message
    assert len(error.message) < 250
    assert dialled(modem) == []


def test_a_modem_with_parity_is_understood() -> None:
    modem = ScriptedModem(echo=False, answers={"ATE0Q0V1": b"\x8d\x0a\xcf\x4b\x8d\x0a"})
    with called(modem):
        assert modem.online


@pytest.mark.parametrize(
    ("answer", "said"), [("ERROR", "ERROR"), (b"", "nothing"), ("NO CARRIER", "NO CARR")]
)
def test_an_init_that_the_modem_refuses(answer: str | bytes, said: str) -> None:
    modem = ScriptedModem(answers={"AT&Q9": answer})
    error = no_connection(modem, Call(NUMBER, init=("AT&Q9",)))
    assert f"AT&Q9 to the modem: expected OK, got {said}" in error.message
    assert "init=" in (error.hint or "")
    assert dialled(modem) == []


def test_a_call_that_a_killed_process_left_behind_is_ended_first() -> None:
    modem = ScriptedModem(online=True)
    with called(modem):
        assert modem.hung_up == 1
        assert modem.online
    assert modem.hung_up == 2


# --- the way out --------------------------------------------------------------------------------------------


@pytest.mark.parametrize("dtr", [False, True])
def test_close_hangs_up_once_and_may_be_called_again(*, dtr: bool) -> None:
    modem = ScriptedModem(dtr=dtr)
    transport = called(modem)
    transport.close()
    transport.close()
    assert (modem.online, modem.hung_up, modem.guard_broken) == (False, 1, False)
    assert ("ATH" in modem.commands) is not dtr
    assert transport.drain() == b""
    for use in (lambda: transport.read(1, 0), lambda: transport.write(b"x")):
        with pytest.raises(TransportClosed):
            use()


def test_a_wire_that_means_nothing_to_the_modem_is_no_way_to_hang_up() -> None:
    class Deaf(ScriptedModem):
        def lose_dtr(self, now: float) -> list[tuple[float, bytes]]:
            assert now >= 0
            return []

    modem = Deaf(dtr=True)
    port = Port(modem)
    transport = ModemTransport(port, Call(NUMBER))
    transport.connect()
    transport.close()
    assert (modem.online, modem.hung_up) == (False, 1)
    assert port.dtr == [True, False, True]


@pytest.mark.parametrize("error", [ValueError(), KeyboardInterrupt(), LineError("x")])
def test_whatever_ends_the_work_ends_the_call(error: BaseException) -> None:
    modem = ScriptedModem()
    with pytest.raises(type(error)), called(modem):
        raise error
    assert (modem.online, modem.hung_up) == (False, 1)


@pytest.mark.parametrize("dtr", [False, True])
def test_an_interrupt_while_it_calls_ends_the_call(*, dtr: bool) -> None:
    class Impatient(Port):
        def read(self, max_bytes: int, timeout_s: float) -> bytes:
            if timeout_s > 30:
                raise KeyboardInterrupt
            return super().read(max_bytes, timeout_s)

    modem = ScriptedModem([SILENCE], dtr=dtr)
    with pytest.raises(KeyboardInterrupt), ModemTransport(Impatient(modem), Call(NUMBER)) as transport:
        transport.connect()
    assert (modem.online, modem.dialling_until, modem.aborted) == (False, None, 1)


def test_the_port_is_closed_even_if_hanging_up_is_interrupted() -> None:
    class Cut(Port):
        closed = False

        def close(self) -> None:
            self.closed = True
            super().close()

        def set_dtr(self, *, on: bool) -> bool:
            raise KeyboardInterrupt("on" if on else "off")

    port = Cut(ScriptedModem())
    transport = ModemTransport(port, Call(NUMBER))
    transport.connect()
    with pytest.raises(KeyboardInterrupt):
        transport.close()
    assert port.closed


def test_a_modem_that_does_not_say_that_it_hung_up_is_told_of() -> None:
    modem, notes = ScriptedModem(), list[str]()
    transport = ModemTransport(Port(modem), Call(NUMBER), notes.append)
    transport.connect()
    modem.dead = True
    transport.close()
    assert notes[-1] == "/dev/ttyUSB0: the modem does not confirm that it hung up"
    assert f"to the modem: ATDT{NUMBER}" in notes
    assert "from the modem: 'CONNECT 9600'" in notes


# --- the end of the call in the middle ----------------------------------------------------------------------


def read_all(transport: ModemTransport, most: int, heard: bytearray) -> None:
    while True:
        heard += transport.read(most, 1.0)


@each("cut", range(1, 15))
@each("most", [1, 3, 4096])
def test_the_end_of_a_call_is_told_after_what_came_before_it(cut: int, most: int) -> None:
    class Other:
        def receive(self, data: bytes, now: float) -> list[tuple[float, bytes]]:
            wire = b"0140\r\nNO CARRIER\r\n" + b"rest"
            return [(now, wire[:cut]), (now, wire[cut:])] if data == b"x" else []

        datagram = receive

    modem = ScriptedModem(plc=Other())
    transport = called(modem)
    transport.write(b"x")
    heard = bytearray()
    with pytest.raises(TransportClosed, match="the call ended"):
        read_all(transport, most, heard)
    assert heard.startswith(b"0140")
    assert b"0140\r\nNO CARRIER\r".startswith(heard)
    with pytest.raises(TransportClosed, match="run again"):
        transport.write(b"y")
    assert transport.drain() == b""
    transport.close()
    assert (modem.online, modem.hung_up) == (
        False,
        1,
    )  # it was the other side who said so: the call was still up


def test_a_carrier_lost_in_the_middle_ends_the_exchange_and_hangs_up() -> None:
    modem = ScriptedModem(plc=build_simulation(ladder_words=400).line(), carrier_bytes=200)
    with called(modem) as transport:
        plc = facon(transport)
        with pytest.raises(TransportClosed, match=r"modem:/dev/ttyUSB0 to 0228082192: the call ended"):
            plc.read_pages(range(8))
    assert modem.commands[-1] == "ATH"
    assert not modem.guard_broken


def test_words_of_a_plc_do_not_end_a_call() -> None:
    class Talker:
        def receive(self, data: bytes, now: float) -> list[tuple[float, bytes]]:
            return [(now, data)]

        datagram = receive

    with called(ScriptedModem(plc=Talker())) as transport:
        for words in (b"NO CARRIER", b"\r\nNO CARRIER", b"x", b"NO CARRIER\r\n"):
            transport.write(words)
            assert transport.read(64, 1.0) == words


def test_a_call_has_no_speed_to_change_and_is_not_made_anew() -> None:
    modem = ScriptedModem()
    with called(modem) as transport:
        transport.configure(LineSettings(4800, "8N1"))
        transport.renew()
        assert modem.online
    assert len(dialled(modem)) == 1
