"""docs/reliability.md names tests that exist, and has one for each promise."""

from __future__ import annotations

import ast
import re
from functools import cache
from typing import TYPE_CHECKING

from tests.root import ROOT
from tests.rows import each

if TYPE_CHECKING:
    from pathlib import Path

PAGE = (ROOT / "docs" / "reliability.md").read_text(encoding="utf-8")
NAMED = re.compile(r"`((?:tests/[\w/]+/)?test_\w+\.py)(?:::(\w+))?`")
REPORTED = PAGE.split("## 9. Situations that users of such tools reported")[1].split("\n## ")[0]


@cache
def functions(path: Path) -> set[str]:
    tree = ast.parse(path.read_text(encoding="utf-8"))
    return {node.name for node in ast.walk(tree) if isinstance(node, ast.FunctionDef)}


@each(("file", "function"), sorted(set(NAMED.findall(PAGE))))
def test_a_test_that_is_named_exists(file: str, function: str) -> None:
    if "/" in file:
        assert (ROOT / file).is_file()
    else:
        assert list((ROOT / "tests").rglob(file))
    assert not function or function in functions(ROOT / file)


def rows(text: str) -> list[list[str]]:
    found = [
        re.split(r"(?<!\\) \| ", line.strip("| ")) for line in text.splitlines() if line.startswith("| ")
    ]
    return [row for row in found if not set("".join(row)) <= set("- |")]


def test_each_situation_has_a_promise_and_a_test() -> None:
    head, *table = rows(REPORTED)
    assert head == ["situation", "the promise", "test"]
    assert len(table) > 20
    for situation, promise, tests in table:
        assert promise, situation
        assert NAMED.sub("", tests).strip(", ") == "", situation
        assert all(function for _, function in NAMED.findall(tests)), situation
