"""``--line`` is the line's format; ``--format``, its former name, is taken where it is not the output's."""

from __future__ import annotations

from typing import TYPE_CHECKING

import click

from fatektool.cli.shared.connection_options import connection_options
from tests.cli.terminal import Terminal
from tests.rows import each

if TYPE_CHECKING:
    from fatektool.cli.shared.connection import Connection
    from fatektool.cli.shared.output import Voice
    from tests.cli.running import Cli


def line_of(*words: str) -> str:
    """The line's format that a command gets."""
    found: list[Connection] = []

    @click.command
    @connection_options
    def command(connection: Connection, voice: Voice) -> None:
        assert not voice.json
        found.append(connection)

    command.main(["-p", "sim:", *words], standalone_mode=False)
    return str(found[0].address.format)


@each("word", ["--line", "--format"])
def test_both_names_set_the_line(cli: Cli, word: str) -> None:
    assert line_of(word, "8n1") == "8N1"
    assert line_of(f"{word}=7O1") == "7O1"
    wrong = cli("status", "-p", "sim:", word, "9X3")
    assert (wrong.code, f"'{word}': expected data bits" in wrong.err) == (2, True)


def test_both_at_once_are_refused(cli: Cli) -> None:
    done = cli("status", "-p", "sim:", "--line", "7E1", "--format", "8N1")
    assert (done.code, "--line and --format are the same option: give --line alone" in done.err) == (2, True)


def test_the_help_has_the_new_name_alone(cli: Cli) -> None:
    for words in (["status"], ["scan"], ["simulate"], ["snapshot", "take"]):
        said = cli(*words, "--help").out
        assert "--line 7E1" in said
        assert ("--format " in said) is (words == ["snapshot", "take"])


def test_a_terminal_is_told_of_the_new_name_and_a_cron_job_is_not(cli: Cli) -> None:
    assert cli("status", "-p", "sim:", "--brief", "--format", "7E1").err == ""
    with Terminal("status", "-p", "sim:", "--brief", "--format", "7E1") as terminal:
        assert terminal.end() == 0
    assert "the line's --format is --line now; --format still works" in terminal.text


def test_a_snapshot_has_both(cli: Cli) -> None:
    for words in (["--format", "csv", "--line", "8N1"], ["--format", "8N1", "--format", "csv"]):
        assert cli("snapshot", "R0", "-p", "sim:", *words).out.startswith("time,target,")
    refused = cli("snapshot", "R0", "-p", "sim:", "--format", "xml")
    assert (
        "--format xml: expected one of json, ndjson, csv, influx, prometheus; the line's format is --line"
        in (refused.err)
    )


def test_the_simulator_takes_both(cli: Cli) -> None:
    for word in ("--line", "--format"):
        done = cli("simulate", "--tcp", ":0", word, "7E1")
        assert (done.code, f"{word} has no effect here: it goes with --baud" in done.err) == (2, True)
