"""Completion in real shells, where they are installed: names of all kinds, and whole descriptions."""

from __future__ import annotations

import os
import shutil
import subprocess
from typing import TYPE_CHECKING

import pytest

from fatektool.cli import run as run_in_process
from fatektool.cli.shared.shells import SHELLS
from tests.forks.shell import path as shell_path

if TYPE_CHECKING:
    from pathlib import Path

    from tests.cli.running import Cli

LOADED = {
    "bash": 'eval "$(fatektool completion bash)"',
    # compsys needs a terminal: what the script hands to it is printed instead.
    "zsh": """
compdef() { : }
_describe() { print -rl -- $completions_with_descriptions }
compadd() { print -rl -- $completions }
_path_files() { print -r -- FILES }
eval "$(fatektool completion zsh)"
""",
    "fish": "fatektool completion fish | source",
    "powershell": "Invoke-Expression (& fatektool completion powershell | Out-String)",
}
"""Loads the completion into a shell."""

LINE = {
    "bash": """
COMPREPLY=(); COMP_WORDS=({words} '{last}'); COMP_CWORD={number}
_fatektool_completion fatektool
printf '%s\\n' "${{COMPREPLY[@]}}"
""",
    "zsh": """
words=({words} '{last}'); CURRENT={number}+1
_fatektool_completion
""",
    "fish": """
complete -C '{words} {last}'
""",
    "powershell": """
$line = '{words} {last}'
(TabExpansion2 -inputScript $line -cursorColumn $line.Length).CompletionMatches |
  ForEach-Object {{ "$($_.CompletionText)`t$($_.ToolTip)" }}
""",
}
"""Asks for what completes a line, as a key would."""

BETWEEN = "=== the next line ==="
PROGRAMS = {"powershell": "pwsh"}

ASKED = [
    ("fatektool re", ["read", "restore"]),
    ("fatektool simulate --fault dr", ["drop="]),
    ("fatektool status --baud 96", ["9600"]),
    ("fatektool status --line 8", ["8E1", "8N1"]),
    ("fatektool schema fle", ["fleet"]),
    ("fatektool fleet status --select ni", ["night"]),
    ("fatektool status -p pre", ["press"]),
    ("fatektool history show pre", ["press"]),
    ("fatektool read DW", ["DWX0", "DWY0", "DWM0", "DWS0", "DWT0", "DWC0"]),
]
WHOLE = "Write a backup's program into the PLC; can be undone."
COMMA = "Show model, mode and state of the PLC."


@pytest.fixture
def place(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> Path:
    """A folder with an inventory and a history."""
    monkeypatch.chdir(tmp_path)
    (tmp_path / "fatek.toml").write_text(
        '[defaults]\nhistory = "past"\n[plc.press]\ntarget = "sim:press.state"\ntags = ["night"]\n',
        encoding="utf-8",
    )
    monkeypatch.delenv("FATEKTOOL_HISTORY", raising=False)
    monkeypatch.delenv("FATEKTOOL_INVENTORY", raising=False)
    assert run_in_process(["fleet", "backup", "-q"]) == 0
    return tmp_path


def asked(shell: str, lines: list[str]) -> list[list[tuple[str, str]]]:
    """What one shell offers for each line: values with descriptions."""
    program = PROGRAMS.get(shell, shell)
    script = LOADED[shell]
    for line in lines:
        words, _, last = line.rpartition(" ")
        script += LINE[shell].format(words=words, last=last, number=len(words.split()))
        script += f"echo '{BETWEEN}'\n"
    flags = {"bash": ["--norc", "-c"], "zsh": ["-f", "-c"], "fish": ["--no-config", "-c"]}
    environment = os.environ | {"PATH": shell_path()}
    done = subprocess.run(
        [program, *flags.get(shell, ["-NoProfile", "-Command"]), script],
        env=environment, capture_output=True, text=True, check=False,
    )  # fmt: skip
    assert not done.stderr, done.stderr
    mark = ":" if shell == "zsh" else "\t"
    *offered, rest = done.stdout.split(f"{BETWEEN}\n")
    assert (len(offered), rest) == (len(lines), "")
    pairs = [[each.partition(mark) for each in text.splitlines() if each] for text in offered]
    return [[(value.strip(), words.strip()) for value, _, words in of_line] for of_line in pairs]


@pytest.mark.parametrize("shell", SHELLS)
def test_a_real_shell_completes(place: Path, shell: str) -> None:
    if shutil.which(PROGRAMS.get(shell, shell)) is None:
        pytest.skip(f"{shell} is not installed")
    assert place.is_dir()
    *offered, restore, status = asked(
        shell, [*(line for line, _ in ASKED), "fatektool resto", "fatektool sta"]
    )
    for (line, expected), found in zip(ASKED, offered, strict=True):
        assert sorted(value for value, _ in found) == sorted(expected), line
    if shell != "bash":  # which shows values alone
        assert dict(restore)["restore"] == WHOLE
        assert dict(status)["status"] == COMMA


def test_powershell_is_asked_with_words_on_lines(
    cli: Cli, monkeypatch: pytest.MonkeyPatch, place: Path
) -> None:
    """The same without the shell, which few build machines have."""
    assert place.is_dir()
    monkeypatch.setenv("_FATEKTOOL_COMPLETE", "powershell_complete")
    for line, expected in ASKED:
        monkeypatch.setenv("COMP_WORDS", "\n".join(line.split(" ")))
        monkeypatch.setenv("COMP_CWORD", line.rpartition(" ")[2])
        done = cli()
        assert sorted(each.partition("\t")[0] for each in done.out.splitlines()) == sorted(expected), line
        assert all(each.partition("\t")[2] for each in done.out.splitlines())
    monkeypatch.setenv("COMP_WORDS", "fatektool\nstatus\n--ba")
    monkeypatch.setenv("COMP_CWORD", "--ba")
    assert cli().out.startswith("--baud\tSpeed of the serial line.")
    monkeypatch.setenv("COMP_WORDS", "fatektool\nhistory")
    monkeypatch.delenv("COMP_CWORD")  # PowerShell removes a variable that it sets to an empty text
    assert "export\t" in cli().out
    monkeypatch.setenv("_FATEKTOOL_COMPLETE", "powershell_source")
    assert "Register-ArgumentCompleter -Native -CommandName fatektool" in cli().out


def test_every_shell_has_its_script(cli: Cli) -> None:
    for shell in SHELLS:
        assert "fatektool" in cli("completion", shell).out


def test_where_nothing_can_be_read_nothing_is_completed(
    cli: Cli, monkeypatch: pytest.MonkeyPatch, tmp_path: Path
) -> None:
    monkeypatch.chdir(tmp_path)
    (tmp_path / "fatek.toml").write_text("broken", encoding="utf-8")
    monkeypatch.setenv("_FATEKTOOL_COMPLETE", "powershell_complete")
    for line in ("fatektool history show p", "fatektool fleet status --select p"):
        monkeypatch.setenv("COMP_WORDS", "\n".join(line.split()))
        monkeypatch.setenv("COMP_CWORD", "p")
        assert (cli().code, cli().out.strip()) == (0, "")
