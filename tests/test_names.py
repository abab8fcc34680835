"""A public class name means one thing in the whole package."""

from __future__ import annotations

import ast
from collections import defaultdict

from tests.test_imports import trees

TWO_MEANINGS = {"Frame", "Link", "Plc", "Reading", "View", "Writer"}
"""``Plc`` is the library's, with names of elements, and the class that it extends. The others are of a drawn
ladder and of another part, or of two commands. This set may only shrink."""


def test_names_mean_one_thing() -> None:
    homes: dict[str, set[str]] = defaultdict(set)
    for module, tree in trees():
        for node in tree.body:
            if isinstance(node, ast.ClassDef) and not node.name.startswith("_"):
                homes[node.name].add(module)
    assert len(homes) > 200
    assert {name for name, modules in homes.items() if len(modules) > 1} == TWO_MEANINGS
