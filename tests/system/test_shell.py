"""Command lines for sh, cmd.exe and PowerShell: quoted for messages, and split where the user wrote one."""

from __future__ import annotations

import os
import shlex
import subprocess
import sys
from typing import TYPE_CHECKING

import pytest
from hypothesis import given
from hypothesis import strategies as st

from fatektool.errors import UsageError
from fatektool.jobs.fleet import alarms
from fatektool.system import shell
from fatektool.system.process_group import ProcessGroup
from fatektool.system.windows_processes import chain
from tests.root import ROOT
from tests.rows import each

if TYPE_CHECKING:
    from pathlib import Path

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


def test_a_command_is_ended_with_all_that_it_started(tmp_path: Path) -> None:
    """The child of the program is known to run by its file, and to have ended by its closed pipe."""
    child = f"open({str(tmp_path / 'runs')!r}, 'w').close(); import threading; threading.Event().wait()"
    script = f"import subprocess, sys; subprocess.run([sys.executable, '-c', {child!r}])"
    reader, writer = os.pipe()
    os.set_inheritable(writer, True)  # noqa: FBT003
    group = ProcessGroup([sys.executable, "-c", script], stdout=writer, close_fds=False)
    os.close(writer)
    while not (tmp_path / "runs").exists():
        assert group.process.poll() is None
    group.kill()
    group.close()
    assert os.read(reader, 1) == b""
    os.close(reader)
    assert group.process.returncode


def test_what_a_command_leaves_in_the_background_goes_on() -> None:
    group = ProcessGroup([sys.executable, "-c", "pass"], stdout=subprocess.DEVNULL)
    assert group.process.wait() == 0
    group.terminate()
    group.close()


def test_messages_quote_for_the_shell_of_the_user() -> None:
    """Commands in messages are made by this module; shlex quotes for sh alone."""
    allowed = {"shell.py", "by_dulwich.py"}  # git starts GIT_SSH by sh, on Windows too
    for path in (ROOT / "fatektool").rglob("*.py"):
        assert path.name in allowed or "shlex" not in path.read_text(encoding="utf-8"), path
