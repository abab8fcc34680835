"""What a person reads is in plain technical English: some words that it is not are found here."""

from __future__ import annotations

import re
from pathlib import Path

import pytest

import fatektool
from tests.root import DOCS, ROOT

IMAGES = re.compile(
    r"\b(house|doors?|floors?|rooms?|astray|honest|strangers?|riddles?"
    r"|(?:old|previous) program lies|passes +\d+, equal)\b(?!\()",
    re.IGNORECASE,
)
"""No word of FATEK's, and none that says what it means. ``floor(`` is a function."""

LONGEST = 130

FILES = [
    *Path(fatektool.__file__).parent.rglob("*.py"),
    *Path(fatektool.__file__).parent.rglob("*.json"),
    *DOCS.rglob("*.md"),
    *(ROOT / "bench").glob("*.py"),
    *(ROOT / "examples").rglob("*.md"),
    *(ROOT / "examples").rglob("*.py"),
    ROOT / "README.md",
    ROOT / "CONTRIBUTING.md",
    ROOT / "CHANGELOG.md",
]


def test_plain_words() -> None:
    found = [
        f"{path.relative_to(ROOT)}:{number}: {match[0]}"
        for path in FILES
        for number, line in enumerate(path.read_text(encoding="utf-8").splitlines(), 1)
        for match in IMAGES.finditer(line)
        if "from math import" not in line
    ]
    if found:
        pytest.fail("\n".join(found))


def test_lines_of_prose_are_not_longer_than_an_editor_shows() -> None:
    """Tables, code and what a command prints are as long as they are."""
    found = []
    for path in [each for each in FILES if each.suffix == ".md" and each.name != "CHANGELOG.md"]:
        in_code = False
        for number, line in enumerate(path.read_text(encoding="utf-8").splitlines(), 1):
            in_code ^= line.startswith("```")
            if len(line) > LONGEST and not in_code and not line.startswith("|"):
                found.append(f"{path.relative_to(ROOT)}:{number}: {len(line)}")
    assert not found
