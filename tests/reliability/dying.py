"""Command lines that die, or meet a full disk, at the N-th step; to be run as a process of its own.

A step is an operation on a file (open, write, the middle of a write, fsync, link, rename, unlink, truncate)
or half an exchange with the PLC (before the request goes out; when the answer is there and not read yet).

The process has loaded everything and makes a child for each command line, which costs some milliseconds; a
line of JSON in, a line of JSON out::

    {"words": ["backup", ...], "folder": "/tmp/..", "at": 7, "how": "kill", "user": null,
     "locks": null, "limit": null, "environment": {}}
    {"code": -9, "steps": ["open x.lock", ...], "out": "", "err": ""}

``how`` is ``kill`` (SIGKILL) or ``full`` (ENOSPC, in ``folder`` only); ``user`` a user to become, ``locks``
another folder for locks, ``limit`` the largest file in bytes.
"""

from __future__ import annotations

import errno
import json
import os
import resource
import select
import signal
import sys
import tempfile
import traceback
from pathlib import Path
from typing import IO, TYPE_CHECKING, Any, Self

from fatektool.cli import run
from fatektool.transport.sockets import SocketTransport
from tests.forks.server import load_all

if TYPE_CHECKING:
    from collections.abc import Callable

_PATCHED = ("open", "fsync", "link", "rename", "replace", "unlink", "remove", "ftruncate")


class Steps:
    """Counts the steps of this process, and dies or fails at one of them.

    Args:
        at: the step, from 1; 0 for none.
        how: ``kill`` or ``full``.
        folder: where a full disk is.
        log: a descriptor that takes the name of each step.
    """

    def __init__(self, at: int, how: str, folder: Path, log: int) -> None:
        self._at = at
        self._how = how
        self._folder = folder
        self._log = log
        self._count = 0
        self._paths: dict[int, Path] = {}

    def step(self, name: str, path: Path | None = None) -> None:
        if self._how == "full" and (path is None or path.parent != self._folder):
            return
        self._count += 1
        os.write(self._log, f"{name} {path.name if path else ''}".strip().encode() + b"\n")
        if self._count != self._at:
            return
        if self._how == "kill":
            os.kill(os.getpid(), signal.SIGKILL)
        if not name.startswith(("unlink", "remove")):  # which a full disk allows
            raise OSError(errno.ENOSPC, os.strerror(errno.ENOSPC))

    def watch(self) -> None:
        """Put a step before each operation."""
        for name in _PATCHED:
            setattr(os, name, self._watched(name, getattr(os, name)))
        os.fdopen = self._watched_file  # type: ignore[assignment]
        send = SocketTransport.write

        def write(transport: SocketTransport, data: bytes) -> None:
            command = data[3:5].decode()
            self.step(f"send {command}")
            send(transport, data)
            if transport._socket is not None:
                select.select([transport._socket], [], [])  # here every request gets its answer
            self.step(f"answered {command}")

        SocketTransport.write = write  # type: ignore[assignment, method-assign]

    def _watched(self, name: str, original: Callable[..., Any]) -> Callable[..., Any]:
        def watched(*values: Any, **named: Any) -> Any:
            first = values[0]
            path = self._paths.get(first) if isinstance(first, int) else Path(os.path.abspath(first))  # noqa: PTH100
            self.step(name, path)
            result = original(*values, **named)
            if name == "open" and path is not None:
                self._paths[result] = path
            return result

        return watched

    def _watched_file(self, descriptor: int, mode: str) -> Any:
        return Halving(open(descriptor, mode), self, self._paths[descriptor])


class Halving:
    """A file whose every write takes two steps."""

    def __init__(self, file: IO[bytes], steps: Steps, path: Path) -> None:
        self._file = file
        self._steps = steps
        self._path = path

    def __enter__(self) -> Self:
        return self

    def __exit__(self, *_: object) -> None:
        self._file.close()

    def write(self, data: bytes) -> None:
        self._steps.step("write", self._path)
        self._file.write(data[: len(data) // 2])
        self._file.flush()
        self._steps.step("half", self._path)
        self._file.write(data[len(data) // 2 :])

    def flush(self) -> None:
        self._file.flush()

    def fileno(self) -> int:
        return self._file.fileno()


def live(order: dict[str, Any], log: int, out: int, err: int) -> None:
    """Be the child: run the command line and end with its exit code."""
    code = 99
    try:
        os.dup2(out, 1)
        os.dup2(err, 2)
        folder = Path(order["folder"])
        os.chdir(folder)
        os.environ.clear()
        os.environ.update(order["environment"])
        if order["locks"] is not None:
            os.environ["FATEKTOOL_LOCK_DIR"] = order["locks"]
        if order["user"] is not None:
            os.setgroups([])
            os.setgid(order["user"])
            os.setuid(order["user"])
        if order["limit"] is not None:
            resource.setrlimit(resource.RLIMIT_FSIZE, (order["limit"], order["limit"]))
        Steps(order["at"], order["how"], folder, log).watch()
        code = run(order["words"])
        sys.stdout.flush()
    except BaseException:  # noqa: BLE001  # whatever it is, a child must not go on as its parent
        traceback.print_exc()
    finally:
        os._exit(code)


def main() -> None:
    load_all()
    answers = os.fdopen(os.dup(1), "w")
    for line in sys.stdin:
        files = [tempfile.TemporaryFile() for _ in range(3)]  # noqa: SIM115  # closed below
        child = os.fork()
        if not child:
            live(json.loads(line), *(file.fileno() for file in files))
        _, status = os.waitpid(child, 0)
        texts = []
        for file in files:
            file.seek(0)
            texts.append(file.read().decode())
            file.close()
        code = os.waitstatus_to_exitcode(status)
        document = {"code": code, "steps": texts[0].splitlines(), "out": texts[1], "err": texts[2]}
        print(json.dumps(document), file=answers, flush=True)


if __name__ == "__main__":
    main()
