"""docs/link.md, word by word: its commands give what it shows, its tables say what the code does."""

from __future__ import annotations

import re
import shlex
from typing import TYPE_CHECKING

from fatektool.plcports.codes import CODES
from tests.root import ROOT

if TYPE_CHECKING:
    from pathlib import Path

    from tests.plant import Plant

DOCS = (ROOT / "docs" / "link.md").read_text(encoding="utf-8")
CONSOLE = re.findall(r"```console\n(.*?)```", DOCS, re.DOTALL)


def test_every_command_gives_what_is_shown(fbs: Plant, place: Path) -> None:
    (table,) = re.findall(r"```toml\n(.*?)```", DOCS, re.DOTALL)
    (place / "press.toml").write_text(table, encoding="utf-8")
    steps = [step for block in CONSOLE for step in re.split(r"^\$ ", block, flags=re.MULTILINE) if step]
    assert len(steps) > 9
    for step in steps:
        command, _, expected = step.partition("\n")
        if command.startswith("export "):
            assert command == "export FATEKTOOL_PORT=sim:fbs.state"
            continue
        words, _, head = command.partition(" | head -n ")
        program, *rest = shlex.split(words)
        assert program == "fatektool"
        done = fbs.cli(*rest)
        assert done.code == 0, command
        text = done.out.replace(fbs.target, "sim:fbs.state")
        lines = text.splitlines()[: int(head)] if head else text.splitlines()
        lines = ["took under 1 s of simulated time" if line.startswith("took ") else line for line in lines]
        assert lines == expected.splitlines(), command
    assert (place / "again.toml").read_text(encoding="utf-8") == table


def test_every_code_is_there() -> None:
    rows = re.findall(r"^\| ([0-9A-F]) \| ([^|]+) \|", DOCS, re.MULTILINE)
    documented = [(kind.strip(), code) for code, kinds in rows for kind in kinds.split(",")]
    assert sorted(documented) == sorted((kind.value, f"{code:X}") for kind in CODES for code in CODES[kind])
