"""A process that ends at its N-th touch of the disk, or finds it full there. For ``test_crash.py``.

::

    python -m tests.history.crash HOW FOLDER FROM STEP    HOW: kill, full, short

For N = FROM, FROM + STEP, … a child of its own history ``FOLDER/N`` makes one change. Every file and folder
that is made, linked, renamed, removed or synced counts. The last child, which comes to its end, ends the
series: what is printed is how many there were.

kill    SIGKILL at the N-th touch
full    the N-th touch and all after it find no room
short   no file may grow beyond N bytes: it is written in part, and then there is no room
"""

from __future__ import annotations

import errno
import os
import resource
import signal
import sys
from dataclasses import replace
from pathlib import Path

from fatektool.errors import DataError
from fatektool.history.history import History
from fatektool.history.packing import pack_loose
from fatektool.history.repository import Repository
from tests.program.samples import backup, changed, program

ONE = backup(program(400, seed=1))
TWO = replace(ONE, program=changed(ONE.program, 3, 5))
COUNTED = {"os.rename", "os.link", "os.remove", "os.mkdir", "os.chmod", "os.truncate"}
NO_ROOM, DONE = 5, 0


class Trap:
    """Counts touches of the disk from now on, and closes at one of them."""

    def __init__(self, how: str, last: int) -> None:
        self.how = how
        self.left = last
        self.sync = os.fsync

    def set(self) -> None:
        if self.how == "short":
            signal.signal(signal.SIGXFSZ, signal.SIG_IGN)
            resource.setrlimit(resource.RLIMIT_FSIZE, (self.left, self.left))
            return
        sys.addaudithook(self.audit)
        vars(os)["fsync"] = self.synced

    def audit(self, event: str, arguments: tuple[object, ...]) -> None:
        if event in COUNTED or (
            event == "open" and isinstance(arguments[2], int) and arguments[2] & os.O_CREAT
        ):
            self.touch()

    def synced(self, descriptor: int) -> None:
        self.touch()
        self.sync(descriptor)

    def touch(self) -> None:
        self.left -= 1
        if self.left >= 0:
            return
        if self.how == "kill":
            os.kill(os.getpid(), signal.SIGKILL)
        raise OSError(errno.ENOSPC, os.strerror(errno.ENOSPC))


def change(folder: Path) -> int:
    """What is done under the trap: a change, then packing."""
    try:
        History(folder, wait_s=0.0).record("press", TWO)
        with Repository(folder) as repository:
            pack_loose(repository)
    except DataError:
        return NO_ROOM
    return DONE


def run(how: str, folder: Path, first: int, step: int) -> int:
    count = first
    while True:
        place = folder / str(count)
        if count % 2:  # every second one has something to lose
            History(place).record("press", ONE)
        child = os.fork()
        if child == 0:
            Trap(how, count).set()
            os._exit(change(place))
        _, status = os.waitpid(child, 0)
        if os.WIFEXITED(status) and os.WEXITSTATUS(status) == DONE:
            return count
        ended = -os.WTERMSIG(status) if os.WIFSIGNALED(status) else os.WEXITSTATUS(status)
        if ended != (-signal.SIGKILL if how == "kill" else NO_ROOM):
            raise SystemExit(f"at {count}: ended with {ended}")
        count += step


if __name__ == "__main__":
    print(run(sys.argv[1], Path(sys.argv[2]), int(sys.argv[3]), int(sys.argv[4])))  # noqa: T201  # its answer
