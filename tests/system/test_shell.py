"""Command lines for sh, cmd.exe and PowerShell: quoted for messages, and split where the user wrote one."""

from __future__ import annotations

import ast
import os
import re
import shlex
import sys
from pathlib import Path

import pytest
from hypothesis import given
from hypothesis import strategies as st

from fatektool.cli.app import JOBS
from fatektool.errors import UsageError
from fatektool.jobs.fleet import alarms
from fatektool.system import own_program, shell
from fatektool.system.windows_processes import chain
from tests.root import ROOT
from tests.rows import each

WORDS = [
    ("press.json", "press.json", "press.json"),
    ("--yes", "--yes", "--yes"),
    (r"C:\plant\press.json", r"C:\plant\press.json", r"C:\plant\press.json"),
    (r"C:\my plant\press.json", r'"C:\my plant\press.json"', r'"C:\my plant\press.json"'),
    ("C:\\my plant\\", '"C:\\my plant\\\\"', '"C:\\my plant\\\\"'),
    ("--safety-dir=C:/a", "--safety-dir=C:/a", "--safety-dir=C:/a"),
    ("modem:COM3?number=1&wait=2", '"modem:COM3?number=1&wait=2"', '"modem:COM3?number=1&wait=2"'),
    ("R0,R2", '"R0,R2"', '"R0,R2"'),
    ("it's", '"it\'s"', '"it\'s"'),
    ("50% $x", '"50"^%" $x"', "'50% $x'"),
    ("it's $x", '"it\'s $x"', "'it''s $x'"),
    ("", '""', '""'),
    ("@list", '"@list"', '"@list"'),
    ("Presse Süd.json", '"Presse Süd.json"', '"Presse Süd.json"'),
]


@each(("word", "in_cmd", "in_powershell"), WORDS)
def test_a_word_for_each_shell(word: str, in_cmd: str, in_powershell: str) -> None:
    assert shell.quoted(word, shell.CMD) == in_cmd
    assert shell.quoted(word, shell.POWERSHELL) == in_powershell
    assert shlex.split(shell.quoted(word, shell.SH)) == [word]


@given(st.lists(st.text(st.characters(exclude_characters="\0%\n\r", codec="utf-8")), min_size=1))
def test_a_program_of_windows_receives_the_words(words: list[str]) -> None:
    """By the rules of CommandLineToArgvW, written here a second time."""
    assert _arguments(shell.command_line(words, shell.CMD)) == words


def _arguments(line: str) -> list[str]:
    found, word, quoted, place = [], None, False, 0
    while place < len(line):
        slashes = len(line[place:]) - len(line[place:].lstrip("\\"))
        place += slashes
        mark = line[place : place + 1]
        if slashes:
            word = (word or "") + "\\" * (slashes // 2 if mark == '"' else slashes)
        if mark == '"' and slashes % 2:
            word = (word or "") + mark
        elif mark == '"':
            word, quoted = word or "", not quoted
        elif mark in {" ", "\t"} and not quoted:
            found += [word] if word is not None else []
            word = None
        else:
            word = (word or "") + mark
        place += 1
    return found + ([word] if word is not None else [])


def test_powershell_runs_a_program_in_quotes_by_the_operator() -> None:
    words = [r"C:\my tools\fatektool.exe", "status"]
    assert shell.command_line(words, shell.POWERSHELL) == r'& "C:\my tools\fatektool.exe" status'
    assert shell.command_line(words, shell.CMD) == r'"C:\my tools\fatektool.exe" status'
    assert shell.command_line(["fatektool", "my file"], shell.POWERSHELL) == 'fatektool "my file"'


@each(
    ("started", "expected"),
    [
        ("fatektool", ["fatektool"]),
        ("/usr/bin/fatektool", ["fatektool"]),
        ("/srv/my tools/fatektool.pyz", ["PYTHON", "/srv/my tools/fatektool.pyz"]),
        ("tool.pyz", ["PYTHON", "tool.pyz"]),
        ("/srv/fatektool/__main__.py", ["PYTHON", "-m", "fatektool"]),
        ("/srv/pytest/__main__.py", ["fatektool"]),
        ("-c", ["fatektool"]),
        ("", ["fatektool"]),
    ],
)
def test_the_words_that_start_this_program_again(started: str, expected: list[str]) -> None:
    with pytest.MonkeyPatch.context() as patched:
        patched.setattr(sys, "argv", [started])
        patched.setattr(own_program, "_in_path", lambda _stem: True)
        found = own_program.own_words()
    known = {"PYTHON": sys.executable}
    assert [known.get(word, str(Path(word).resolve()) if "." in word else word) for word in expected] == found


def test_a_command_that_the_shell_does_not_find_has_its_path(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    """An environment that is not activated, or an exe that was put on the desktop."""
    program = tmp_path / "bin" / "fatektool"
    program.parent.mkdir()
    program.write_text("")
    program.chmod(0o755)
    monkeypatch.setattr(sys, "argv", [str(program)])
    monkeypatch.setenv("PATH", str(tmp_path))
    assert own_program.own_words() == [str(program)]
    if os.name == "posix":
        monkeypatch.setenv("PATH", f"{tmp_path}{os.pathsep}{program.parent}")
        assert own_program.own_words() == ["fatektool"]


@each(
    ("programs", "expected"),
    [
        (["python.exe", "fatektool.exe", "cmd.exe", "explorer.exe"], shell.CMD),
        (["fatektool.exe", "pwsh.exe", "WindowsTerminal.exe"], shell.POWERSHELL),
        (["PowerShell.EXE", "cmd.exe"], shell.POWERSHELL),
        (["bash.exe", "mintty.exe"], shell.SH),
        (["svchost.exe"], shell.POWERSHELL),
        ([], shell.POWERSHELL),
    ],
)
def test_the_shell_is_the_nearest_ancestor_that_is_one(programs: list[str], expected: str) -> None:
    assert shell.among(programs) == expected


def test_ancestors_end_where_a_number_is_used_again() -> None:
    processes = {9: (7, "python.exe"), 7: (5, "cmd.exe"), 5: (9, "explorer.exe")}
    assert list(chain(9, processes)) == ["cmd.exe", "explorer.exe"]
    assert list(chain(4, processes)) == []


def test_a_command_of_windows_keeps_its_backslashes(monkeypatch: pytest.MonkeyPatch) -> None:
    text = r'C:\tools\alarm.exe --to "the team" C:\new'
    assert shell.split_command(text, windows=True) == text
    assert shell.program_of(text) == r"C:\tools\alarm.exe"
    assert shell.program_of(r'"C:\my tools\alarm.exe" x') == r"C:\my tools\alarm.exe"
    assert shell.split_command(r"echo \"", windows=True) == r"echo \""
    monkeypatch.setattr(shell.split_command, "__kwdefaults__", {"windows": True})
    assert alarms.parse_command(text, "--on-failure") == text
    for wrong in ('alarm.exe "the team', '""', "  ", r'"C:\tools\"'):
        with pytest.raises(UsageError, match="--on-failure"):
            alarms.parse_command(wrong, "--on-failure")


_COMMANDS = "|".join(name for section in JOBS.values() for name in section)
_IN_COMMAND = re.compile(rf"\b(?:git -C|git clone|git init|fatektool (?:{_COMMANDS}) |chmod |chgrp )[^;:']*$")


def test_commands_in_messages_are_made_for_the_shell() -> None:
    """A value in a command that a message names, such as a path with a space, is quoted by this module."""
    found = []
    of_elements = {"discrete.py", "discretes.py"}  # whose names have no character that is special
    for path in (ROOT / "fatektool").rglob("*.py"):
        for text in ast.walk(ast.parse(path.read_text(encoding="utf-8"))):
            if not isinstance(text, ast.JoinedStr) or path.name in of_elements:
                continue
            before = ""
            for part in text.values:
                if isinstance(part, ast.Constant):
                    before += str(part.value)
                elif _IN_COMMAND.search(before) and "quoted" not in ast.dump(part):
                    found.append(f"{path}:{text.lineno}: {ast.unparse(text)}")
    assert not found


def test_messages_quote_for_the_shell_of_the_user() -> None:
    """Commands in messages are made by this module; shlex quotes for sh alone."""
    allowed = {"shell.py", "by_dulwich.py"}  # git starts GIT_SSH by sh, on Windows too
    for path in (ROOT / "fatektool").rglob("*.py"):
        assert path.name in allowed or "shlex" not in path.read_text(encoding="utf-8"), path
