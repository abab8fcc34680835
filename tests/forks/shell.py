"""A shell in which ``fatektool`` is forked: for scripts of many commands, such as those of the docs."""

from __future__ import annotations

import os
import sys
import tempfile
from functools import cache
from pathlib import Path

from tests.forks import command

_KEPT: list[tempfile.TemporaryDirectory[str]] = []
"""Lives as long as this process."""


@cache
def path() -> str:
    """``PATH`` with ``fatektool`` in front; where there is no fork, the installed one."""
    rest = f"{Path(sys.executable).parent}{os.pathsep}{os.environ['PATH']}"
    if not command.CAN_FORK:
        return rest
    folder = tempfile.TemporaryDirectory(prefix="fatektool-shell-")
    _KEPT.append(folder)
    source = Path(__file__).with_name("client.py").read_text(encoding="utf-8")
    program = Path(folder.name) / "fatektool"
    text = source.replace('SOCKET = ""', f"SOCKET = {command.server()!r}")
    program.write_text(f"#!{sys.executable} -IS\n{text}", encoding="utf-8")
    program.chmod(0o755)
    return f"{folder.name}{os.pathsep}{rest}"
