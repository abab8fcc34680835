"""The help in sections, and its examples, which are run as they are printed."""

from __future__ import annotations

import os
import re
import shlex
import shutil
import signal
import subprocess
from functools import cache
from pathlib import Path
from typing import TYPE_CHECKING, Final

import click
import pytest

from fatektool.cli import run as run_in_process
from fatektool.cli.app import app
from fatektool.jobs.programs.backup import backup
from fatektool.program.archive import save_backup
from tests.cli.running import Cli, Done
from tests.forks.shell import path as shell_path
from tests.project.files import ELEMENTS, IMAGE, project_file
from tests.rigs import simulated
from tests.root import DOCS, EXAMPLES
from tests.rows import each

if TYPE_CHECKING:
    from collections.abc import Iterator

SECTIONS: Final = ["Options:", "Connection:", "Output:"]


def commands_of(command: click.Command, words: tuple[str, ...] = ()) -> Iterator[tuple[str, click.Command]]:
    """Every command and group below one, with the words of its command line."""
    yield " ".join(words), command
    if isinstance(command, click.Group):
        context = click.Context(command)
        for name in command.list_commands(context):
            found = command.get_command(context, name)
            assert found is not None
            yield from commands_of(found, (*words, name))


@cache
def commands() -> dict[str, click.Command]:
    return {words: command for words, command in commands_of(app) if words}


def help_of(words: str) -> str:
    """The help on a terminal of 80 columns."""
    command = commands()[words]
    names = app.context_settings["help_option_names"]
    context = click.Context(
        command, info_name=f"fatektool {words}", terminal_width=80, help_option_names=names
    )
    return command.get_help(context)


def section(text: str, heading: str) -> str:
    return text.partition(f"\n{heading}\n")[2].partition("\n\n")[0]


@each("words", [words for words, command in commands().items() if not isinstance(command, click.Group)])
def test_options_are_in_sections_and_own_ones_first(words: str) -> None:
    text = help_of(words)
    headings = [line for line in text.splitlines() if re.fullmatch(r"[A-Z]\w+:", line)]
    assert headings == [each for each in SECTIONS if each in headings]
    assert "--help" in section(text, "Output:")
    if "--port" in text and words != "inventory add":
        assert "--port" in section(text, "Connection:")
        assert "--port" not in section(text, "Options:")


@each("words", [words for words in commands() if words])
def test_what_goes_into_an_option_is_said(words: str) -> None:
    found = re.findall(r"^  .*\b(TEXT|INTEGER|FLOAT|RANGE|PATH|CHOICE|VALUE)\b", help_of(words), re.MULTILINE)
    assert not found or words in {"write", "encode", "simulate"}  # which have ELEMENT=VALUE or a TEXT


def test_backup_fits_the_screen_but_for_the_connection() -> None:
    text = help_of("backup")
    rest = text.replace(f"Connection:\n{section(text, 'Connection:')}\n\n", "")
    assert len(rest.splitlines()) <= 24
    assert max(map(len, text.splitlines())) <= 80


@each(
    ("words", "hidden"),
    [
        ("scan", "-s, --station"), ("scan", "--read-only"), ("loopback", "--retries"),
        ("status", "--read-only"),
        ("backup", "--read-only"), ("read", "--read-only"), ("check", "--read-only"), ("status", "--format"),
    ],
)  # fmt: skip
def test_what_has_no_effect_is_not_shown_and_is_taken(words: str, hidden: str) -> None:
    assert hidden not in help_of(words)
    option = hidden.rsplit(maxsplit=1)[-1]
    assert any(option in parameter.opts for parameter in commands()[words].params)


@each(
    "words",
    ["write", "restore", "run", "discrete set", "snapshot apply", "link table write", "inventory add"],
)
def test_read_only_is_shown_where_something_is_written(words: str) -> None:
    assert "--read-only" in help_of(words)


# --- examples ---------------------------------------------------------------------------------------------


def examples() -> list[str]:
    found: dict[str, None] = {}
    for command in commands().values():
        match = re.match(r"Examples?: (.*)", command.epilog or "", re.DOTALL)
        if match:
            found |= dict.fromkeys(re.split(r";  +", match[1]))
    return list(found)


def fill(folder: Path) -> None:
    """The files that the examples name."""
    os.chdir(folder)
    for words in (
        "backup press.json -p sim: -q",
        "backup line.json -p sim: --trace line.pcap -q",
        "snapshot R0-R9 -p sim: -o press-data.json",
    ):
        assert run_in_process(words.split()) == 0
    for name in ("monday", "tuesday"):
        shutil.copy("press.json", f"{name}.json")
        shutil.copy("press-data.json", f"{name}-data.json")
    project_file("press.pdw", IMAGE, elements=ELEMENTS)
    shutil.copy(EXAMPLES / "press.toml", "press.toml")
    (table,) = re.findall(r"```toml\n(kind.*?)```", (DOCS / "link.md").read_text("utf-8"), re.DOTALL)
    Path("table.toml").write_text(table, encoding="utf-8")
    write = "link table write table.toml R500 -p sim:plc.state --yes -q"
    assert run_in_process(write.split()) == 0
    Path("fatek.toml").write_text(
        '[plc.hall-1]\ntarget = "sim:hall.state"\ntags = ["hall", "night"]\nspec = "press.toml"\n'
        'reference = "press.json"\nexpect = "any"\n',
        encoding="utf-8",
    )
    save_backup(backup(simulated(ladder_words=13184, program_seed=2).plc), Path("before.json"))
    for file in ("before.json", "press.json"):
        assert run_in_process(["history", "record", "press-3", file, "--history", "plc-history", "-q"]) == 0
    Path("before.json").unlink()


def test_examples_are_for_each_shell() -> None:
    """cmd.exe hands single quotes on, and PowerShell takes ``$`` and a backslash otherwise than sh."""
    for name, command in commands().items():
        assert "'" not in (command.epilog or ""), name
        assert not re.search(r"-p '", command.help or ""), name
    for example in examples():
        if "completion" not in example:
            assert not re.search(r"[$\\`]", example), example


def in_a_shell(text: str, environment: dict[str, str]) -> Done:
    done = subprocess.run(["bash", "-c", text], env=environment, capture_output=True, text=True, check=False)
    return Done(done.returncode, done.stdout, done.stderr)


def serves_until_it_is_ended(text: str, environment: dict[str, str]) -> bool:
    words = ["bash", "-c", f"exec {text}"]
    with subprocess.Popen(words, env=environment, stdout=subprocess.PIPE, text=True) as server:
        assert server.stdout is not None
        listens = server.stdout.readline().startswith("listening ")
        server.send_signal(signal.SIGTERM)
        server.communicate()
    return listens and server.returncode == 0


@pytest.mark.skipif(shutil.which("bash") is None, reason="the examples are for a shell")
def test_the_examples_run_as_they_are_printed(
    tmp_path: Path, cli: Cli, monkeypatch: pytest.MonkeyPatch
) -> None:
    """In this process what has only words, quoted or not; in a shell what needs one."""
    monkeypatch.chdir(tmp_path)
    fill(tmp_path)
    monkeypatch.setattr("time.sleep", lambda _: None)  # between the rounds of watch
    environment = os.environ | {"PATH": shell_path(), "FATEKTOOL_LOCK_DIR": str(tmp_path)}
    failed = []
    for text in examples():
        if "fatektool simulate" in text:
            assert serves_until_it_is_ended(text, environment)
            continue
        done = in_a_shell(text, environment) if re.search(r"[|$]", text) else cli(*shlex.split(text)[1:])
        differs = done.code == 1 and "diff" in text  # the answer, and no error
        if done.code and not differs:
            failed.append(f"{text}\n  {done.code}: {done.err[:300]}{done.out[:200]}")
    assert not failed, "\n".join(failed)
