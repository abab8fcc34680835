"""Command lines for the shell of the user: quoted for a message, and split where the user wrote one.

A message such as "run: fatektool restore 'my press.json'" is copied into a shell. Three kinds have different
rules::

    sh            '…'    nothing in it is special; Linux, macOS, Git Bash
    cmd           "…"    %NAME% is replaced also in it
    powershell    "…"    $ and ` are special in it, '…' has nothing special; & before a program in quotes

On Windows the shell is the nearest ancestor process that is one. Where possible a word is quoted so that
cmd.exe and PowerShell both accept it, because a record of a write may be read in the other one.
"""

from __future__ import annotations

import os
import re
import shlex
from typing import TYPE_CHECKING, Final

from fatektool.system.own_program import own_words

if TYPE_CHECKING:
    from collections.abc import Iterable, Sequence

SH, CMD, POWERSHELL = "sh", "cmd", "powershell"
_PLAIN: Final = re.compile(r"[\w./\\:=+-][\w./\\:=+@~-]*", re.ASCII)
_EXPANDED: Final = r"[$`\u201c-\u201e]"
"""What PowerShell does not keep in double quotes: the typographic ones end them too."""
_SINGLE_QUOTES: Final = r"(['\u2018-\u201b])"
"""What ends single quotes in PowerShell; twice it is itself."""
_SHELLS: Final = {
    "cmd.exe": CMD,
    "powershell.exe": POWERSHELL,
    "pwsh.exe": POWERSHELL,
    "bash.exe": SH,
    "sh.exe": SH,
    "zsh.exe": SH,
}


def command_line(words: Sequence[str], shell: str | None = None) -> str:
    """A command line that can be copied into a shell.

    Args:
        words: the program and its arguments.
        shell: ``sh``, ``cmd`` or ``powershell``; by default that of the user.
    """
    found = shell or current()
    line = " ".join(quoted(word, found) for word in words)
    return f"& {line}" if found == POWERSHELL and line[:1] in {"'", '"'} else line


def own_command_line(*words: str) -> str:
    """A command line of this program, for the user's shell.

    Args:
        words: the command and its arguments.
    """
    return command_line([*own_words(), *words])


def quoted(word: str, shell: str | None = None) -> str:
    """One word of a command line.

    Args:
        word: as the program is to receive it.
        shell: as for ``command_line``.
    """
    found = shell or current()
    if found == SH:
        return shlex.quote(word)
    if _PLAIN.fullmatch(word):
        return word
    if found == POWERSHELL and re.search(_EXPANDED, word):
        return "'" + re.sub(_SINGLE_QUOTES, r"\1\1", word) + "'"
    marked = _in_double_quotes(word)
    return marked.replace("%", '"^%"') if found == CMD else marked


def _in_double_quotes(word: str) -> str:
    """Always in quotation marks, with the backslashes that a program of Windows expects before one."""
    marked = re.sub(r'(\\*)"', r'\1\1\\"', word)
    return '"' + re.sub(r"(\\+)$", r"\1\1", marked) + '"'


def split_command(text: str, *, windows: bool = os.name == "nt") -> str | tuple[str, ...]:
    r"""A command that the user wrote, as ``subprocess`` starts it without a shell.

    Args:
        text: such as ``mail-alarm --to 'the team'``, on Windows ``C:\tools\alarm.exe "the team"``.
        windows: by the rules of Windows: the whole text is kept; the started program splits it.

    Raises:
        ValueError: a quotation mark is missing.
    """
    if not windows:
        return tuple(shlex.split(text))
    if len(re.findall(r'(?<!\\)(?:\\\\)*"', text)) % 2:
        raise ValueError("No closing quotation")
    return text.strip()


def program_of(command: str | Sequence[str]) -> str:
    """The program of a command, for messages; empty if there is none."""
    if not isinstance(command, str):
        return command[0] if command else ""
    match = re.match(r'"([^"]*)"|(\S+)', command)
    return (match[1] or match[2] or "") if match else ""


def current() -> str:
    """The shell from which this process was started: ``sh``, ``cmd`` or ``powershell``."""
    if os.name != "nt":
        return SH
    if "MSYSTEM" in os.environ or "SHELL" in os.environ:  # Git Bash, Cygwin
        return SH
    return among(_ancestors())


def among(programs: Iterable[str]) -> str:
    """The first shell among the names of programs; PowerShell, which new systems start, if there is none."""
    return next((_SHELLS[name.lower()] for name in programs if name.lower() in _SHELLS), POWERSHELL)


def _ancestors() -> Iterable[str]:
    """The names of the programs that started this process, the nearest first."""
    from fatektool.system.windows_processes import ancestors

    return ancestors()
