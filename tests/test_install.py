"""The two lines of the README that install the command for one user: from a clone, and from a wheel."""

from __future__ import annotations

import os
import re
import shutil
import subprocess
import sys
from runpy import run_path
from typing import TYPE_CHECKING

import pytest

from fatektool.version import __version__
from tests.root import ROOT

if TYPE_CHECKING:
    from pathlib import Path

README = (ROOT / "README.md").read_text(encoding="utf-8")
LINES = README.split("<!-- install -->")[1].split("<!-- /install -->")[0].strip().strip("`").split("\n")[1:-1]
NO_INDEX = re.compile(
    "Failed to establish a new connection|Network is unreachable|Name or service not known|dns error|"
    "Could not connect|error sending request"
)


def test_the_readme_has_two_lines_to_install_it() -> None:
    assert LINES == ["pipx install .", "uv tool install ."]


def test_the_virtual_environment_is_before_the_commands_that_need_it() -> None:
    before, _, after = README.partition("python3 -m venv .venv && . .venv/bin/activate")
    assert "python3 -m pip install" not in before
    assert after.count("python3 -m pip install") == 2


def test_the_page_has_the_table_of_the_bench() -> None:
    """The same jobs, so that one command makes it again."""
    text = (ROOT / "docs" / "install.md").read_text(encoding="utf-8")
    jobs = run_path(str(ROOT / "bench" / "small.py"))["JOBS"]
    rows = re.findall(r"^\| (.*?) \| [\d.]+ s \| \d+ ms \| \d+ MiB \|$", text, re.MULTILINE)
    assert rows == [name for name, _ in jobs]


def done(command: list[str], folder: Path, environment: dict[str, str]) -> str:
    ended = subprocess.run(command, cwd=folder, env=environment, capture_output=True, text=True, check=False)
    said = ended.stdout + ended.stderr
    if ended.returncode and NO_INDEX.search(said):
        pytest.skip("no package index can be reached")
    assert ended.returncode == 0, said
    return said


@pytest.mark.slow
@pytest.mark.parametrize("of", ["clone", "wheel"])
@pytest.mark.parametrize("line", LINES)
def test_it_installs_the_command(line: str, of: str, tmp_path: Path) -> None:
    program, *words = line.split()
    if shutil.which(program) is None:
        pytest.skip(f"{program} is not installed")
    clone = tmp_path / "clone"
    shutil.copytree(ROOT / "fatektool", clone / "fatektool", ignore=shutil.ignore_patterns("__pycache__"))
    for name in ("pyproject.toml", "README.md", "LICENSE", "CHANGELOG.md"):
        shutil.copy(ROOT / name, clone)
    home = tmp_path / "home"
    environment = os.environ | {
        "HOME": str(home),
        "PIPX_HOME": str(home / "pipx"),
        "PIPX_BIN_DIR": str(home / "bin"),
        "PIPX_DEFAULT_PYTHON": sys.executable,
        "UV_TOOL_DIR": str(home / "uv"),
        "UV_TOOL_BIN_DIR": str(home / "bin"),
        "UV_PYTHON": sys.executable,
        "FATEKTOOL_LOCK_DIR": str(tmp_path),
    }
    environment.pop("PYTHONPATH", None)
    source = "."
    if of == "wheel":
        build = [sys.executable, "-m", "pip", "wheel", "-q", "--no-deps", "-w", "dist", "."]
        done(build, clone, environment)
        (wheel,) = (clone / "dist").glob("fatektool-*.whl")
        source = str(wheel)
    done([program, *words[:-1], source], clone, environment)
    command = str(home / "bin" / "fatektool")
    assert done([command, "--version"], tmp_path, environment) == f"fatektool {__version__}\n"
    assert "read twice, identical" in done(
        [command, "backup", "demo.json", "-p", "sim:"], tmp_path, environment
    )
