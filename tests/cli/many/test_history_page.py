"""docs/history.md tells the truth: its commands give what it shows."""

from __future__ import annotations

import os
import re
import shutil
import subprocess
from typing import TYPE_CHECKING

import pytest

from tests.forks.shell import path as shell_path
from tests.root import ROOT
from tests.test_readme import free_port

if TYPE_CHECKING:
    from tests.history.books import Book

DOCS = (ROOT / "docs" / "history.md").read_text(encoding="utf-8")
CHANGING = (
    (r"\d{4}-\d\d-\d\dT\d\d:\d\d:\d\dZ", "TIME"),
    (r"(took +)(under 1 s|\d+ (s|min))( of simulated time)?\n", r"\1T\n"),
    (r"\b([0-9a-f]{40}|[0-9a-f]{10})\b", "HASH"),
    (r"fatektool \d[\w.]*", "VERSION"),
)


def plain(text: str) -> str:
    """Without what differs from run to run."""
    for pattern, word in CHANGING:
        text = re.sub(pattern, word, text)
    return text


@pytest.mark.skipif(shutil.which("bash") is None, reason="the page is for a POSIX shell")
def test_the_page_gives_what_it_shows(book: Book) -> None:
    page = DOCS.replace("127.0.0.1:5500", f"127.0.0.1:{free_port()}")
    steps: list[tuple[str, str]] = []
    for block in re.findall(r"```console\n(.*?)```", page, re.DOTALL):
        for step in re.split(r"^\$ ", block, flags=re.MULTILINE)[1:]:
            command, _, output = step.partition("\n")
            steps.append((command, output))
    script = ["trap 'kill %1; wait' EXIT"]
    for number, (command, _) in enumerate(steps):
        script.append(f"echo '<<{number}>>'")
        if command.endswith(" &"):
            script += [f"{command[:-2]} > door &", "until grep -q listening door; do :; done; cat door"]
        else:
            script.append(f"{command} 2>&1")
    done = subprocess.run(
        ["bash", "-c", "\n".join(script)],
        cwd=book.folder.parent,
        env=os.environ | {"PATH": shell_path(), "FATEKTOOL_LOCK_DIR": str(book.folder.parent)},
        capture_output=True,
        text=True,
        check=False,
    )
    pieces = re.split(r"^<<\d+>>\n", done.stdout, flags=re.MULTILINE)[1:]
    assert len(pieces) == len(steps) > 15
    for (command, expected), got in zip(steps, pieces, strict=True):
        assert plain(got) == plain(expected), command
