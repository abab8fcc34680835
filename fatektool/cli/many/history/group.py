"""``history``: each version of the programs of many PLCs, in a git repository."""

from __future__ import annotations

import click

from fatektool.cli.shared.lazy_group import LazyGroup, Subcommand, commands


@click.group(
    "history",
    cls=LazyGroup,
    sections=commands(
        record=Subcommand("many.history.record", "Record a backup, if the program changed."),
        log=Subcommand("many.history.log", "List the changes, newest first."),
        show=Subcommand("many.history.show", "Show a recorded backup, and what changed."),
        diff=Subcommand("many.history.diff", "Compare a program at two revisions."),
        export=Subcommand("many.history.export", "Write a recorded backup to a file."),
        check=Subcommand("many.history.check", "Check all objects and backups."),
    ),
    epilog="Example: fatektool history log press-3 --history plc-history",
)
def history_command() -> None:
    """Keep each version of the programs in a git repository: a file for each PLC, a commit for each change.

    'fleet backup --history DIR' and 'history record' write it. Any git can read it: 'git log -p'.

    A revision REV is a hash (a1b2c3d), HEAD~2, a date or time in UTC (2026-11-22: the last commit of that day
    or before), or ~1: the program of this PLC before its last change; ~2: the one before that.
    """
