"""Each JSON document is built in one place: a function of a ``documents`` module."""

from __future__ import annotations

import ast
import re
from collections import defaultdict
from functools import cache

from fatektool.cli.tools.schema import schema_names
from tests.test_imports import trees

ELSEWHERE = {
    "backup": "a file's format, in program/archive",
    "snapshot": "a file's format, in jobs/snapshots",
    "trace": "a file's format, in transport",
}
"""Documents that are not built by the command line."""


@cache
def builders() -> dict[str, set[str]]:
    """The documents that the command line builds, by name, and the functions that do."""
    found: dict[str, set[str]] = defaultdict(set)
    for module, tree in trees():
        if not module.startswith("fatektool.cli."):
            continue
        for function in ast.walk(tree):
            if isinstance(function, ast.FunctionDef):
                for node in ast.walk(function):
                    if isinstance(node, ast.Dict):
                        for key, value in zip(node.keys, node.values, strict=True):
                            if isinstance(key, ast.Constant) and key.value == "schema":
                                assert isinstance(value, ast.Constant), f"{module}.{function.name}"
                                name = re.sub(r"^fatektool\.(.*)/1$", r"\1", str(value.value))
                                found[name].add(f"{module}.{function.name}")
    return found


def test_each_document_is_built_by_a_module_of_documents() -> None:
    in_commands = {
        name
        for name, functions in builders().items()
        for function in functions
        if "documents" not in function.split(".")[:-1]
    }
    assert not in_commands


def test_each_document_is_built_by_one_function() -> None:
    assert not {name: functions for name, functions in builders().items() if len(functions) > 1}


def test_every_schema_is_of_a_document_that_is_built() -> None:
    assert builders().keys() | ELSEWHERE.keys() == set(schema_names())
