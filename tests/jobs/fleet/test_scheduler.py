"""Lines side by side, PLCs of one line one after the other; limits, interrupts, faults."""

from __future__ import annotations

import os
import threading
from queue import Empty, SimpleQueue
from typing import TYPE_CHECKING

import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from fatektool.address import PlcAddress
from fatektool.errors import DeadlinePassed, LineError, TransportTimeout
from fatektool.jobs.fleet.lines import addresses_of, line_name
from fatektool.jobs.fleet.rounds import Fleet, Task, Turn
from fatektool.transport.base import Transport
from fatektool.transport.limit import Limit, LimitedTransport
from tests.guard import GUARD_S
from tests.night import examples
from tests.platforms import posix

if TYPE_CHECKING:
    from collections.abc import Callable
    from pathlib import Path


def work_of(*lines: str, work: Callable[[Turn[str]], str]) -> list[Task[str]]:
    return [Task(f"{line}{number}", line, work) for number, line in enumerate(lines)]


def run(tasks: list[Task[str]], jobs: int = 4, deadline_s: float = GUARD_S) -> list[str]:
    with Fleet(tasks, jobs, deadline_s) as fleet:
        return [turn.task.name for turn in fleet.ended() if turn is not None]


@settings(max_examples=examples(50), deadline=None)
@given(st.lists(st.sampled_from("abcd"), max_size=12), st.integers(1, 5))
def test_one_at_a_time_on_a_line_and_so_many_lines_at_once(lines: list[str], jobs: int) -> None:
    busy: set[str] = set()
    order: list[str] = []
    most = 0
    lock = threading.Lock()

    def work(turn: Turn[str]) -> str:
        nonlocal most
        with lock:
            assert turn.task.line not in busy
            busy.add(turn.task.line)
            order.append(turn.task.name)
            most = max(most, len(busy))
        with lock:
            busy.remove(turn.task.line)
        return turn.task.name

    tasks = work_of(*lines, work=work)
    assert sorted(run(tasks, jobs)) == sorted(task.name for task in tasks)
    assert most <= jobs
    for line in set(lines):
        of_line = [name for name in order if name[0] == line]
        assert of_line == [task.name for task in tasks if task.line == line]


def test_lines_run_side_by_side() -> None:
    """Each waits for all others: one after the other they would wait for ever."""
    meeting = threading.Barrier(3, timeout=GUARD_S)

    def work(_: Turn[str]) -> str:
        meeting.wait()
        return ""

    assert len(run(work_of("a", "b", "c", work=work), jobs=3)) == 3


def test_no_wait_is_one_that_ctrl_c_cannot_end() -> None:
    """On Windows a wait for a queue goes on to its end: so each has one, and is begun again."""
    waits: list[float | None] = []
    looked = threading.Event()

    class Queue(SimpleQueue[Turn[str]]):
        def get(self, block: bool = True, timeout: float | None = None) -> Turn[str]:
            waits.append(timeout)
            if len(waits) == 1:
                raise Empty
            looked.set()
            return super().get(block, timeout)

    def work(_: Turn[str]) -> str:
        looked.wait(GUARD_S)
        return ""

    fleet = Fleet(work_of("a", work=work), 1, GUARD_S)
    fleet._ended = Queue()
    with fleet:
        assert [turn.task.name for turn in fleet.ended() if turn is not None] == ["a0"]
    assert len(waits) > 1
    assert all(wait is not None and wait <= 1 for wait in waits)


def test_the_longest_line_begins_first() -> None:
    begun: list[str] = []

    def work(turn: Turn[str]) -> str:
        begun.append(turn.task.line)
        return ""

    run(work_of("a", "b", "b", "c", work=work), jobs=1)
    assert begun == ["b", "b", "a", "c"]


def test_a_line_that_hangs_delays_no_other() -> None:
    others_done = threading.Event()
    ended: list[str] = []

    def work(turn: Turn[str]) -> str:
        if turn.task.line == "hung":
            assert others_done.wait(GUARD_S)  # the others end while this one hangs
        return ""

    with Fleet(work_of("hung", "a", "b", "c", work=work), 2, GUARD_S) as fleet:
        for turn in fleet.ended():
            assert turn is not None
            ended.append(turn.task.line)
            if len(ended) == 3:
                others_done.set()
    assert ended == ["a", "b", "c", "hung"]


def test_what_goes_wrong_is_that_plc_s_alone() -> None:
    def work(turn: Turn[str]) -> str:
        if turn.task.line == "a":
            raise LineError("nobody there")
        if turn.task.line == "b":
            raise ZeroDivisionError("oops")
        return "done"

    with Fleet(work_of("a", "b", "c", work=work), 1, GUARD_S) as fleet:
        assert len(list(fleet.ended())) == 3
    a, b, c = fleet.turns
    assert isinstance(a.error, LineError)
    assert b.error is not None
    assert b.error.exit_code == 70
    assert b.error.message == "a fault of fatektool itself: ZeroDivisionError: oops"
    assert (c.result, c.error) == ("done", None)
    assert not any(turn.interrupted for turn in fleet.turns)


def test_a_limit_that_is_over_is_what_is_said() -> None:
    def work(turn: Turn[str]) -> str:
        assert turn.limit is not None
        while turn.limit.rest_s:
            pass
        raise LineError("no answer from station 1")  # what the link makes of it

    with Fleet(work_of("a", work=work), 1, 0.01) as fleet:
        list(fleet.ended())
    error = fleet.turns[0].error
    assert isinstance(error, DeadlinePassed)
    assert error.message == "stopped at the time limit of 0.01 s (no answer from station 1)"


def test_stop_ends_all_and_begins_no_other() -> None:
    begun = threading.Event()

    def work(turn: Turn[str]) -> str:
        begun.set()
        assert turn.limit is not None
        while turn.limit.rest_s:
            pass
        turn.limit.require_rest()
        return ""

    with Fleet(work_of("a", "a", "b", work=work), 1, 3600.0) as fleet:
        assert begun.wait(GUARD_S)
        fleet.stop()
        assert [turn.interrupted for turn in fleet.turns] == [True, True, True]
        assert [turn.duration_s is None for turn in fleet.turns] == [False, True, True]
    assert not [thread for thread in threading.enumerate() if thread.name.startswith("fatektool line")]


def test_looking_on() -> None:
    looked = threading.Event()

    def work(turn: Turn[str]) -> str:
        turn.progress("reading", 3, 9)
        assert looked.wait(GUARD_S)
        return ""

    with Fleet(work_of("a", work=work), 1, GUARD_S) as fleet:
        for turn in fleet.ended(look_s=0.01):
            running = fleet.running()
            if turn is None and running and running[0].phase == "reading":
                assert (running[0].done, running[0].total) == (3, 9)
                looked.set()
    assert looked.is_set()
    assert fleet.running() == []


# --- which share a line ------------------------------------------------------------------------------------


@pytest.mark.parametrize(
    ("one", "other", "same"),
    [
        ("tcp://10.0.0.1", "tcp://10.0.0.1:500", True),
        ("tcp://10.0.0.1", "udp://10.0.0.1", True),  # one lock, too
        ("tcp://10.0.0.1", "tcp://10.0.0.1:501", False),
        ("tcp://10.0.0.1", "tcp://10.0.0.2", False),
        ("tcp://Gate", "tcp://gate", True),
        ("tcp://gate", "tcp://10.0.0.9", True),  # its address
        ("sim:", "sim:", False),
        ("sim:a.state", "sim:./a.state", True),
        ("/dev/ttyUSB0", "/dev/../dev/ttyUSB0", os.name == "posix"),
        ("/dev/ttyUSB0", "/dev/ttyUSB1", False),
        ("rfc2217://g:4001", "RFC2217://g:4001", True),
    ],
)
def test_which_plcs_share_a_line(one: str, other: str, *, same: bool) -> None:
    addresses = {"gate": "10.0.0.9", "Gate": "10.0.0.9"}
    a, b = (line_name(PlcAddress(target), name, addresses) for target, name in ((one, "a"), (other, "b")))
    assert (a == b) is same


@posix("devices are files")
def test_two_names_of_one_device(tmp_path: Path) -> None:
    (tmp_path / "by-id").symlink_to("/dev/null")
    by_id = PlcAddress(str(tmp_path / "by-id"))
    assert line_name(by_id, "a", {}) == line_name(PlcAddress("/dev/null"), "b", {})


def test_names_of_hosts_are_looked_up() -> None:
    found = addresses_of(["tcp://localhost:1", "tcp://127.0.0.1:2", "sim:", "tcp://nobody.invalid"])
    assert found == {"localhost": "127.0.0.1"}


# --- the limit ---------------------------------------------------------------------------------------------


class Silence(Transport):
    """A medium on which nothing ever comes; its clock moves by what is waited."""

    name, line = "silence", None

    def __init__(self) -> None:
        self.now = 0.0
        self.clock = lambda: self.now
        self.written = b""

    def read(self, max_bytes: int, timeout_s: float) -> bytes:  # noqa: ARG002
        self.now += timeout_s
        raise TransportTimeout("nothing")

    def write(self, data: bytes) -> None:
        self.written += data

    def drain(self) -> bytes:
        return b"x"

    def close(self) -> None:
        self.written += b"closed"


def test_a_transport_ends_with_its_limit() -> None:
    inner = Silence()
    limited = LimitedTransport(inner, Limit(1.0, clock=inner.clock))
    limited.write(b"a")
    reads = 0
    while inner.now < 1.0:
        with pytest.raises(TransportTimeout):
            limited.read(1, 10.0)
        reads += 1
    assert (reads, inner.now) == (4, 1.0)  # a look each quarter of a second
    with pytest.raises(DeadlinePassed, match=r"the time limit of 1 s; .*--deadline"):
        limited.read(1, 10.0)
    with pytest.raises(DeadlinePassed):
        limited.write(b"b")
    assert limited.drain() == b"x"
    limited.close()
    assert inner.written == b"aclosed"


def test_a_limit_is_ended_from_outside() -> None:
    stop = threading.Event()
    limit = Limit(3600, stop)
    assert limit.require_rest() > 3000
    stop.set()
    assert limit.stopped
    with pytest.raises(DeadlinePassed):
        limit.require_rest()
