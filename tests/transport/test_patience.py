"""A connection that is refused, reset or closed is tried again after growing pauses; none is taken here."""

from __future__ import annotations

from typing import TYPE_CHECKING

import pytest

from fatektool.errors import TransportClosed, TransportTimeout
from fatektool.transport.base import Transport
from fatektool.transport.patience import Patience, PatientTransport

if TYPE_CHECKING:
    from collections.abc import Iterator


class Clock:
    """Counts the pauses, and takes none."""

    def __init__(self) -> None:
        self.pauses: list[float] = []
        self.notes: list[str] = []

    def patience(self, timeout_s: float = 0.5, retries: int = 3) -> Patience:
        return Patience(timeout_s, retries, self.pauses.append, self.notes.append)


def refused(*, may_return: bool = True) -> TransportClosed:
    return TransportClosed("tcp://gw: refused", hint="check it", may_return=may_return)


class Busy:
    """A gateway that refuses so many connections, and takes the next."""

    def __init__(self, refusals: int, *, may_return: bool = True) -> None:
        self.left = refusals
        self.tries = 0
        self._may_return = may_return

    def connect(self) -> str:
        self.tries += 1
        if self.left:
            self.left -= 1
            raise refused(may_return=self._may_return)
        return "connected"


@pytest.mark.parametrize("refusals", range(4))
def test_a_refused_connection_is_tried_again(refusals: int) -> None:
    clock, gateway = Clock(), Busy(refusals)
    assert clock.patience().opened(gateway.connect) == "connected"
    assert clock.pauses == [0.25, 0.5, 1.0][:refusals]
    assert len(clock.notes) == refusals
    assert all(note.startswith("tcp://gw: refused; next try in") for note in clock.notes)


def test_it_ends_with_the_retries() -> None:
    clock, gateway = Clock(), Busy(100)
    with pytest.raises(TransportClosed, match=r"tcp://gw: refused, in 4 tries; check it$") as caught:
        clock.patience().opened(gateway.connect)
    assert caught.value.hint == "check it"
    assert gateway.tries == 4
    assert sum(clock.pauses) == 1.75


def test_no_retries_are_one_try_and_no_pause() -> None:
    clock, gateway = Clock(), Busy(1)
    with pytest.raises(TransportClosed, match=r"tcp://gw: refused; check it$"):
        clock.patience(retries=0).opened(gateway.connect)
    assert not clock.pauses


def test_what_will_not_come_back_is_not_waited_for() -> None:
    clock, gateway = Clock(), Busy(1, may_return=False)
    with pytest.raises(TransportClosed, match=r"tcp://gw: refused; check it$"):
        clock.patience().opened(gateway.connect)
    assert gateway.tries == 1
    assert not clock.pauses


def test_pauses_are_bounded() -> None:
    patience = Patience(60.0, 5)
    assert [patience.pause_s(losses) for losses in (1, 2, 3, 10_000)] == [5.0] * 4
    assert [Patience(0.1, 5).pause_s(losses) for losses in (1, 2, 3, 4, 10_000)] == [0.05, 0.1, 0.2, 0.2, 0.2]


class Scripted(Transport):
    """A medium that does as its script says: bytes, or an error, for each read and write in turn."""

    name = "tcp://gw"

    def __init__(self, *script: bytes | Exception | None) -> None:
        self._script: Iterator[bytes | Exception | None] = iter(script)

    def _next(self) -> bytes:
        what = next(self._script)
        if isinstance(what, Exception):
            raise what
        return what or b""

    def read(self, max_bytes: int, timeout_s: float) -> bytes:  # noqa: ARG002
        return self._next()

    def write(self, data: bytes) -> None:  # noqa: ARG002
        self._next()

    def drain(self) -> bytes:
        return b""

    def close(self) -> None:
        pass


def talk(line: Transport, count: int) -> list[str]:
    """So many exchanges: write, then read until there is an answer or an error."""
    found = []
    for _ in range(count):
        try:
            line.write(b"?")
            text = line.read(64, 1)
            while not text.endswith(b"\x03"):
                text += line.read(64, 1)
            found.append("answer")
        except TransportClosed:
            found.append("closed")
        except TransportTimeout:
            found.append("silence")
    return found


ANSWER = (None, b"\x02answer\x03")


def test_a_gateway_that_says_why_it_closes_is_given_longer_each_time() -> None:
    clock = Clock()
    busy = (None, b"Port already in use\r\n", refused())
    line = PatientTransport(Scripted(*busy, *busy, *busy, *ANSWER), clock.patience())
    assert talk(line, 4) == ["closed", "closed", "closed", "answer"]
    assert clock.pauses == [0.25, 0.5, 1.0]


def test_an_answer_ends_the_row() -> None:
    clock = Clock()
    lost = (refused(),)
    line = PatientTransport(Scripted(*lost, *lost, *ANSWER, *ANSWER, *lost, *ANSWER), clock.patience())
    assert talk(line, 6) == ["closed", "closed", "answer", "answer", "closed", "answer"]
    assert clock.pauses == [0.25, 0.5, 0.25]


def test_silence_is_no_loss() -> None:
    clock = Clock()
    line = PatientTransport(Scripted(None, TransportTimeout("nothing"), *ANSWER), clock.patience())
    assert talk(line, 2) == ["silence", "answer"]
    assert not clock.pauses


def test_a_device_that_was_pulled_out_is_not_waited_for() -> None:
    clock = Clock()
    gone = refused(may_return=False)
    line = PatientTransport(Scripted(gone, gone), clock.patience())
    assert talk(line, 2) == ["closed", "closed"]
    assert not clock.pauses
