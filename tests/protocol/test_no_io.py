"""The protocol is bytes to values and back: it never touches a file, a socket, a clock or a thread."""

from __future__ import annotations

import ast
from pathlib import Path

import fatektool
from tests.rows import each

PACKAGE = Path(fatektool.__file__).parent
FILES = sorted(path for name in ("protocol", "plcports") for path in (PACKAGE / name).rglob("*.py"))
ALLOWED = {
    "abc",
    "__future__",
    "binascii",
    "collections",
    "dataclasses",
    "enum",
    "functools",
    "itertools",
    "math",
    "re",
    "struct",
    "typing",
    "zlib",
}
BUILTINS = {"open", "print", "input", "breakpoint", "__import__", "exec", "eval"}
LIBRARIES = {"modbus/pdu.py": "pymodbus"}
"""A library in the one file that may know it: of pymodbus its PDUs and checksums, which do no I/O."""
OURS = ("fatektool.counts", "fatektool.errors", "fatektool.value", "fatektool.protocol", "fatektool.plcports")


@each("path", FILES, ids=lambda path: str(path.relative_to(PACKAGE)))
def test_no_io(path: Path) -> None:
    for node in ast.walk(ast.parse(path.read_text("utf-8"))):
        match node:
            case ast.Import(names):
                imported = [alias.name for alias in names]
            case ast.ImportFrom(module, _, level):
                assert not level, f"line {node.lineno}"
                imported = [module or ""]
            case ast.Call(ast.Name(function)):
                assert function not in BUILTINS, f"line {node.lineno}"
                continue
            case _:
                continue
        for name in imported:
            allowed = ALLOWED | {LIBRARIES.get(f"{path.parent.name}/{path.name}", "abc")}
            assert name.startswith(OURS) or name.split(".")[0] in allowed, f"line {node.lineno}"
