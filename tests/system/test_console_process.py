"""A process of Windows whose console is closed, or that gets Ctrl-C or Ctrl-Break in the middle of a job.

The system delivers such an event by a new thread in the process: ``CtrlRoutine`` of kernel32, which calls the
handlers. So do these tests: they need no window, and Wine 8 has no event for a closed console, and ends the
main thread at Ctrl-Break.
"""

from __future__ import annotations

import ctypes
import json
from typing import TYPE_CHECKING, Any

import pytest

from fatektool.program.archive import load_backup, save_backup
from tests.cli.running import check, process, served, started
from tests.held import HeldAnswer
from tests.platforms import windows
from tests.program.samples import backup, program

if TYPE_CHECKING:
    from collections.abc import Iterator
    from pathlib import Path

pytestmark = windows("events of a console")
WORDS = 1200  # 20 pages
OLD, NEW = program(WORDS, seed=1), program(WORDS, seed=2)
ALL_ACCESS = 0x1FFFFF
CTRL_C, CTRL_BREAK, CTRL_CLOSE, CTRL_LOGOFF = 0, 1, 2, 5


@pytest.fixture(autouse=True)
def place(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> Iterator[Path]:
    monkeypatch.setenv("FATEKTOOL_LOCK_DIR", str(tmp_path))
    (tmp_path / "work").mkdir()
    monkeypatch.chdir(tmp_path / "work")
    yield tmp_path / "work"
    monkeypatch.chdir(tmp_path)


def deliver(event: int, process_id: int) -> None:
    """Let the handlers of a process be called as the system calls them."""
    kernel: Any = ctypes.WinDLL("kernel32")  # type: ignore[attr-defined]
    for name in ("OpenProcess", "GetModuleHandleW", "GetProcAddress", "CreateRemoteThread"):
        getattr(kernel, name).restype = ctypes.c_void_p
    target = ctypes.c_void_p(kernel.OpenProcess(ALL_ACCESS, 0, process_id))
    library = ctypes.c_void_p(kernel.GetModuleHandleW("kernel32"))  # it has one address in all processes
    routine = ctypes.c_void_p(kernel.GetProcAddress(library, b"CtrlRoutine"))
    assert target.value
    assert routine.value
    argument = ctypes.c_void_p(event)
    thread = ctypes.c_void_p(kernel.CreateRemoteThread(target, None, 0, routine, argument, 0, None))
    assert thread.value
    for handle in (thread, target):
        kernel.CloseHandle(handle)


@pytest.mark.parametrize("event", [CTRL_C, CTRL_BREAK, CTRL_CLOSE, CTRL_LOGOFF])
def test_a_backup(place: Path, event: int) -> None:
    with served(OLD) as door:
        answer = HeldAnswer(door.simulation, "read_page", 10)
        with started("backup", "x.json", "-p", door.target) as job:
            with answer:
                deliver(event, job.pid)
            out, err = job.communicate()
    assert (job.returncode, out, err) == (130, "", "fatektool: interrupted\n")
    assert list(place.iterdir()) == []


@pytest.mark.parametrize("event", [CTRL_BREAK, CTRL_CLOSE])
def test_a_restore_is_completed_by_the_same_command(place: Path, event: int) -> None:
    save_backup(backup(NEW), place / "new.json")
    with served(OLD) as door:
        answer = HeldAnswer(door.simulation, "write_page", 10)
        words = ["restore", "new.json", "-p", door.target, "--yes", "--json"]
        with started(*words) as job:
            with answer:
                deliver(event, job.pid)
            out, err = job.communicate()
        assert job.returncode == 6
        error = json.loads(out)
        check(error, "error")
        details = error["error"]["details"]
        assert details["cause"] == "interrupted"
        assert details["command"] in err
        assert door.pages not in {OLD.pages, NEW.pages}
        (safety,) = place.glob("new.safety-*")
        assert load_backup(safety).program == OLD
        assert process(*words).code == 0
        assert door.pages == NEW.pages
