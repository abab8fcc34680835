"""Data on a redirected standard output: UTF-8 and plain line ends, on Windows too."""

from __future__ import annotations

import os
import subprocess
import sys
from typing import TYPE_CHECKING

import pytest

from tests.root import ROOT

if TYPE_CHECKING:
    from pathlib import Path

SPEC = """[[item]]
element = "R0"
name = "Öltemperatur"
unit = "°C"
"""
SCRIPT = """
import sys
from fatektool.cli.shared.streams import mend_streams
from fatektool.cli import run

mend_streams()
for line in sys.argv[1:]:
    code = run(line.split())
    assert code in {0, 1}, line
    print("END", line)
sys.stdout.flush()
"""
FORMS = ("csv", "influx", "prometheus", "ndjson")
LINES = [
    *(f"completion {shell}" for shell in ("bash", "zsh", "fish", "powershell")),
    *(
        f"snapshot --spec a.toml -p sim: --format {form}"
        for form in ("csv", "influx", "prometheus", "ndjson")
    ),
    "watch R0 --count 2 --interval 0 -p sim:",
    "status -p sim: --json",
    "schema status",
    "backup - -p sim: --single-pass",
    "status --help",
    "inspect a.json",
]


@pytest.fixture(scope="module")
def printed(tmp_path_factory: pytest.TempPathFactory) -> dict[str, bytes]:
    """What each command prints, from one process whose output goes to a pipe."""
    place: Path = tmp_path_factory.mktemp("line-ends")
    (place / "a.toml").write_text(SPEC, encoding="utf-8")
    words = [sys.executable, "-c", SCRIPT, "backup a.json -p sim: --single-pass", *LINES]
    paths = os.pathsep.join([str(ROOT), *filter(None, [os.environ.get("PYTHONPATH")])])
    variables = os.environ | {
        "PYTHONPATH": paths,
        "PYTHONIOENCODING": "cp1252",
        "FATEKTOOL_LOCK_DIR": str(place),
    }
    done = subprocess.run(words, cwd=place, env=variables, capture_output=True, check=False)
    assert done.returncode == 0, done.stderr.decode(errors="replace")
    found, rest = {}, done.stdout
    for line in words[3:]:
        found[line], _, rest = rest.partition(f"END {line}".encode())
    return found


@pytest.mark.parametrize("line", LINES)
def test_no_line_ends_with_a_carriage_return(printed: dict[str, bytes], line: str) -> None:
    """A shell would take it for a part of the last word, and a database for a part of the value."""
    data = printed[line]
    assert data.count(b"\n") > 1, line
    assert b"\r" not in data
    text = data.decode("utf-8")
    if "--spec" in line and "json" not in line:
        assert "Öl" in text, text
        assert "°C" in text or "prometheus" in line
