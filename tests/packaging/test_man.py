"""Manual pages: one for each command, without a warning of the programs that show them."""

from __future__ import annotations

import shutil
import subprocess
import sys
from functools import cache
from importlib.util import module_from_spec, spec_from_file_location
from typing import TYPE_CHECKING, Any

import pytest

from fatektool.cli.app import JOBS
from tests.root import ROOT

if TYPE_CHECKING:
    from pathlib import Path


@cache
def script_of(name: str) -> Any:
    spec = spec_from_file_location(name, ROOT / "packaging" / f"{name}.py")
    assert spec is not None
    assert spec.loader is not None
    module = module_from_spec(spec)
    spec.loader.exec_module(module)
    return module


@cache
def pages() -> dict[str, str]:
    man = script_of("man")
    return {each.command_path.replace(" ", "-"): man.page(each) for each in man.commands()}


def test_each_command_has_a_page() -> None:
    for section in JOBS.values():
        for name in section:
            assert f"fatektool-{name}" in pages()
    assert {"fatektool", "fatektool-link-table-write", "fatektool-fleet-backup"} <= pages().keys()


def test_a_page_has_what_the_help_shows() -> None:
    text = pages()["fatektool-restore"]
    assert ".SH OPTIONS\n.TP\n.B \\-\\-data\n" in text
    assert ".SH CONNECTION OPTIONS\n" in text
    assert ".B FILE\n" not in text  # an argument without words is in the synopsis
    assert "fatektool restore press.json \\-p sim: \\-\\-stop \\-\\-run \\-\\-yes\n" in text
    assert ".B 6\na restore did not complete" in text


def test_a_table_of_the_help_stays_one() -> None:
    text = pages()["fatektool-encode"]
    assert ".nf\n40, 53     nothing             44, 43, 46  ELEMENT COUNT\n41         run or stop" in text
    examples = text.partition(".SH EXAMPLES\n")[2].split("\n")
    assert examples[:3] == [
        ".nf",
        "fatektool encode 46 R12 3",
        "fatektool encode 03 R12 3 \\-\\-protocol modbus\\-rtu",
    ]


@pytest.mark.parametrize(
    "words",
    [["groff", "-ww", "-man", "-Tutf8", "-rLL=78n"], ["mandoc", "-T", "lint", "-W", "warning"]],
    ids=["groff", "mandoc"],
)
def test_programs_that_show_it_warn_of_nothing(words: list[str], tmp_path: Path) -> None:
    """At the width of a terminal, in which a page is read."""
    if shutil.which(words[0]) is None:
        pytest.skip(f"{words[0]} is not installed")
    for name, text in pages().items():
        (tmp_path / f"{name}.1").write_text(text, encoding="utf-8")
    for path in sorted(tmp_path.iterdir()):
        done = subprocess.run([*words, path], capture_output=True, text=True, check=False)
        said = done.stderr if words[0] == "groff" else done.stdout
        assert not [line for line in said.splitlines() if "missing date" not in line], path.name


def test_a_python_that_is_too_old_says_so(monkeypatch: pytest.MonkeyPatch) -> None:
    """The first file of fatektool.pyz, in the words of each Python since 2.7."""
    monkeypatch.syspath_prepend(str(ROOT / "packaging"))
    start = script_of("pyz").MAIN
    script = f"import sys; sys.version_info = (3, 9, 2)\n{start}"
    done = subprocess.run([sys.executable, "-c", script], capture_output=True, text=True, check=False)
    assert (done.returncode, done.stdout) == (2, "")
    assert done.stderr == (
        "fatektool: this is Python 3.9, expected 3.11 or later; start it with a later one, such as "
        "python3.12 fatektool.pyz (Windows: py -3.12 fatektool.pyz)\n"
    )
