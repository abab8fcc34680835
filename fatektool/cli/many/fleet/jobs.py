"""What the fleet commands do with one PLC: the same as the single commands, in the words of one line.

Each maker gives a work for ``fleet_run``, which runs it in a thread.
"""

from __future__ import annotations

from pathlib import Path
from typing import TYPE_CHECKING

from fatektool.cli.many.outcome import Result
from fatektool.cli.plc.documents import status_document
from fatektool.cli.programs.differences import size_of
from fatektool.cli.programs.documents import saved_document, verify_document
from fatektool.cli.programs.program_files import comments_of_entry
from fatektool.cli.shared.image_words import warn_of_image
from fatektool.cli.shared.options import connection_of
from fatektool.errors import PlcError, UsageError
from fatektool.files.atomic import make_folder
from fatektool.jobs.programs.backup import read_backup
from fatektool.jobs.programs.safekeeping import replace_backup, require_ladder
from fatektool.jobs.programs.verify import compare_with_plc
from fatektool.jobs.status import read_status
from fatektool.project.program_file import load_program
from fatektool.protocol.commands import Command

if TYPE_CHECKING:
    from collections.abc import Callable

    from fatektool.cli.shared.output import Voice
    from fatektool.client import Plc
    from fatektool.history.history import History
    from fatektool.inventory.entries import PlcEntry
    from fatektool.jobs.fleet.rounds import Turn
    from fatektool.jobs.snapshots.store import Keep
    from fatektool.program.archive import Backup
    from fatektool.protocol.status import StatusFlags


def opened(entry: PlcEntry, turn: Turn[Result], voice: Voice, *needs: Command) -> Plc:
    """The PLC, connected within the limit of its turn."""
    return connection_of(entry).open(voice.of(entry.name), needs=needs, limit=turn.limit, shared=turn.shared)


def status_work(voice: Voice, *, brief: bool) -> Callable[[PlcEntry, Turn[Result]], Result]:
    """``fleet status``."""

    def work(entry: PlcEntry, turn: Turn[Result]) -> Result:
        with opened(entry, turn, voice) as plc:
            report = read_status(plc, brief=brief)
        return Result(0, status_document(report), flag_words(report.flags), flags=report.flags)

    return work


def backup_work(
    voice: Voice,
    folder: Path | None,
    history: History | None,
    *,
    single_pass: bool,
    any_header: bool,
) -> Callable[[PlcEntry, Turn[Result]], Result]:
    """``fleet backup``.

    Args:
        voice: is told of what is odd.
        folder: where NAME.json is written; None for nowhere.
        history: keeps what changed, open as long as the round lasts; None for none.
        single_pass: as for ``backup``.
        any_header: as for ``backup``.
    """
    kept_in = None if history is None else history.folder

    def work(entry: PlcEntry, turn: Turn[Result]) -> Result:
        own = voice.of(entry.name)
        with opened(entry, turn, voice, Command.READ_PAGE) as plc:
            found = read_backup(plc, single_pass=single_pass, any_header=any_header, progress=turn.progress)
        program = found.backup.program
        require_ladder(program)
        warn_of_image(program, own)
        turn.progress("saving", 0, 0)
        changed = None
        path = None if folder is None else folder / f"{entry.name}.json"
        if path is not None:
            replaced = replace_backup(found.backup, path)
            changed = replaced.changed
            if replaced.damaged is not None:
                voice.warn(f"{replaced.damaged}: it is replaced")
        if history is not None:
            changed = _record(history, entry.name, found.backup, own)
        document = saved_document(found, path or kept_in or Path())
        said = {None: "first backup", True: "CHANGED", False: "unchanged"}[changed]
        words = f"{said}, {program.header.text()}, {program.ladder_words} words"
        return Result(0, document, words, path or kept_in, changed)

    return work


def _record(history: History, name: str, backup: Backup, voice: Voice) -> bool | None:
    """Keep a backup in the history; whether it is another than the one there, None for the first."""
    found = history.record(name, backup)
    for warning in found.warnings:
        voice.warn(warning)
    return None if found.changes is None else found.revision is not None


def verify_work(voice: Voice) -> Callable[[PlcEntry, Turn[Result]], Result]:
    """``fleet verify``."""

    def work(entry: PlcEntry, turn: Turn[Result]) -> Result:
        reference = entry.reference
        if reference is None:
            raise UsageError("it has no reference", hint='put reference = "FILE" into the inventory')
        on_file = load_program(reference)
        with opened(entry, turn, voice, Command.READ_PAGE) as plc:
            result = compare_with_plc(plc, on_file, progress=turn.progress)
            document = verify_document(plc, result)
        found = result.found
        if found.pages.b_has_more:
            voice.of(entry.name).warn(f"the PLC has more pages than {reference}: they are not compared")
        words = f"same as {reference}" if found.same else f"DIFFERS from {reference}: {size_of(found)}"
        return Result(0 if found.same else 1, document, words, reference, not found.same)

    return work


def snapshot_work(
    voice: Voice, folder: Path, keep: Keep | None
) -> Callable[[PlcEntry, Turn[Result]], Result]:
    """``fleet snapshot``: into a folder for each PLC, as two may have the same station."""
    from fatektool.jobs.snapshots.comments import snapshot_with_comments
    from fatektool.jobs.snapshots.formats import as_json
    from fatektool.jobs.snapshots.snapshot import take_snapshot
    from fatektool.jobs.snapshots.spec import load_spec
    from fatektool.jobs.snapshots.store import save_dated

    def work(entry: PlcEntry, turn: Turn[Result]) -> Result:
        if entry.spec is None:
            raise UsageError("it has no specification", hint='put spec = "FILE.toml" into the inventory')
        spec = load_spec(entry.spec)
        with opened(entry, turn, voice) as plc:
            snapshot = take_snapshot(plc, spec.items)
        snapshot = snapshot_with_comments(snapshot, comments_of_entry(entry, voice.of(entry.name)))
        own = folder / entry.name
        make_folder(own)
        path = save_dated(snapshot, as_json(snapshot), own, suffix="json", keep=keep)
        wrong = f", {len(snapshot.errors)} refused: {', '.join(snapshot.errors)}"[:200]
        words = f"{len(snapshot.values)} values{wrong if snapshot.errors else ''}"
        code = PlcError.exit_code if snapshot.errors else 0
        return Result(code, snapshot.document(), words, path)

    return work


def flag_words(flags: StatusFlags) -> str:
    """RUN or STOP, and what is not as it should be."""
    odd = {
        "battery LOW": flags.battery_low,
        "ladder checksum ERROR": flags.ladder_checksum_error,
        "watchdog TIMED OUT": flags.watchdog_timeout,
        "emergency stop ACTIVE": flags.emergency_stop,
    }
    return ", ".join(["RUN" if flags.running else "STOP", *(word for word, on in odd.items() if on)])
