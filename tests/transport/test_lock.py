"""One process a line: real processes, and one clock that is not."""

from __future__ import annotations

import contextlib
import os
import re
import subprocess
import sys
import tempfile
from pathlib import Path
from typing import TYPE_CHECKING

import pytest

from fatektool.errors import PortBusy, UsageError
from fatektool.transport import lock as lock_module
from fatektool.transport.lock import PortLock
from tests.platforms import posix, symbolic_links
from tests.users import folder_for_all, no_root, not_as_root_alone

if TYPE_CHECKING:
    from collections.abc import Iterator

RESOURCE = "/dev/ttyUSB0"
HOLDER = """
import sys
from fatektool.transport.lock import PortLock
lock = PortLock(sys.argv[1], 0)
lock.acquire()
print("locked", flush=True)
sys.stdin.readline()
lock.release()
print("released", flush=True)
sys.stdin.readline()
"""


@contextlib.contextmanager
def holding(resource: str = RESOURCE) -> Iterator[subprocess.Popen[str]]:
    """Another process that holds the lock; a line to it makes it let go, another ends it."""
    with subprocess.Popen(
        [sys.executable, "-c", HOLDER, resource], stdin=subprocess.PIPE, stdout=subprocess.PIPE, text=True
    ) as process:
        try:
            assert process.stdout is not None
            assert process.stdout.readline() == "locked\n"
            yield process
        finally:
            process.kill()


def let_go(process: subprocess.Popen[str]) -> None:
    assert process.stdin is not None
    assert process.stdout is not None
    process.stdin.write("\n")
    process.stdin.flush()
    assert process.stdout.readline() == "released\n"


class Clock:
    """A clock that moves when somebody sleeps."""

    def __init__(self) -> None:
        self.now = 100.0
        self.slept: list[float] = []

    def __call__(self) -> float:
        return self.now

    def sleep(self, seconds: float) -> None:
        self.slept.append(seconds)
        self.now += seconds


def held_by(lock: PortLock) -> int | None:
    found = lock.holder()
    return None if found is None else found.pid


def held_by_nobody(resource: str = RESOURCE) -> bool:
    lock = PortLock(resource, 0)
    try:
        lock.acquire()
    except PortBusy:
        return False
    lock.release()
    return True


def test_another_process_is_named() -> None:
    """At once, and again in the error: which process, which command, since when."""
    clock, told = Clock(), list[str]()
    with holding() as process:
        lock = PortLock(RESOURCE, 2.0, waiting=told.append, clock=clock, sleep=clock.sleep)
        with pytest.raises(PortBusy) as caught:
            lock.acquire()
        error = caught.value
        holder = lock.holder()
        assert holder is not None
        assert (holder.pid, holder.command) == (process.pid, f"-c {RESOURCE}")
        assert re.fullmatch(r"\d{4}-\d\d-\d\dT\d\d:\d\d:\d\dZ", holder.since)
        who = f"process {process.pid} (-c {RESOURCE}, since {holder.since})"
        assert told == [f"{RESOURCE} is in use by {who}: waiting, for 2 s at most"]
        assert error.message == f"{RESOURCE} is in use by {who}: waited 2 s"
        assert "--lock-wait" in str(error.hint)
        assert error.details == {
            "holder": process.pid,
            "command": holder.command,
            "since": holder.since,
            "resource": RESOURCE,
        }
        assert error.exit_code == 3
    assert 102.0 <= clock.now < 102.1
    assert max(clock.slept) <= 0.1


def test_a_holder_knows_that_somebody_waits() -> None:
    """Only while somebody does; a waiting process that dies leaves nothing behind."""
    lock = PortLock(RESOURCE, 0)
    lock.acquire()
    assert not lock.wanted()
    waiter = HOLDER.replace(", 0)", ", 60, waiting=lambda text: print(text, flush=True))")
    with subprocess.Popen(
        [sys.executable, "-c", waiter, RESOURCE], stdout=subprocess.PIPE, text=True
    ) as process:
        assert process.stdout is not None
        assert process.stdout.readline().startswith(f"{RESOURCE} is in use by process {os.getpid()} (")
        while not lock.wanted():
            assert process.poll() is None
        process.kill()
    assert not lock.wanted()
    lock.release()
    assert held_by_nobody()


@pytest.mark.parametrize(
    ("argv", "command"),
    [
        (["/usr/bin/fatektool", "watch", "R0"], "fatektool watch R0"),
        (["/opt/x/fatektool/__main__.py", "status"], "fatektool status"),
        (["a\nb", "c\td"], "a b c d"),
        (["x" * 5000], "x" * 200),
        ([], ""),
    ],
)
def test_a_command_on_one_line(argv: list[str], command: str, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(sys, "argv", argv)
    lock = PortLock(RESOURCE, 0)
    lock.acquire()
    holder = lock.holder()
    lock.release()
    assert holder is not None
    assert holder.command == command


def test_another_process_is_waited_for() -> None:
    clock = Clock()
    with holding() as process:

        def sleep(seconds: float) -> None:
            clock.sleep(seconds)
            if len(clock.slept) == 3:
                let_go(process)

        lock = PortLock(RESOURCE, 10.0, clock=clock, sleep=sleep)
        lock.acquire()
        assert len(clock.slept) == 3
        assert held_by(lock) == os.getpid()
        lock.release()


@pytest.mark.parametrize("wait_s", [0.0, -1.0, float("nan")])
def test_no_wait_is_no_wait(wait_s: float) -> None:
    clock = Clock()
    with holding(), pytest.raises(PortBusy):
        PortLock(RESOURCE, wait_s, clock=clock, sleep=clock.sleep).acquire()
    assert clock.slept == []


def test_a_lock_dies_with_its_process() -> None:
    with holding() as process:
        assert not held_by_nobody()
        process.kill()
        process.wait()
        lock = PortLock(RESOURCE, 0)
        assert held_by(lock) == process.pid  # the file is still there, and means nothing
        lock.acquire()
        assert held_by(lock) == os.getpid()
        lock.release()


def test_a_released_lock_is_anybodys() -> None:
    with holding() as process:
        let_go(process)
        assert held_by_nobody()


@pytest.mark.parametrize(
    "content", [b"", b"1\n", b"999999999\n", b"not a number", b"\xff\x00", b"7" * 10000, b"-4\n"]
)
def test_what_a_file_left_behind_says_means_nothing(content: bytes) -> None:
    lock = PortLock(RESOURCE, 0)
    Path(lock.path).write_bytes(content)
    lock.acquire()
    assert held_by(lock) == os.getpid()
    lock.release()


def test_a_holder_that_cannot_be_named() -> None:
    with holding():
        lock = PortLock(RESOURCE, 0)
        Path(lock.path).write_bytes(b"?")
        with pytest.raises(PortBusy, match="in use by another process") as caught:
            lock.acquire()
        assert caught.value.details["holder"] is None


def test_one_resource_one_lock_in_one_process_too() -> None:
    first = PortLock(RESOURCE, 0)
    first.acquire()
    with pytest.raises(PortBusy, match=f"in use by process {os.getpid()}"):
        PortLock(RESOURCE, 0).acquire()
    with pytest.raises(PortBusy):
        first.acquire()
    other = PortLock(RESOURCE + "0", 0)
    other.acquire()
    other.release()
    first.release()
    first.release()
    assert held_by_nobody()


def test_a_failed_try_takes_nothing_from_the_holder() -> None:
    first, second = PortLock(RESOURCE, 0), PortLock(RESOURCE, 0)
    first.acquire()
    with pytest.raises(PortBusy):
        second.acquire()
    second.release()
    assert not held_by_nobody()
    assert held_by(first) == os.getpid()
    first.release()


@pytest.mark.parametrize(
    "resource",
    [
        "127.0.0.1:500",
        "[fe80::1]:500",
        "RFC2217://GATEWAY:1/?X=Y",
        "/dev/" + "x" * 5000,
        "/dev/\udcff",
        "ä/..",
        "",
    ],
)
def test_any_resource_has_a_file_name(resource: str, lock_folder: Path) -> None:
    lock = PortLock(resource, 0)
    lock.acquire()
    assert [found.name for found in lock_folder.iterdir()] == [Path(lock.path).name]
    lock.release()


def test_resources_that_read_alike_have_two_locks() -> None:
    assert PortLock("/dev/a-b", 0).path != PortLock("/dev/a/b", 0).path


@posix("modes of files")
def test_the_file_is_for_all_users_to_lock() -> None:
    mask = os.umask(0o077)
    try:
        lock = PortLock(RESOURCE, 0)
        lock.acquire()
        assert Path(lock.path).stat().st_mode & 0o777 == 0o666
        lock.release()
    finally:
        os.umask(mask)


@posix("modes of files; on Windows they are not set")
@not_as_root_alone
def test_a_file_that_may_only_be_read_can_be_locked(monkeypatch: pytest.MonkeyPatch) -> None:
    with folder_for_all() as folder:
        monkeypatch.setenv("FATEKTOOL_LOCK_DIR", str(folder))
        lock = PortLock(RESOURCE, 0)
        Path(lock.path).write_text("4711\n")
        Path(lock.path).chmod(0o444)
        with no_root():
            lock.acquire()
        assert not held_by_nobody()
        assert Path(lock.path).read_text() == "4711\n"
        lock.release()
        assert held_by_nobody()


@pytest.mark.parametrize("place", ["nowhere", "file", "nowhere/deep"])
def test_a_folder_that_cannot_be_used_is_one_clear_line(
    place: str, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    (tmp_path / "file").touch()
    monkeypatch.setenv("FATEKTOOL_LOCK_DIR", str(tmp_path / place))
    lock = PortLock(RESOURCE, 0)
    with pytest.raises(UsageError, match="cannot create the lock file") as caught:
        lock.acquire()
    assert str(lock.path) in caught.value.message
    assert "FATEKTOOL_LOCK_DIR" in str(caught.value.hint)
    assert "\n" not in str(caught.value)
    lock.release()


@posix("modes of folders")
@not_as_root_alone
def test_a_folder_without_the_right_to_write(monkeypatch: pytest.MonkeyPatch) -> None:
    with folder_for_all() as folder:
        monkeypatch.setenv("FATEKTOOL_LOCK_DIR", str(folder))
        folder.chmod(0o555)
        with no_root(), pytest.raises(UsageError, match="Permission denied"):
            PortLock(RESOURCE, 0).acquire()


@pytest.mark.parametrize(
    "trap",
    [
        pytest.param("dangling", marks=symbolic_links),
        pytest.param("file", marks=symbolic_links),
        "folder",
    ],
)
def test_a_trap_in_a_shared_folder_is_not_stepped_into(trap: str, tmp_path: Path) -> None:
    lock = PortLock(RESOURCE, 0)
    victim = tmp_path / "victim"
    if trap == "folder":
        Path(lock.path).mkdir()
    else:
        Path(lock.path).symlink_to(victim)
        if trap == "file":
            victim.write_text("precious")
    with pytest.raises(UsageError, match="cannot create the lock file"):
        lock.acquire()
    assert not victim.exists() or victim.read_text() == "precious"


def test_a_child_process_does_not_inherit_the_lock() -> None:
    lock = PortLock(RESOURCE, 0)
    lock.acquire()
    with subprocess.Popen([sys.executable, "-c", "input()"], stdin=subprocess.PIPE) as child:
        lock.release()
        assert held_by_nobody()
        child.kill()


def test_where_locks_lie(lock_folder: Path, monkeypatch: pytest.MonkeyPatch, tmp_path: Path) -> None:
    folder = lock_module.lock_folder
    assert folder() == str(lock_folder)
    monkeypatch.setenv("FATEKTOOL_LOCK_DIR", "")
    monkeypatch.setattr(lock_module, "_SHARED", ())
    monkeypatch.setattr(lock_module, "_WINDOWS", False)
    monkeypatch.setattr(tempfile, "gettempdir", lambda: str(tmp_path / "temporary"))
    assert folder() == str(tmp_path / "temporary")


def test_one_place_for_all_users_of_windows(monkeypatch: pytest.MonkeyPatch, tmp_path: Path) -> None:
    monkeypatch.setenv("FATEKTOOL_LOCK_DIR", "")
    monkeypatch.setenv("PROGRAMDATA", str(tmp_path))
    monkeypatch.setattr(lock_module, "_WINDOWS", True)
    assert Path(lock_module.lock_folder()) == tmp_path / "fatektool"
    assert (tmp_path / "fatektool").is_dir()
    monkeypatch.setattr(tempfile, "gettempdir", lambda: str(tmp_path / "temporary"))
    (tmp_path / "file").touch()
    for nowhere in ("", str(tmp_path / "file")):
        monkeypatch.setenv("PROGRAMDATA", nowhere)
        assert Path(lock_module.lock_folder()) == tmp_path / "temporary"


@posix("modes of folders")
def test_one_place_for_all_users(monkeypatch: pytest.MonkeyPatch, tmp_path: Path) -> None:
    """A folder into which this user may write and others may not is none, though it comes first."""
    monkeypatch.setenv("FATEKTOOL_LOCK_DIR", "")
    for name, mode in (("own", 0o755), ("unreached", 0o776), ("all", 0o1777)):
        (tmp_path / name).mkdir()
        (tmp_path / name).chmod(mode)
    places = [str(tmp_path / name) for name in ("nowhere", "own", "unreached", "all")]
    monkeypatch.setattr(lock_module, "_SHARED", places)
    assert lock_module.lock_folder() == str(tmp_path / "all")
