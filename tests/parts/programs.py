"""Programs of others, started as children: each is waited for, and ended with its test."""

from __future__ import annotations

import contextlib
import os
import shutil
import signal
import socket
import subprocess
import threading
from contextlib import contextmanager
from typing import TYPE_CHECKING, NamedTuple

import pytest

if TYPE_CHECKING:
    from collections.abc import Iterator
    from pathlib import Path

PATIENCE_S = 30.0


def needs(*programs: str) -> pytest.MarkDecorator:
    """Skip, with a word, where a program is missing; ``.ci/run`` installs them all."""
    missing = [program for program in programs if found(program) is None]
    return pytest.mark.skipif(bool(missing), reason=f"not installed here: {', '.join(missing)}")


def found(program: str) -> str | None:
    """Where a program is; Debian has some where only root looks."""
    return shutil.which(program) or shutil.which(program, path="/usr/sbin:/sbin:/usr/local/sbin")


def command(program: str, *words: object) -> list[str]:
    path = found(program)
    assert path is not None, program
    return [path, *map(str, words)]


def free_port() -> int:
    with socket.socket() as holder:
        holder.bind(("127.0.0.1", 0))
        port: int = holder.getsockname()[1]
        return port


class Running(NamedTuple):
    """A child, and what it said until it was ready."""

    process: subprocess.Popen[str]
    said: list[str]

    def kill(self) -> None:
        """End it and its children at once, as a power cut does."""
        end(self.process)


def end(process: subprocess.Popen[str]) -> None:
    """Kill a child and its own children."""
    with contextlib.suppress(ProcessLookupError, PermissionError):
        os.killpg(process.pid, signal.SIGKILL)
    process.wait(PATIENCE_S)


@contextmanager
def running(words: list[str], ready: str, folder: Path | None = None) -> Iterator[Running]:
    """Start a program, and wait until it says that it is ready.

    Args:
        words: the command.
        ready: part of the line that says so, on either output.
        folder: where it runs.
    """
    with subprocess.Popen(
        words,
        stdin=subprocess.DEVNULL,
        stdout=subprocess.PIPE,
        stderr=subprocess.STDOUT,
        text=True,
        errors="replace",
        cwd=folder,
        start_new_session=True,
    ) as process:
        assert process.stdout is not None
        said: list[str] = []
        try:
            for line in process.stdout:
                said.append(line)
                if ready in line:
                    break
            else:
                pytest.fail(f"{words[0]} ended: {''.join(said)}")
            rest = threading.Thread(target=said.extend, args=(process.stdout,))  # a full pipe would stop it
            rest.start()
            yield Running(process, said)
        finally:
            end(process)
        rest.join(PATIENCE_S)


def _connect(port: int, process: subprocess.Popen[str]) -> None:
    """Wait until somebody listens on a port of this computer, as long as the process lives."""
    while True:
        with socket.socket() as client:
            if client.connect_ex(("127.0.0.1", port)) == 0:
                return
        if process.poll() is not None:
            pytest.fail(f"it ended with {process.returncode}")
        threading.Event().wait(0.02)  # it says nothing when it is ready


@contextmanager
def listening(words: list[str], port: int, folder: Path | None = None) -> Iterator[Running]:
    """Start a program that says nothing when it is ready: it listens on a port then."""
    with subprocess.Popen(
        words,
        stdin=subprocess.DEVNULL,
        stdout=subprocess.DEVNULL,
        stderr=subprocess.DEVNULL,
        text=True,
        cwd=folder,
        start_new_session=True,
    ) as process:
        try:
            _connect(port, process)
            yield Running(process, [])
        finally:
            end(process)
