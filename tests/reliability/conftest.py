from __future__ import annotations

import json
import os
import signal
import subprocess
import sys
from typing import TYPE_CHECKING, Any, NamedTuple, TypeAlias

import pytest

from tests.cli.running import Cli, check
from tests.root import ROOT

if TYPE_CHECKING:
    from collections.abc import Callable, Iterator
    from pathlib import Path


@pytest.fixture(autouse=True)
def place(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> Iterator[Path]:
    """A folder of its own to work in, with locks of its own."""
    locks, work = tmp_path / "locks", tmp_path / "work"
    locks.mkdir()
    work.mkdir()
    monkeypatch.setenv("FATEKTOOL_LOCK_DIR", str(locks))
    names = ("FATEKTOOL_PORT", "FATEKTOOL_READ_ONLY", "FATEKTOOL_INVENTORY", "FATEKTOOL_TRACEBACK")
    for name in names:
        monkeypatch.delenv(name, raising=False)
    monkeypatch.chdir(work)
    before = signal.getsignal(signal.SIGTERM)
    yield work
    signal.signal(signal.SIGTERM, before)


@pytest.fixture
def cli(capsys: pytest.CaptureFixture[str]) -> Cli:
    return Cli(capsys)


class Life(NamedTuple):
    """A command line that was run step by step."""

    code: int
    steps: list[str]
    out: str
    err: str

    def document(self, schema: str) -> Any:
        """The one JSON document on stdout, held against its schema."""
        found = json.loads(self.out)
        check(found, schema)
        return found


Deaths: TypeAlias = "Callable[[list[str]], list[int]]"
"""From the steps of a command to those at which it is killed, counted from 1."""


def every(steps: list[str]) -> list[int]:
    """All steps, counted from 1."""
    return [*range(1, len(steps) + 1)]


def each_kind(steps: list[str]) -> list[int]:
    """All but what is in the middle of a row of reads of one command: it changes nothing anywhere."""
    reads = ("send 4F", "answered 4F", "send 46", "answered 46", "send 48", "answered 48")
    return [
        at
        for at in every(steps)
        if steps[at - 1] not in reads or steps[max(0, at - 3) : at + 2 : 2] != [steps[at - 1]] * 3
    ]


class Mortals:
    """Runs command lines that die or fail at a step; see ``dying``."""

    def __init__(self, process: subprocess.Popen[str]) -> None:
        self._process = process
        self.environment: dict[str, str] = {}

    def __call__(
        self,
        *words: object,
        folder: Path,
        at: int = 0,
        how: str = "kill",
        user: int | None = None,
        locks: str | None = None,
        limit: int | None = None,
    ) -> Life:
        order = {
            "words": [str(word) for word in words],
            "folder": str(folder),
            "at": at,
            "how": how,
            "user": user,
            "locks": locks,
            "limit": limit,
            "environment": self.environment,
        }
        assert self._process.stdin is not None
        assert self._process.stdout is not None
        self._process.stdin.write(json.dumps(order) + "\n")
        self._process.stdin.flush()
        return Life(**json.loads(self._process.stdout.readline()))


@pytest.fixture(scope="session")
def all_mortals() -> Iterator[Mortals]:
    if not hasattr(os, "fork"):
        pytest.skip("needs fork and SIGKILL")
    with subprocess.Popen(
        [sys.executable, "-m", "tests.reliability.dying"],
        cwd=ROOT,
        stdin=subprocess.PIPE,
        stdout=subprocess.PIPE,
        text=True,
    ) as process:
        yield Mortals(process)
        assert process.stdin is not None
        process.stdin.close()


@pytest.fixture
def mortals(all_mortals: Mortals, place: Path) -> Mortals:
    assert place.exists()  # which has set what it needs
    all_mortals.environment = os.environ | {"PYTHONIOENCODING": "utf-8"}
    return all_mortals
