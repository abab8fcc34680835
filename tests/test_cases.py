"""The cases of property tests: the same in each run, others for each seed where new ones are looked for."""

from __future__ import annotations

import os
import re
import shutil
import subprocess
import sys
from pathlib import Path

import pytest

from tests.root import ROOT

FAILING = """
from hypothesis import given, strategies as st

@given(st.lists(st.integers(0, 10**9), min_size=3))
def test_cases(numbers):
    with open("cases", "a") as file:
        file.write(f"{numbers}\\n")
    assert True

@given(st.integers())
def test_that_fails(number):
    assert False
"""


def cases(folder: Path, *words: str) -> tuple[str, str]:
    """The cases that a run draws, and what it prints."""
    (folder / "cases").unlink(missing_ok=True)
    command = [sys.executable, "-m", "pytest", "-p", "no:cacheprovider", "-p", "_hypothesis_pytestplugin"]
    environment = os.environ | {
        "PYTEST_DISABLE_PLUGIN_AUTOLOAD": "1",
        "PYTEST_ADDOPTS": "",
        "PYTHONPATH": str(ROOT),
    }
    done = subprocess.run(
        [*command, *words], cwd=folder, capture_output=True, text=True, check=False, env=environment
    )
    assert done.returncode == 1, done
    assert not list(folder.glob(".hypothesis/examples"))
    return (folder / "cases").read_text(), done.stdout


@pytest.fixture
def folder(tmp_path: Path) -> Path:
    shutil.copy(Path(__file__).with_name("conftest.py"), tmp_path)
    (tmp_path / "pytest.ini").write_text('[pytest]\naddopts = -m "not slow"\nmarkers = slow: new cases\n')
    (tmp_path / "test_some.py").write_text(FAILING)
    return tmp_path


def test_each_run_draws_the_same(folder: Path) -> None:
    first, said = cases(folder)
    second, _ = cases(folder)
    assert first == second
    assert "the same cases in each run" in said


def test_slow_runs_draw_others_and_say_how_to_draw_them_again(folder: Path) -> None:
    first, said = cases(folder, "-m", "slow")
    other, _ = cases(folder, "-m", "slow")
    assert first != other
    again = re.search(r"The same cases again: python -m pytest -m slow (--hypothesis-seed=\d+)", said)
    assert again is not None
    assert f"new cases, from {again[1]}" in said
    assert cases(folder, "-m", "slow", again[1])[0] == first
