"""The README and docs/restore.md: their tours give what they show; every command and path is there."""

from __future__ import annotations

import os
import re
import shutil
import socket
import subprocess
import sys
from pathlib import Path

import pytest

from fatektool.cli.app import app
from tests.root import DOCS, ROOT

README = (ROOT / "README.md").read_text(encoding="utf-8")
RESTORE = (DOCS / "restore.md").read_text(encoding="utf-8")
COMMANDS = (DOCS / "commands.md").read_text(encoding="utf-8")

_TIME = re.compile(
    r"\d{8}T\d{6}Z|\d{4}-\d\d-\d\dT\d\d:\d\d:\d\dZ|under 1 s|(about )?\d+ (s|min)$", re.MULTILINE
)


def free_port() -> int:
    with socket.socket() as probe:
        probe.bind(("127.0.0.1", 0))
        port: int = probe.getsockname()[1]
        return port


def script_of(steps: list[tuple[str, str]]) -> str:
    """A shell script that marks where each step's output begins, and waits for the doors it opens."""
    lines = ["set -u", 'trap "kill %1 %2 2>/dev/null; wait" EXIT']
    for number, (command, output) in enumerate(steps):
        lines.append(f"echo '<<{number}>>'")
        if command.endswith("&"):
            lines.append(f"{command.removesuffix('&')} > door{number} &")
            lines.append(f"until grep -q listening door{number}; do :; done; cat door{number}")
        else:
            lines.append(f"{command} 2>&1")
        assert output or command.startswith("export")
    return "\n".join(lines)


@pytest.mark.skipif(shutil.which("bash") is None, reason="the tour is for a POSIX shell")
@pytest.mark.parametrize("page", [README, RESTORE], ids=["README.md", "restore.md"])
def test_the_tour_gives_what_it_shows(page: str, tmp_path: Path) -> None:
    tour = page.split("<!-- tour -->")[1].split("<!-- /tour -->", maxsplit=1)[0]
    for port in ("5500", "5501"):
        tour = tour.replace(f"127.0.0.1:{port}", f"127.0.0.1:{free_port()}")
    steps: list[tuple[str, str]] = []
    for block in re.findall(r"```console\n(.*?)```", tour, re.DOTALL):
        for step in re.split(r"^\$ ", block, flags=re.MULTILINE)[1:]:
            command, _, output = step.partition("\n")
            steps.append((command.strip(), output))
    path = f"{Path(sys.executable).parent}{os.pathsep}{os.environ['PATH']}"
    done = subprocess.run(
        ["bash", "-c", script_of(steps)],
        cwd=tmp_path,
        env=os.environ | {"PATH": path, "FATEKTOOL_LOCK_DIR": str(tmp_path)},
        capture_output=True,
        text=True,
        check=False,
    )
    pieces = re.split(r"^<<\d+>>\n", done.stdout, flags=re.MULTILINE)[1:]
    assert len(pieces) == len(steps) > 5
    for (command, expected), got in zip(steps, pieces, strict=True):
        assert _TIME.sub("TIME", got) == _TIME.sub("TIME", expected), command


def test_every_command_is_documented() -> None:
    for name in app.subcommands:
        assert re.search(rf"^\|.*`{name}\b.*\|", COMMANDS, re.MULTILINE), name


def test_every_path_it_names_is_there() -> None:
    paths = re.findall(r"`((?:docs/|examples/)?[\w./-]+\.md|LICENSE|docs/[\w/]*)`", README)
    assert len(paths) > 20
    for path in paths:
        assert (ROOT / path).exists(), path


def test_every_page_is_named() -> None:
    """In the README, or in a page that it names."""
    for path in DOCS.glob("*.md"):
        assert f"docs/{path.name}" in README + COMMANDS, path.name


def test_the_readme_is_short() -> None:
    assert len(README.splitlines()) <= 150


def test_the_library_example_runs(tmp_path: Path) -> None:
    program = README.split("## Scripts, and Python")[1].split("```python\n")[1].split("```")[0]
    program = program.replace("/dev/ttyUSB0", "sim:")
    done = subprocess.run(
        [sys.executable, "-c", program], cwd=tmp_path, capture_output=True, text=True, check=False
    )
    assert done.stdout.startswith("{'R12': 0, 'D4': 0.0, 'X0': False, "), done.stderr
    assert (tmp_path / "press.json").exists()
