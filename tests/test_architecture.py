"""docs/architecture.md shows the package as it is on disk; every page that it names is there."""

from __future__ import annotations

import re

from tests.root import DOCS, ROOT
from tests.test_imports import RANKS
from tests.tree import PACKAGE, PAGE, page_with, summary, tree


def test_the_tree_is_the_disks() -> None:
    page = PAGE.read_text(encoding="utf-8")
    assert page == page_with(tree()), "after a file was added, moved or removed: python -m tests.tree"


def test_every_file_is_in_the_tree() -> None:
    words = set(tree().split())
    assert {path.stem for path in PACKAGE.rglob("*.py") if path.name != "__init__.py"} <= words


def test_every_file_says_its_idea() -> None:
    assert not [str(path) for path in PACKAGE.rglob("*.py") if not summary(path)]


def test_three_files_with_one_prefix_are_a_folder() -> None:
    """``link_a``, ``link_b``, ``link_c`` beside each other are ``link/a``, ``b``, ``c``."""
    found: dict[str, list[str]] = {}
    for path in PACKAGE.rglob("[a-z]*_*.py"):
        found.setdefault(str(path.with_name(path.stem.partition("_")[0])), []).append(path.stem)
    assert not [names for names in found.values() if len(names) >= 3]


def test_every_path_that_a_page_names_is_there() -> None:
    pages = [*DOCS.glob("*.md"), *(DOCS / "decisions").glob("*.md"), ROOT / "CONTRIBUTING.md"]
    missing = [
        f"{page.name}: {path}"
        for page in pages
        if page.exists()
        for path in re.findall(
            r"\b((?:fatektool|tests|docs|bench|examples|fuzz)/[\w./-]+\.\w+)", page.read_text("utf-8")
        )
        if not (ROOT / path).exists()
    ]
    assert not missing


def test_the_ranks_are_those_of_the_test() -> None:
    """``__init__`` and ``__main__`` are the package's own, above all."""
    table = PAGE.read_text("utf-8").split("## Ranks")[1].split("\n\n")[1]
    shown = {
        folder: int(rank)
        for rank, folders in re.findall(r"^\| (\d+) \| (.*) \|$", table, re.MULTILINE)
        for folder in re.findall(r"`(\w+)`", folders)
    }
    assert shown == {name: rank for name, rank in RANKS.items() if not name.startswith("__")}
