"""Imports point down and in no circle, and nothing below the command line prints."""

from __future__ import annotations

import ast
import gc
from functools import cache
from pathlib import Path
from typing import TYPE_CHECKING, NamedTuple

import pytest

import fatektool

if TYPE_CHECKING:
    from collections.abc import Iterator

ROOT = Path(fatektool.__file__).parent

RANKS = {
    "callbacks": 0,
    "value": 0,
    "counts": 0,
    "errors": 0,
    "protocols": 0,
    "system": 0,
    "version": 0,
    "checks": 1,
    "files": 1,
    "protocol": 1,
    "program": 2,
    "simulator": 1,
    "plcports": 2,
    "ladder": 3,
    "project": 4,
    "transport": 2,
    "planner": 3,
    "exchange": 3,
    "client": 4,
    "address": 3,
    "simulated": 4,
    "connection": 5,
    "jobs": 6,
    "history": 6,
    "inventory": 6,
    "report": 6,
    "served": 4,
    "library": 7,
    "cli": 7,
    "__init__": 8,
    "__main__": 9,
}
"""A folder may import from lower ones and from itself."""

TO_THE_SIMULATOR = {"simulator", "simulated", "served", "cli"}
PRINTERS = {"click", "rich", "logging"}


class Import(NamedTuple):
    """A module of this package, and a module that it imports somewhere in its code."""

    by: str
    name: str

    @property
    def folder(self) -> str:
        return folder_of(self.by)


def folder_of(module: str) -> str:
    parts = module.split(".")
    return parts[1] if len(parts) > 1 else "__init__"


def paths() -> Iterator[tuple[str, Path]]:
    for path in sorted(ROOT.rglob("*.py")):
        parts = path.relative_to(ROOT.parent).with_suffix("").parts
        yield ".".join(parts[:-1] if parts[-1] == "__init__" and len(parts) > 2 else parts), path


@cache
def trees() -> list[tuple[str, ast.Module]]:
    gc.disable()  # it would look through all trees again and again
    try:
        return [(name, ast.parse(path.read_text(encoding="utf-8"), str(path))) for name, path in paths()]
    finally:
        gc.enable()


@cache
def imports() -> list[Import]:
    return list(all_imports())


def ours() -> list[Import]:
    return [found for found in imports() if found.name.startswith("fatektool.")]


def all_imports() -> Iterator[Import]:
    for module, tree in trees():
        for node in ast.walk(tree):
            if isinstance(node, ast.Import):
                yield from (Import(module, alias.name) for alias in node.names)
            elif isinstance(node, ast.ImportFrom):
                assert node.level == 0, f"{module}: a relative import"
                assert node.module
                yield Import(module, node.module)
                if node.module == "fatektool":
                    yield from (Import(module, f"fatektool.{alias.name}") for alias in node.names)


def test_every_folder_has_a_rank() -> None:
    assert {folder_of(module) for module, _ in trees()} <= RANKS.keys()
    assert len(ours()) > 100


def test_imports_point_down() -> None:
    up = [
        f"{found.by} imports {found.name}"
        for found in ours()
        if (other := folder_of(found.name)) not in {found.folder, "version"}
        and RANKS[other] >= RANKS[found.folder]
    ]
    assert not up


MODULES = {module for module, _ in paths()}


def module_of(name: str) -> str:
    """The module that a name is in: ``fatektool.errors`` for ``fatektool.errors.DataError``."""
    while name not in MODULES:
        name = name.rpartition(".")[0]
    return name


@cache
def graph() -> dict[str, set[str]]:
    """Each module and those it imports, under TYPE_CHECKING and within functions too."""
    found: dict[str, set[str]] = {module: set() for module in MODULES}
    for module, tree in trees():
        for node in ast.walk(tree):
            if isinstance(node, ast.Import):
                names = [alias.name for alias in node.names]
            elif isinstance(node, ast.ImportFrom):
                names = [f"{node.module}.{alias.name}" for alias in node.names]
            else:
                continue
            found[module] |= {module_of(name) for name in names if name.startswith("fatektool.")}
    return found


def reached(module: str, edges: dict[str, set[str]]) -> set[str]:
    """Every module that this one needs, directly or by others."""
    found: set[str] = set()
    new = set(edges[module])
    while new:
        found |= new
        new = {further for each in new for further in edges[each]} - found
    return found


def test_no_file_is_in_a_circle() -> None:
    edges = graph()
    assert not [module for module in MODULES if module in reached(module, edges)]


def is_command(tree: ast.Module) -> bool:
    """True for a file that defines a command or a group of them."""
    for node in tree.body:
        if isinstance(node, ast.FunctionDef):
            for mark in node.decorator_list:
                called = mark.func if isinstance(mark, ast.Call) else mark
                if isinstance(called, ast.Attribute) and called.attr in {"command", "group"}:
                    return True
    return False


def test_no_command_imports_a_command() -> None:
    """What two commands share is in neither of them; a group loads its commands when they are used."""
    commands = {module for module, tree in trees() if is_command(tree)} - {"fatektool.cli.app"}
    assert len(commands) > 30
    edges = graph()
    assert not {(by, of) for by in commands for of in edges[by] & commands}


def test_the_simulator_shares_no_code_with_the_client() -> None:
    for found in ours():
        if folder_of(found.name) == "simulator":
            assert found.folder in TO_THE_SIMULATOR, f"{found.by} imports {found.name}"
        if found.folder == "simulator":
            assert folder_of(found.name) in {"simulator", "errors", "protocols", "system"}, (
                f"{found.by} imports {found.name}"
            )


def test_only_the_command_line_prints() -> None:
    for found in imports():
        if found.name.partition(".")[0] in PRINTERS:
            assert found.folder == "cli", f"{found.by} imports {found.name}"
    for module, tree in trees():
        for node in ast.walk(tree):
            if isinstance(node, ast.Name) and node.id in {"print", "input"}:
                pytest.fail(f"{module}, line {node.lineno}: {node.id}")


def test_the_rooms_below_the_lines_do_no_input_or_output() -> None:
    """Protocol has no I/O, no clock, no threads; program touches files in one place."""
    forbidden = {"socket", "serial", "threading", "asyncio", "subprocess", "select", "time", "selectors"}
    for found in imports():
        if found.folder in {"protocol", "program", "ladder", "project"}:
            assert found.name.partition(".")[0] not in forbidden, f"{found.by} imports {found.name}"
        if found.name.partition(".")[0] in {"os", "pathlib", "tempfile"} and found.folder in {
            "program",
            "ladder",
        }:
            assert found.by in {"fatektool.files.atomic", "fatektool.program.archive"}, found
