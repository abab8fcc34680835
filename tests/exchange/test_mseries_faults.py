"""Bad lines: what is read is right or refused, and a write that is reported done is done."""

from __future__ import annotations

import pytest

from fatektool.errors import FatektoolError, LineError
from fatektool.jobs.elements.reads import read_elements
from fatektool.protocol.commands import Loopback
from fatektool.protocol.elements import Element
from tests.rigs import Simulated, simulated

KINDS = ["drop", "flip", "truncate", "noise", "duplicate", "late", "slow", "wrong-station", "echo"]
R0 = Element("R", 0)
MIXED = [
    Element(*pair) for pair in (("R", 7), ("DR", 100), ("X", 3), ("WM", 8), ("DWY", 0), ("RT", 5), ("F", 9))
]
SAVED = [0x5110 + place for place in range(200)]  # words that look like headers


def plant(*faults: str, seed: int = 0, baud: float | None = None, retries: int = 3) -> Simulated:
    """A PLC with something in its memory, behind a bad line."""
    made = simulated(
        protocol="mseries", ladder_words=64, faults=faults, seed=seed, baud=baud, retries=retries
    )
    made.device.write_words("R", 0, SAVED)
    made.device.write_words("F", 9, [0x55AA])
    return made


def expected(element: Element) -> int:
    at = element.address
    if element.symbol == "R":
        return SAVED[at]
    if element.symbol == "DR":
        return SAVED[at + 1] << 16 | SAVED[at]
    return 0x55AA if element.symbol == "F" else 0


ALL = [Element("R", address) for address in range(200)] + MIXED


@pytest.mark.parametrize("echo", [[], ["echo=1"]], ids=["", "echo"])
@pytest.mark.parametrize("kind", KINDS)
@pytest.mark.parametrize("probability", [0.1, 0.4, 1.0])
def test_no_read_is_ever_wrong(kind: str, probability: float, echo: list[str]) -> None:
    faults = [f"{kind}={probability}"] if kind != "echo" or not echo else []
    for seed in range(6):
        made = plant(*faults, *echo, seed=seed, baud=9600 if seed % 2 else None)
        try:
            reading = read_elements(made.plc, ALL)
        except LineError:
            continue
        assert not reading.errors
        assert reading.values == {element: expected(element) for element in ALL}


@pytest.mark.parametrize("kind", KINDS)
def test_a_slightly_bad_line_still_gives_the_values(kind: str) -> None:
    for seed in range(6):
        made = plant(f"{kind}={1 if kind == 'echo' else 0.05}", seed=seed, baud=9600)
        reading = read_elements(made.plc, ALL)
        assert reading.values == {element: expected(element) for element in ALL}


@pytest.mark.parametrize("kind", KINDS)
@pytest.mark.parametrize("probability", [0.1, 0.4, 1.0])
def test_a_write_that_is_done_is_done(kind: str, probability: float) -> None:
    done = 0
    for seed in range(6):
        made = plant(f"{kind}={probability}", seed=seed)
        values = [seed + place for place in range(64)]
        try:
            made.plc.write_registers(R0, values)
            made.plc.write_discretes(Element("M", 0), [True, False, True])
        except LineError:
            continue
        done += 1
        assert made.device.read_words("R", 0, 64) == values
        assert made.device.read_discretes("M", 0, 3) == b"\1\0\1"
    assert done or probability > 0.1


@pytest.mark.parametrize("kind", [kind for kind in KINDS if kind != "wrong-station"])
def test_run_and_stop_on_a_bad_line(kind: str) -> None:
    """STOP's answer has its request's payload; the header alone says that it is one."""
    for seed in range(4):
        made = plant(f"{kind}={1 if kind == 'echo' else 0.2}", seed=seed)
        for run in (True, False):
            try:
                (made.plc.run if run else made.plc.stop)()
            except FatektoolError:
                continue
            assert made.device.running is run


def test_on_an_echoing_line_nothing_but_answers_is_taken() -> None:
    made = plant("echo=1")
    link = made.plc.link
    assert made.plc.loopback(b"\x51\x10\x00\x02") == b"\x51\x10\x00\x02"  # the first exchange of all
    assert link.echoes is True
    made.plc.stop()
    assert link.counters.echoes >= 2
    assert link.counters.strays == 0


def test_a_silent_plc_is_not_taken_for_its_echo() -> None:
    made = plant("echo=1", "drop=1", retries=1)
    for ask in (made.plc.stop, made.plc.brief_status, lambda: made.plc.loopback(b"ABC")):
        with pytest.raises(LineError, match="its own request only"):
            ask()


def test_a_clean_line_costs_no_exchange_more() -> None:
    """Who speaks is in the header: nothing has to be learnt of the line before a loopback."""
    made = plant()
    made.plc.loopback(bytes(range(256)))
    assert made.plc.link.counters.exchanges == 1
    made.plc.link.fence()
    assert made.plc.link.counters.exchanges == 2
    assert made.plc.link.echoes is False


def test_a_length_that_lies_before_the_answer_costs_time_and_no_try() -> None:
    """Noise that begins like a long frame swallows the answer until its time is over; then it is found."""
    made = plant()
    transport = made.plc.link.transport
    heard = iter([bytes.fromhex("52 10 01 90")])
    drained, read = transport.drain, transport.read

    def behind_noise(max_bytes: int, timeout_s: float) -> bytes:
        return next(heard, b"") + read(max_bytes, timeout_s)

    transport.read = behind_noise  # type: ignore[method-assign]
    transport.drain = drained  # type: ignore[method-assign]
    assert made.plc.loopback(b"ABC") == b"ABC"
    counters = made.plc.link.counters
    assert (counters.exchanges, counters.timeouts, counters.garbled) == (1, 0, 1)


@pytest.mark.parametrize("size", [0, 1, 2, 255, 256])
def test_loopbacks_of_any_bytes(size: int) -> None:
    data = bytes(range(256))[::-1][:size]
    assert plant().plc.link.ask(Loopback(data)) == data
