"""The house keeps its floors: imports point down, and nothing below the command line prints."""

from __future__ import annotations

import ast
from pathlib import Path
from typing import TYPE_CHECKING, NamedTuple

import pytest

import fatektool
from fatektool.cli.app import ENTRIES

if TYPE_CHECKING:
    from collections.abc import Iterator

ROOT = Path(fatektool.__file__).parent

FLOORS = {
    "errors": 0,
    "version": 0,
    "counters": 1,
    "silence": 3,
    "hearing": 3,
    "stream": 3,
    "protocol": 1,
    "program": 1,
    "ladder": 2,
    "project": 3,
    "simulator": 1,
    "transport": 2,
    "planner": 3,
    "link": 3,
    "attempt": 3,
    "fences": 3,
    "sending": 3,
    "batch": 3,
    "client": 3,
    "shared_line": 3,
    "plc_map": 3,
    "connection": 4,
    "jobs": 5,
    "history": 5,
    "inventory": 5,
    "report": 5,
    "cli": 6,
    "__init__": 6,
    "__main__": 7,
}
"""A room may import from lower floors and from itself; the link's parts and the client share a floor."""

SHARED = {
    "hearing",
    "attempt",
    "silence",
    "fences",
    "sending",
    "link",
    "stream",
    "batch",
    "client",
    "planner",
    "plc_map",
}
TO_THE_SIMULATOR = {"simulator", "connection", "cli"}
PRINTERS = {"click", "rich", "logging"}


class Import(NamedTuple):
    """A module of this package, and a module that it imports somewhere in its code."""

    by: str
    name: str

    @property
    def room(self) -> str:
        return room_of(self.by)


def room_of(module: str) -> str:
    parts = module.split(".")
    return parts[1] if len(parts) > 1 else "__init__"


def trees() -> Iterator[tuple[str, ast.Module]]:
    for path in sorted(ROOT.rglob("*.py")):
        parts = path.relative_to(ROOT.parent).with_suffix("").parts
        name = ".".join(parts[:-1] if parts[-1] == "__init__" and len(parts) > 2 else parts)
        yield name, ast.parse(path.read_text(encoding="utf-8"), str(path))


def imports() -> Iterator[Import]:
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


IMPORTS = list(imports())
OURS = [found for found in IMPORTS if found.name.startswith("fatektool.")]


def test_every_room_has_its_floor() -> None:
    assert {room_of(module) for module, _ in trees()} <= FLOORS.keys()
    assert len(OURS) > 100


@pytest.mark.parametrize("room", sorted({found.room for found in OURS}))
def test_imports_point_down(room: str) -> None:
    for found in OURS:
        other = room_of(found.name)
        if found.room != room or other == room or {room, other} <= SHARED or other == "version":
            continue
        assert FLOORS[other] < FLOORS[room], f"{found.by} imports {found.name}"


def test_the_simulator_shares_no_code_with_the_client() -> None:
    for found in OURS:
        if room_of(found.name) == "simulator":
            assert found.room in TO_THE_SIMULATOR, f"{found.by} imports {found.name}"
        if found.room == "simulator":
            assert room_of(found.name) in {"simulator", "errors"}, f"{found.by} imports {found.name}"


def test_only_the_command_line_prints() -> None:
    for found in IMPORTS:
        if found.name.partition(".")[0] in PRINTERS:
            assert found.room == "cli", f"{found.by} imports {found.name}"
    for module, tree in trees():
        for node in ast.walk(tree):
            if isinstance(node, ast.Name) and node.id in {"print", "input"}:
                pytest.fail(f"{module}, line {node.lineno}: {node.id}")


def test_the_rooms_below_the_lines_do_no_input_or_output() -> None:
    """Protocol has no I/O, no clock, no threads; program touches files in one place."""
    forbidden = {"socket", "serial", "threading", "asyncio", "subprocess", "select", "time", "selectors"}
    for found in IMPORTS:
        if found.room in {"protocol", "program", "ladder", "project"}:
            assert found.name.partition(".")[0] not in forbidden, f"{found.by} imports {found.name}"
        if found.name.partition(".")[0] in {"os", "pathlib", "tempfile"} and found.room in {
            "program",
            "ladder",
        }:
            assert found.by in {"fatektool.program.files", "fatektool.program.archive"}, found


@pytest.mark.parametrize("name", ENTRIES)
def test_every_command_is_in_the_readme(name: str) -> None:
    readme = (ROOT.parent / "README.md").read_text(encoding="utf-8")
    assert f"`{name}" in readme or f"fatektool {name}" in readme
