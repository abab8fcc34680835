"""What a modem target says: every option, in its range, and nothing that could become another command."""

from __future__ import annotations

from urllib.parse import quote

import pytest
from hypothesis import given
from hypothesis import strategies as st

from fatektool.errors import UsageError
from fatektool.transport.modem.dial import Call
from fatektool.transport.target import Target, TargetKind


@pytest.mark.parametrize(
    ("text", "path", "call"),
    [
        ("modem:/dev/ttyUSB0?number=0228082192", "/dev/ttyUSB0", Call("0228082192")),
        ("modem:COM3?number=1", "COM3", Call("1")),
        ("modem:socket://gateway:4001?number=1", "socket://gateway:4001", Call("1")),
        ("modem:spy:///dev/ttyS0?file=log?number=1", "spy:///dev/ttyS0?file=log", Call("1")),
        (
            "modem:/dev/ttyUSB0?number=0228082192&init=AT%26F",
            "/dev/ttyUSB0",
            Call("0228082192", init=("AT&F",)),
        ),
        (
            "modem:tty?init=ATZ&number=0,0228082192&init=at%26F1X3&dial=pulse",
            "tty",
            Call("0,0228082192", init=("ATZ", "at&F1X3"), pulse=True),
        ),
        ("modem:tty?number=%2A70,w0%23", "tty", Call("*70,W0#")),
        (
            "modem:tty?number=1&wait=90&tries=1&pause=0&guard=0.05&dial=tone",
            "tty",
            Call("1", wait_s=90, tries=1, pause_s=0, guard_s=0.05),
        ),
    ],
)
def test_a_modem_target(text: str, path: str, call: Call) -> None:
    target = Target.parse(text)
    assert target == Target(text, TargetKind.MODEM, path=path, call=call)
    assert target.is_url is ("://" in path)
    assert target.on_serial_port


def test_the_usual_call_is_that_of_the_paper() -> None:
    call = Call.parse("number=0228082192")
    assert (call.wait_s, call.tries, call.pause_s) == (60, 3, 11)
    assert call.command == "ATDT0228082192"
    assert Call.parse("number=1&dial=pulse").command == "ATDP1"


@pytest.mark.parametrize(
    ("text", "message"),
    [
        ("modem:", "expected modem:PORT"),
        ("modem:/dev/ttyUSB0", "expected modem:PORT"),
        ("modem:?number=1", "expected modem:PORT"),
        ("modem:tty?", "unknown option ''"),
        ("modem:tty?wait=60", "expected number="),
        ("modem:tty?number=", "number: expected 1 to 40"),
        ("modem:tty?number=1&number=2", "number is given twice"),
        (
            "modem:tty?number=1&init=AT&F",
            "unknown option 'F': expected init, number, .*'&' in a value as %26",
        ),
        ("modem:tty?number=1&color=red", "unknown option 'color'"),
        ("modem:tty?number=1&init=", "begins with AT, got ''"),
        ("modem:tty?number=1&init=%26F", "begins with AT, got '&F'"),
        ("modem:tty?number=1&init=ATZ%0DATD999", "begins with AT"),
        ("modem:tty?number=1&init=AT" + "x" * 77, "begins with AT"),
        ("modem:tty?number=1&dial=both", "dial: expected tone or pulse, got 'both'"),
        ("modem:tty?number=1&wait=0", "wait: expected 1 to 255 seconds"),
        ("modem:tty?number=1&wait=256", "wait: expected 1 to 255 seconds"),
        ("modem:tty?number=1&wait=nan", "wait: expected"),
        ("modem:tty?number=1&tries=0", "tries: expected 1 to 20"),
        ("modem:tty?number=1&tries=1e1", "tries: expected 1 to 20"),
        ("modem:tty?number=1&pause=601", "pause: expected 0 to 600"),
        ("modem:tty?number=1&guard=0", "guard: expected 0.02 to 5.1"),
    ],
)
def test_what_is_no_modem_target(text: str, message: str) -> None:
    with pytest.raises(UsageError, match=message) as caught:
        Target.parse(text)
    assert "\n" not in str(caught.value)


@pytest.mark.parametrize("more", ["\r", "\n", ";", "+", "AT", "H", "!", "/", " ", "\x00", "\u0661", "-", "%"])
def test_no_command_gets_into_a_number(more: str) -> None:
    for number in (f"022{more}808", f"{more}022", f"022{more}"):
        with pytest.raises(UsageError, match="number: expected"):
            Call.parse(f"number={quote(number)}")


@given(st.text(max_size=60))
def test_a_dial_command_holds_nothing_but_a_number(number: str) -> None:
    try:
        call = Call.parse(f"number={quote(number)}")
    except UsageError:
        return
    assert set(call.command.removeprefix("ATDT")) <= set("0123456789,*#W")
    assert 5 <= len(call.command) <= 44


@given(st.text())
def test_a_call_or_a_usage_error(query: str) -> None:
    try:
        call = Call.parse(query)
    except UsageError as error:
        assert "\n" not in str(error)  # noqa: PT017  # either way is fine, and each has something to hold
        return
    assert call.number
