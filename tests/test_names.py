"""A class name of a protocol, of the PLC's ports or of the simulator means one thing in the whole package."""

from __future__ import annotations

import ast
from collections import defaultdict

from tests.test_imports import folder_of, trees

ONE_MEANING = {"protocol", "plcports", "simulator"}

TWO_MEANINGS = {"Frame"}
"""Still to be given two names, a frame on the wire and one that is drawn: this may only shrink."""


def test_names_mean_one_thing() -> None:
    homes: dict[str, set[str]] = defaultdict(set)
    for module, tree in trees():
        for node in tree.body:
            if isinstance(node, ast.ClassDef) and not node.name.startswith("_"):
                homes[node.name].add(module)
    assert len(homes) > 200
    twice = {
        name
        for name, modules in homes.items()
        if len(modules) > 1 and any(folder_of(module) in ONE_MEANING for module in modules)
    }
    assert twice == TWO_MEANINGS
