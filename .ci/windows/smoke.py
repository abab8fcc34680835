"""Each command of fatektool in Windows' Python: python smoke.py TARGET OTHER [OPTION ...].

TARGET is a simulated PLC of another process, OTHER one with another program of the same size. Each line of
output has a command and its exit code; the last says how many there were. Exit code 1 if one is not as
expected, or if a command of the help was not run.
"""

from __future__ import annotations

import contextlib
import io
import os
import sys
import tempfile
from pathlib import Path
from typing import TYPE_CHECKING

import click

from fatektool.cli import run
from fatektool.cli.app import app

if TYPE_CHECKING:
    from collections.abc import Iterator

DONE = 0
CONTEXT = click.Context(app)
HOME = Path.cwd()

WITH_PLC = [
    ("status", 0),
    ("status --json", 0),
    ("backup press.json", 0),
    ("verify press.json", 0),
    ("stop --yes", 0),
    ("write R10=77 --yes", 0),
    ("read R10 X0-X7 Y0", 0),
    ("restore press.json --yes", 0),
    ("restore other.json --yes", 0),
    ("verify press.json", 1),
    ("restore press.json --yes", 0),
    ("verify press.json", 0),
    ("run --yes", 0),
    ("snapshot R0-R20 -o before.json", 0),
    ("watch R10 --count 2 --interval 0.01", 0),
    ("monitor press.json --count 1", 0),
    ("discrete disable X0 --yes", 0),
    ("discrete list X0-X7", 0),
    ("discrete enable X0 --yes", 0),
    ("doctor", 0),
    ("loopback --count 20", 0),
    ("scan --stations 1 --timeout 0.3", 0),
    ("link ports", 0),
    ("check", 0),
]
WITHOUT = [
    ("inspect press.json", 0),
    ("listing press.json", 0),
    ("xref press.json", 0),
    ("diff press.json other.json", 1),
    ("diff press.json other.json --report differences.html", 1),
    ("listing press.json --report listing.html", 0),
    ("ports", 0),
    ("decode 0230313430433703", 0),
    ("encode 46 R12 3", 0),
    ("modbus map R12", 0),
    ("inventory add press -p {target} {options}", 0),
    ("inventory list", 0),
    ("fleet status", 0),
    ("fleet backup --dir backups", 0),
    ("fleet backup --history kept", 0),
    ("history log --history kept", 0),
    ("history check --history kept", 0),
    ("schema status", 0),
    ("completion bash", 0),
    ("completion powershell", 0),
    ("simulate --help", 0),
    ("help", 0),
    ("version", 0),
    ("inspect com2.json", 2),
    ("status -p com2.json", 2),
    ("status -p COM9", 3),
]


def outcome(words: list[str]) -> tuple[int, str]:
    """The exit code of a command, and what it printed."""
    out, err = io.StringIO(), io.StringIO()
    with contextlib.redirect_stdout(out), contextlib.redirect_stderr(err):
        code = run(words)
    return code, out.getvalue() + err.getvalue()


def commands(group: click.Group = app, *before: str) -> Iterator[tuple[str, ...]]:
    """All commands, those of groups too."""
    for name in group.list_commands(CONTEXT):
        command = group.get_command(CONTEXT, name)
        yield (*before, name)
        if isinstance(command, click.Group):
            yield from commands(command, *before, name)


def main(target: str, other: str, *options: str) -> int:
    """Run them all in a folder of their own."""
    wrong, helps, ran = 0, 0, set[str]()
    print(f"Python {sys.version} on {sys.platform}", flush=True)
    with tempfile.TemporaryDirectory(ignore_cleanup_errors=True) as folder:
        os.chdir(folder)
        os.environ["FATEKTOOL_STATE_DIR"] = folder
        assert outcome(["backup", "other.json", "-p", other])[0] == DONE
        for line, expected in [*WITH_PLC, *WITHOUT]:
            words = line.format(target=target, options=" ".join(options)).split()
            if (line, expected) in WITH_PLC:
                words += ["-p", target, *options]
            code, said = outcome(words)
            ran.add(words[0])
            fault = code != expected or "a fault of fatektool" in said or "Traceback" in said
            wrong += fault
            print(f"{'WRONG' if fault else 'ok':5}  exit {code:3}  fatektool {' '.join(words)}", flush=True)
            if fault:
                print(said, flush=True)
        for words in commands():
            code, said = outcome([*words, "--help"])
            helps += 1
            if code != DONE or "Usage: fatektool" not in said:
                wrong += 1
                print(f"WRONG  exit {code:3}  fatektool {' '.join(words)} --help\n{said}", flush=True)
        os.chdir(HOME)
    missing = set(app.subcommands) - ran
    count = len(WITH_PLC) + len(WITHOUT)
    print(f"{count} commands and the help of {helps}, {wrong} wrong; not run: {sorted(missing) or 'none'}")
    return 1 if wrong or missing else 0


if __name__ == "__main__":
    sys.exit(main(*sys.argv[1:]))
