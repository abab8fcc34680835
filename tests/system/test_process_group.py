"""Programs that are ended with all that they started: a process group, on Windows a job object."""

from __future__ import annotations

import os
import subprocess
import sys
from typing import TYPE_CHECKING

import pytest

from fatektool.jobs.fleet import alarms
from fatektool.system import windows_processes
from fatektool.system.process_group import ProcessGroup
from tests.rows import each

if TYPE_CHECKING:
    from pathlib import Path


def test_a_command_is_ended_with_all_that_it_started(tmp_path: Path) -> None:
    """The child of the program is known to run by its file, and to have ended by its closed pipe."""
    child = f"open({str(tmp_path / 'runs')!r}, 'w').close(); import threading; threading.Event().wait()"
    script = f"import subprocess, sys; subprocess.run([sys.executable, '-c', {child!r}])"
    reader, writer = os.pipe()
    os.set_inheritable(writer, True)  # noqa: FBT003
    group = ProcessGroup([sys.executable, "-c", script], stdout=writer, close_fds=False)
    os.close(writer)
    while not (tmp_path / "runs").exists():
        assert group.process.poll() is None
    group.kill()
    group.close()
    assert os.read(reader, 1) == b""
    os.close(reader)
    assert group.process.returncode


def test_what_a_command_leaves_in_the_background_goes_on() -> None:
    group = ProcessGroup([sys.executable, "-c", "pass"], stdout=subprocess.DEVNULL)
    assert group.process.wait() == 0
    group.terminate()
    group.close()


def test_the_wait_for_a_command_is_one_that_ctrl_c_ends(monkeypatch: pytest.MonkeyPatch) -> None:
    """A wait of Windows for a process goes on to its end: so each is short."""
    group = ProcessGroup([sys.executable, "-c", "import threading; threading.Event().wait()"])
    waits: list[float | None] = []
    times = iter([0.0, 0.0, 10.0, 29.9])

    def wait(timeout: float | None = None) -> int:
        waits.append(timeout)
        raise subprocess.TimeoutExpired("", timeout or 0)

    with monkeypatch.context() as patched:
        patched.setattr(group.process, "wait", wait)
        patched.setattr("fatektool.system.process_group.time.perf_counter", lambda: next(times))
        with pytest.raises(subprocess.TimeoutExpired):
            group.wait(30)
    assert [round(each or 0, 3) for each in waits] == [0.2, 0.2, 0.1]
    group.kill()
    group.close()


def test_a_group_that_windows_does_not_make_is_ended_by_its_program(monkeypatch: pytest.MonkeyPatch) -> None:
    """An older Windows has a process in one job alone: then at least the program itself is ended."""
    group = ProcessGroup([sys.executable, "-c", "import threading; threading.Event().wait()"])
    monkeypatch.setattr("fatektool.system.process_group.sys.platform", "win32")
    group.kill()
    assert group.process.returncode
    group.close()


class Jobs:
    """The functions of kernel32.dll for job objects."""

    def __init__(self, made: int, *, assigned: bool) -> None:
        self.calls: list[str] = []
        self.CreateJobObjectW = type("F", (), {"__call__": lambda *_: self.did("create", made)})()
        self.AssignProcessToJobObject = lambda *_: self.did("assign", assigned)
        self.TerminateJobObject = lambda *_: self.did("end", 1)
        self.CloseHandle = lambda *_: self.did("close", 1)

    def did(self, call: str, result: int) -> int:
        self.calls.append(call)
        return result


@each(
    ("made", "assigned", "expected"),
    [
        (7, True, ["create", "assign", "end", "close"]),
        (7, False, ["create", "assign", "close"]),
        (0, False, ["create"]),
    ],
)
def test_a_job_of_windows(made: int, *, assigned: bool, expected: list[str]) -> None:
    jobs = Jobs(made, assigned=assigned)
    with pytest.MonkeyPatch.context() as patched:
        patched.setattr(windows_processes, "_KERNEL", jobs)
        job = windows_processes.Job.of(1)
        assert (job is not None) is assigned
        if job is not None:
            job.end()
            job.close()
    assert jobs.calls == expected


@each(
    ("number", "command", "said"),
    [
        (
            193,
            "alarm.ps1 --now",
            "alarm.ps1: it is not a program; for a script name the program that runs it",
        ),
        (2, "echo x", "echo: there is no such program; for a command of a shell write cmd /c before it"),
        (5, "C:\\x.exe", "C:\\x.exe: as the system says"),
    ],
)
def test_what_windows_does_not_start(number: int, command: str, said: str) -> None:
    def start(*_: object, **__: object) -> None:
        error = OSError(8, "as the system says")
        error.winerror = number  # type: ignore[attr-defined, unused-ignore]  # as Windows sets it
        raise error

    event = alarms.Event("press", "COM3", 1, "backup", "failure", 3, "no answer", "", "2026-11-22T03:15:00Z")
    with pytest.MonkeyPatch.context() as patched:
        patched.setattr(subprocess, "Popen", start)
        assert alarms.run_command(command, event) == f"cannot start {said}"
