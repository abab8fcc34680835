"""The tree of docs/architecture.md, from the package: folders with their docstrings, and the files in them.

::

    python -m tests.tree        # writes it into docs/architecture.md
"""

from __future__ import annotations

import ast
import textwrap
from pathlib import Path
from typing import Final

import fatektool
from tests.root import DOCS

PACKAGE: Final = Path(fatektool.__file__).parent
PAGE: Final = DOCS / "architecture.md"
BEGIN: Final = "<!-- tree: python -m tests.tree -->\n```\n"
END: Final = "```\n<!-- /tree -->"


def summary(path: Path) -> str:
    """The first sentence of a file's docstring, on one line."""
    text = ast.get_docstring(ast.parse(path.read_text(encoding="utf-8"))) or ""
    return " ".join(text.split("\n\n")[0].split())


def lines(folder: Path, depth: int = 0) -> list[str]:
    """A folder, its files, and the folders in it."""
    indent = "  " * depth
    init = folder / "__init__.py"
    said = summary(init) if init.exists() else "The JSON Schema of every document."
    head = f"{indent}{folder.name}/  "
    found = textwrap.wrap(said, 118, initial_indent=head, subsequent_indent=indent + "    ")
    files = sorted(path.stem for path in folder.glob("*.py") if path.name != "__init__.py")
    if files:
        inner = indent + "    "
        found += textwrap.wrap("  ".join(files), 118, initial_indent=inner, subsequent_indent=inner)
    for each in sorted(path for path in folder.iterdir() if path.is_dir() and path.name != "__pycache__"):
        found += lines(each, depth + 1)
    return found


def tree() -> str:
    """The whole package."""
    return "\n".join(lines(PACKAGE)) + "\n"


def page_with(text: str) -> str:
    """The page with this tree in it."""
    page = PAGE.read_text(encoding="utf-8")
    before, _, rest = page.partition(BEGIN)
    _, _, after = rest.partition(END)
    assert before
    assert after
    return before + BEGIN + text + END + after


if __name__ == "__main__":
    PAGE.write_text(page_with(tree()), encoding="utf-8")
