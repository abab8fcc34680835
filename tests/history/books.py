"""Histories for tests, and git itself to look at them with."""

from __future__ import annotations

import shutil
import subprocess
from dataclasses import replace
from typing import TYPE_CHECKING

from fatektool.history.history import History, RecordResult
from tests.program.samples import backup, changed, program

if TYPE_CHECKING:
    from pathlib import Path

    from fatektool.program.archive import Backup

ONE = backup(program(400, seed=1))
TWO = replace(ONE, program=changed(ONE.program, 3, 5), created="2026-11-23T03:15:00Z")
THREE = replace(ONE, program=changed(TWO.program, 6), created="2026-11-24T03:15:00Z")
GIT = shutil.which("git") or "git"  # some tests have none in PATH
NOON = 1795348800  # 2026-11-22T12:00:00Z
DAY = 86400


def git(folder: Path, *words: str, code: int = 0) -> str:
    """Run git in a folder; its output, both streams."""
    done = subprocess.run(
        [GIT, "-C", str(folder), *words], capture_output=True, text=True, check=False, encoding="utf-8"
    )
    assert done.returncode == code, done
    return done.stdout + done.stderr


class Book:
    """A history whose clock goes by days."""

    def __init__(self, folder: Path) -> None:
        self.folder = folder
        self.now = NOON
        self.history = History(folder, wait_s=0.0, clock=lambda: self.now)

    def record(self, name: str, *backups: Backup) -> list[RecordResult]:
        """Record these, one a day."""
        found = []
        for each in backups:
            found.append(self.history.record(name, each))
            self.now += DAY
        return found

    def git(self, *words: str) -> str:
        return git(self.folder, *words)

    def fsck(self) -> None:
        """Let git look it through: it finds nothing but objects that nothing names."""
        said = self.git("fsck", "--strict", "--full", "--no-progress")
        assert [line for line in said.splitlines() if "dangling" not in line and "unborn" not in line
                and "No default references" not in line] == []  # fmt: skip

    @property
    def commits(self) -> int:
        return len(self.git("rev-list", "HEAD").split())
