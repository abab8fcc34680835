"""``history check``: all objects and backups of a history."""

from __future__ import annotations

from typing import TYPE_CHECKING

import click

from fatektool.cli.many.history.documents import (
    check_document,
)
from fatektool.cli.many.history.options import history_option
from fatektool.cli.shared.options import voice_options
from fatektool.counts import counted
from fatektool.history.checking import check
from fatektool.history.revisions import SHORT

if TYPE_CHECKING:
    from collections.abc import Iterator
    from pathlib import Path

    from fatektool.cli.shared.output import Voice
    from fatektool.history.checking import Damage, HistoryCheck


@click.command("check", epilog="Example: fatektool history check --history plc-history")
@history_option
@voice_options
def check_command(folder: Path, voice: Voice) -> int:
    """Check all objects and backups of a history.

    Exit 0 if nothing is damaged or missing, 1 if something is.
    """
    with voice.progress("commits") as bar:
        found = check(folder, bar.update)
    voice.show(check_document(found, folder), _lines(found))
    return 1 if found.faults else 0


def _lines(found: HistoryCheck) -> Iterator[str]:
    """What was checked, and what is damaged."""
    commits, programs = counted(found.commits, "commit"), counted(found.programs, "program")
    looked = f"{commits}, {programs}, {counted(len(found.names), 'PLC')} now"
    yield (
        f"damaged: {counted(len(found.faults), 'fault')} in {looked}"
        if found.faults
        else f"no damage: {looked}"
    )
    if found.shallow:
        yield "a shallow clone: older commits are missing; 'git fetch --unshallow' gets them"
    for fault in found.faults:
        yield f"  {_place(fault)}{fault.message}"


def _place(fault: Damage) -> str:
    if fault.revision is None:
        return ""
    return f"{fault.name}@{fault.revision[:SHORT]}: " if fault.name else f"{fault.revision[:SHORT]}: "
