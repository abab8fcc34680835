"""``history``: the programs of many PLCs as they changed, in a git repository."""

from __future__ import annotations

import click

from fatektool.cli.shared.lazy_group import LazyGroup, Subcommand, commands


@click.group(
    "history",
    cls=LazyGroup,
    sections=commands(
        record=Subcommand("many.history.record", "Keep a backup, if its program changed."),
        log=Subcommand("many.history.log", "List the changes, newest first."),
        show=Subcommand("many.history.show", "Show a PLC's program, the newest or at a revision."),
        diff=Subcommand("many.history.diff", "Compare a PLC's program at two revisions."),
        export=Subcommand("many.history.export", "Write a PLC's backup to a file."),
        check=Subcommand("many.history.check", "Check every object and every backup."),
    ),
    epilog="Example: fatektool history log press-3 --history plc-history",
)
def history_command() -> None:
    """Keep each version of the programs in a git repository: a file for each PLC, a commit for each change.

    'fleet backup --history DIR' and 'history record' write it. Any git can read it: 'git log -p'.

    A revision REV is a hash (a1b2c3d), HEAD~2, a date or time in UTC (2026-11-22: the last commit of that day
    or before), or ~1: the program of this PLC before its last change; ~2: the one before that.
    """
