"""Help, version, completion: what the command line tells of itself."""

from __future__ import annotations

import re
from typing import TYPE_CHECKING

import click
import pytest

from fatektool.cli.app import JOBS, app
from fatektool.cli.shared.lazy_group import LazyGroup
from fatektool.version import __version__

if TYPE_CHECKING:
    from collections.abc import Iterator

    from tests.cli.running import Cli


def test_version(cli: Cli) -> None:
    assert cli("--version") == (0, f"fatektool {__version__}\n", "")


def test_the_help_groups_the_commands_by_job(cli: Cli) -> None:
    done = cli("--help")
    assert (done.code, done.err) == (0, "")
    places = [done.out.index(f"{job}:\n") for job in JOBS]
    assert places == sorted(places)
    for name, entry in app.subcommands.items():
        assert re.search(rf"^  {name} +{re.escape(entry.help[:40])}", done.out, re.MULTILINE), name


def test_version_and_help_are_commands_too(cli: Cli) -> None:
    assert cli("version") == cli("--version")
    assert cli("help") == cli("--help")
    assert cli("help", "backup") == cli("backup", "--help")
    assert cli("help", "snapshot", "apply") == cli("snapshot", "apply", "--help")
    done = cli("help", "backupp")
    assert (done.code, done.out) == (2, "")
    assert "did you mean backup?" in done.err
    assert "'fatektool backup' has no commands: got 'x'" in cli("help", "backup", "x").err


def test_no_command_is_a_question_for_help(cli: Cli) -> None:
    assert cli() == (2, cli("--help").out, "")


@pytest.mark.parametrize("name", app.subcommands)
def test_every_command_has_help_with_an_example(cli: Cli, name: str) -> None:
    for option in ("--help", "-h"):
        done = cli(name, option)
        assert (done.code, done.err) == (0, "")
        assert re.search(rf"Examples?:.*fatektool {name}", " ".join(done.out.split())), done.out
        assert app.subcommands[name].help


@pytest.mark.parametrize("name", app.subcommands)
def test_the_examples_are_good_command_lines(cli: Cli, name: str) -> None:
    example = " ".join(cli(name, "--help").out.split()).partition("Example")[2]
    found = re.findall(r"fatektool ([^;|&)]+)", example)
    assert found
    for words in found:
        first, *rest = words.split()
        with click.Context(app) as context:
            command = app.get_command(context, first)
            assert command is not None
            command.make_context(first, rest, context)  # raises for a wrong option


@pytest.mark.parametrize(
    ("wrong", "near"),
    [("bakup", "backup"), ("restor", "restore"), ("statsu", "status"), ("Status", "status"), ("dif", "diff")],
)
def test_a_near_miss(cli: Cli, wrong: str, near: str) -> None:
    done = cli(wrong)
    assert done.code == 2
    assert f"no such command '{wrong}'; did you mean {near}" in done.err


@pytest.mark.parametrize(
    ("words", "near"),
    [
        ("fleet verfy", "verify"),
        ("history exprt", "export"),
        ("inventory lst", "list"),
        ("link tabel", "table"),
        ("link table wirte", "write"),
    ],
)
def test_a_near_miss_in_a_group(cli: Cli, words: str, near: str) -> None:
    done = cli(*words.split())
    *group, wrong = words.split()
    told = f"no such command '{wrong}'; did you mean {near}?; see 'fatektool {' '.join(group)} --help'"
    assert (done.code, done.err) == (2, f"fatektool: {told}\n")


def groups(group: LazyGroup, *words: str) -> Iterator[tuple[tuple[str, ...], LazyGroup]]:
    """The groups that load their commands when they are used, by the words of the command line."""
    yield words, group
    context = click.Context(group)
    for name in group.subcommands:
        found = group.get_command(context, name)
        if isinstance(found, LazyGroup):
            yield from groups(found, *words, name)


GROUPS = dict(groups(app))


def test_there_are_groups_in_groups() -> None:
    assert {"fleet", "history", "inventory", "link", "link table", "snapshot"} < set(map(" ".join, GROUPS))


@pytest.mark.parametrize("words", GROUPS)
def test_a_group_has_the_commands_of_its_help(cli: Cli, words: tuple[str, ...]) -> None:
    done = cli(*words, "--help")
    assert done.code == 0
    for name, each in GROUPS[words].subcommands.items():
        assert f"  {name} " in done.out
        assert each.help in " ".join(done.out.split())
        command = GROUPS[words].get_command(click.Context(GROUPS[words]), name)
        assert command is not None
        assert command.name == name


def test_a_far_miss(cli: Cli) -> None:
    assert cli("xyzzy").err == "fatektool: no such command 'xyzzy'; see 'fatektool --help'\n"


@pytest.mark.parametrize("shell", ["bash", "zsh", "fish"])
def test_completion_is_printed(cli: Cli, shell: str) -> None:
    done = cli("completion", shell)
    assert done.code == 0
    assert "_FATEKTOOL_COMPLETE" in done.out
    assert f"{shell}_complete" in done.out


def test_completion_of_another_shell(cli: Cli) -> None:
    assert cli("completion", "tcsh").code == 2


@pytest.mark.parametrize(
    ("typed", "number", "found"),
    [
        ("fatektool re", 1, "plain,restore"),
        ("fatektool restore --saf", 2, "plain,--safety-dir"),
        ("fatektool completion f", 2, "plain,fish"),
        ("fatektool status --protocol f", 3, "plain,facon"),
    ],
)
def test_completion_completes(
    cli: Cli, monkeypatch: pytest.MonkeyPatch, typed: str, number: int, found: str
) -> None:
    monkeypatch.setenv("_FATEKTOOL_COMPLETE", "bash_complete")
    monkeypatch.setenv("COMP_WORDS", typed)
    monkeypatch.setenv("COMP_CWORD", str(number))
    done = cli()
    assert done.code == 0
    assert found in done.out.splitlines()


def test_a_group_without_a_command_names_its_commands(cli: Cli) -> None:
    done = cli("discrete")
    assert (done.code, done.out) == (2, "")
    expected = "fatektool discrete: expected one of disable, enable, list, reset, set"
    assert done.err == f"fatektool: {expected}; see 'fatektool discrete --help'\n"
