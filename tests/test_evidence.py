"""docs/evidence.md against the marks: each has a row, each row is used, each has a grade and a source."""

from __future__ import annotations

import re
from functools import cache

from tests.root import ROOT
from tests.rows import each

TABLE = (ROOT / "docs" / "evidence.md").read_text(encoding="utf-8")
MARK = re.compile(r"\[E:([\w-]*)\]")
GRADES = set(re.findall(r"^\| (paper|[a-z ]+) \| [^|]+ \|$", TABLE.split("## ")[0], re.MULTILINE)) - {"grade"}
ROWS = re.findall(r"^\| ([a-z][a-z0-9-]+) \| ([^|]+) \| ([^|]+) \| ([^|]+) \|$", TABLE, re.MULTILINE)


@cache
def marked() -> dict[str, list[str]]:
    """Every mark in what is shipped, with the files that bear it."""
    files = [ROOT / "README.md"]
    files += [path for path in (ROOT / "docs").glob("*.md") if path.name != "evidence.md"]
    for folder, pattern in (("fatektool", "*.py"), ("examples", "*")):
        files += [path for path in (ROOT / folder).rglob(pattern) if path.is_file()]
    found: dict[str, list[str]] = {}
    for path in files:
        for name in MARK.findall(path.read_bytes().decode("utf-8", "replace")):
            found.setdefault(name, []).append(str(path.relative_to(ROOT)))
    return found


def test_each_mark_has_a_row() -> None:
    rows = {name for name, *_ in ROWS}
    assert {name: files for name, files in marked().items() if name not in rows} == {}


def test_each_row_is_marked_somewhere() -> None:
    assert {name for name, *_ in ROWS if name not in marked() and name != "mark"} == set()


def test_each_name_is_there_once() -> None:
    names = [name for name, *_ in ROWS if name != "mark"]
    assert len(names) == len(set(names)) > 30


def test_the_grades() -> None:
    assert {"paper", "vendor manual", "field", "standard", "our reading", "not known"} == GRADES
    assert {grade.strip() for name, _, grade, _ in ROWS if name != "mark"} == GRADES


@each(("name", "statement", "source"), [(n, s, f) for n, s, _, f in ROWS if n != "mark"])
def test_a_row_says_something_that_others_can_look_up(name: str, statement: str, source: str) -> None:
    assert len(statement.strip()) > 15, name
    assert len(source.strip()) > 15, name
    assert not re.search(r"(?:^|[\s`(])/(?:work|home|tmp|root)\b", source), name


def test_every_statement_that_was_without_a_source_has_a_grade() -> None:
    """The ones that readers asked for by name."""
    rows = {name for name, *_ in ROWS}
    assert rows >= {
        "factory", "tcp-port", "word-order", "one-scan", "page-order", "modbus-limits", "modbus-exceptions",
        "watchdog", "battery", "password",
    }  # fmt: skip
