"""Changed paths, one a line on stdin -> the tests to run, one a line on stdout. For .ci/quick."""

from __future__ import annotations

import sys
from pathlib import Path

ALWAYS = (
    "tests/test_architecture.py",
    "tests/test_imports.py",
    "tests/test_loaded.py",
    "tests/test_readme.py",
)
SLOW = {"parts", "examples", "history", "reliability", "report", "wireshark"}
"""Folders that take too long: a file of them runs when it, or the file that it is named after, changed."""


def tests_of(path: Path) -> set[str]:
    """The tests beside which a file is: its own, those of its name, or those of its folder."""
    parts = path.parts
    if parts[0] == "tests":
        return {str(path)} if path.name.startswith("test_") and path.exists() else set()
    if parts[0] != "fatektool" or path.suffix != ".py":
        return set()
    folder = Path("tests", *parts[1:-1])
    while not folder.exists():
        folder = folder.parent
    named = sorted(folder.glob(f"test_{path.stem}*.py"))
    if named:
        return {str(found) for found in named}
    if folder == Path("tests") or folder.name in SLOW | {"cli", "jobs"}:
        return set()
    return {str(found) for found in folder.glob("test_*.py")}


if __name__ == "__main__":
    found = {test for line in sys.stdin if line.strip() for test in tests_of(Path(line.strip()))}
    sys.stdout.write("\n".join(sorted(found | set(ALWAYS))) + "\n")
