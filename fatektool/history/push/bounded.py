"""Run a program with a limit of time and without a terminal, so that it cannot ask for input."""

from __future__ import annotations

import os
import subprocess
import time
from tempfile import TemporaryFile
from typing import TYPE_CHECKING, Final, NamedTuple

from fatektool.system.process_group import ProcessGroup

if TYPE_CHECKING:
    from collections.abc import Mapping, Sequence

_LOOK_S: Final = 1.0
_CLEAN_UP_S: Final = 5.0


class Ended(NamedTuple):
    """The result of a program.

    Attributes:
        code: its exit code; None if it was ended because it wrote nothing for too long.
        out: what it wrote to stdout.
        err: what it wrote to stderr.
    """

    code: int | None
    out: str
    err: str


def run_bounded(command: Sequence[str], environment: Mapping[str, str], silence_s: float) -> Ended:
    """Run a program without a terminal. End it and its children if it writes nothing for too long.

    Its output goes to files: a child in the background would keep a pipe open.

    Args:
        command: the program and its arguments.
        environment: all of its environment.
        silence_s: how long it may write nothing, in seconds.

    Raises:
        OSError: it cannot be started.
    """
    with TemporaryFile() as out, TemporaryFile() as err:
        group = ProcessGroup(command, stdout=out, stderr=err, env=dict(environment))  # git, and no shell
        try:
            code = _wait(group.process, (out.fileno(), err.fileno()), silence_s)
        finally:
            _end(group)
        texts = []
        for file in (out, err):
            file.seek(0)
            texts.append(file.read().decode("utf-8", "replace"))
        return Ended(code, texts[0], texts[1])


def _wait(process: subprocess.Popen[bytes], files: tuple[int, int], silence_s: float) -> int | None:
    heard, since = -1, time.perf_counter()
    while True:
        try:
            return process.wait(min(_LOOK_S, silence_s))
        except subprocess.TimeoutExpired:
            size = sum(os.fstat(file).st_size for file in files)
            now = time.perf_counter()
            if size != heard:
                heard, since = size, now
            elif now - since >= silence_s:
                return None


def _end(group: ProcessGroup) -> None:
    """End it and its children: by SIGTERM first, so that git deletes its lock files."""
    if group.process.poll() is None:
        group.terminate()
        try:
            group.process.wait(_CLEAN_UP_S)
        except subprocess.TimeoutExpired:
            group.kill()
    group.close()
