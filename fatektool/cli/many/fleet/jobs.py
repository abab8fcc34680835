"""What the fleet commands do with one PLC: the same as the single commands, in the words of one line.

Each maker gives a work for ``fleet_run``, which runs it in a thread.
"""

from __future__ import annotations

import time
from dataclasses import dataclass
from pathlib import Path
from typing import TYPE_CHECKING, Any

from fatektool.cli.plc.documents import status_document
from fatektool.cli.programs.differences import size_of
from fatektool.cli.programs.documents import saved_document, verify_document
from fatektool.cli.programs.program_files import comments_of_entry
from fatektool.cli.shared.image_words import warn_of_image
from fatektool.cli.shared.options import connection_of
from fatektool.errors import DataError, PlcError, UsageError
from fatektool.jobs.programs.backup import backup
from fatektool.jobs.programs.safekeeping import former_hash, require_ladder
from fatektool.jobs.programs.verify import verify_file
from fatektool.jobs.status import read_status
from fatektool.program.archive import save_backup
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


@dataclass(frozen=True, slots=True)
class Done:
    """What became of one PLC's turn.

    Attributes:
        exit_code: that of the single command.
        document: that of the single command.
        words: the same on one line.
        file: what was written, or compared with.
        changed: True if the program is another than before; None where nobody can tell.
        flags: the PLC's status, where it was read.
        up: whether the PLC answered; None if it was not asked.
    """

    exit_code: int
    document: dict[str, Any]
    words: str
    file: Path | None = None
    changed: bool | None = None
    flags: StatusFlags | None = None
    up: bool | None = True


def opened(entry: PlcEntry, turn: Turn[Done], voice: Voice, *needs: Command) -> Plc:
    """The PLC, connected within the limit of its turn."""
    return connection_of(entry).open(voice.of(entry.name), needs=needs, limit=turn.limit, shared=turn.shared)


def status_work(voice: Voice, *, brief: bool) -> Callable[[PlcEntry, Turn[Done]], Done]:
    """``fleet status``."""

    def work(entry: PlcEntry, turn: Turn[Done]) -> Done:
        with opened(entry, turn, voice) as plc:
            report = read_status(plc, brief=brief)
        return Done(0, status_document(report), flag_words(report.flags), flags=report.flags)

    return work


def backup_work(
    voice: Voice,
    folder: Path | None,
    history: History | None,
    *,
    single_pass: bool,
    any_header: bool,
) -> Callable[[PlcEntry, Turn[Done]], Done]:
    """``fleet backup``.

    Args:
        voice: is told of what is odd.
        folder: where NAME.json is written; None for nowhere.
        history: keeps what changed, open as long as the round lasts; None for none.
        single_pass: as for ``backup``.
        any_header: as for ``backup``.
    """
    kept_in = None if history is None else history.folder

    def work(entry: PlcEntry, turn: Turn[Done]) -> Done:
        began = time.monotonic()
        with opened(entry, turn, voice, Command.READ_PAGE) as plc:
            found = backup(plc, single_pass=single_pass, any_header=any_header, progress=turn.progress)
        require_ladder(found.program)
        warn_of_image(found.program, voice.of(entry.name))
        turn.progress("saving", 0, 0)
        changed = None
        path = None if folder is None else folder / f"{entry.name}.json"
        if path is not None:
            changed = _changed(path, found, voice)
            save_backup(found, path, overwrite=True)
        if history is not None:
            changed = _record(history, entry.name, found, voice)
        document = saved_document(found, path or kept_in or Path(), time.monotonic() - began)
        said = {None: "first backup", True: "CHANGED", False: "unchanged"}[changed]
        words = f"{said}, {found.program.header.text()}, {found.program.ladder_words} words"
        return Done(0, document, words, path or kept_in, changed)

    return work


def _record(history: History, name: str, backup: Backup, voice: Voice) -> bool | None:
    """Keep a backup in the history; whether it is another than the one there, None for the first."""
    found = history.record(name, backup)
    for warning in found.warnings:
        voice.of(name).warn(warning)
    return None if found.changes is None else found.revision is not None


def _changed(path: Path, found: Backup, voice: Voice) -> bool | None:
    try:
        before = former_hash(path)
    except DataError as error:  # to replace it by a good one is what helps
        voice.warn(f"{error.message}: it is replaced")
        return None
    return None if before is None else before != found.program.sha256


def verify_work(voice: Voice) -> Callable[[PlcEntry, Turn[Done]], Done]:
    """``fleet verify``."""

    def work(entry: PlcEntry, turn: Turn[Done]) -> Done:
        reference = entry.reference
        if reference is None:
            raise UsageError("it has no reference", hint='put reference = "FILE" into the inventory')
        on_file = load_program(reference)
        with opened(entry, turn, voice, Command.READ_PAGE) as plc:
            clock = plc.link.transport.clock
            began = clock()
            found = verify_file(plc, on_file, progress=turn.progress)
            document = verify_document(plc, reference, on_file.sha256, found, clock() - began)
        if found.pages.b_has_more:
            voice.of(entry.name).warn(f"the PLC has more pages than {reference}: they are not compared")
        words = f"same as {reference}" if found.same else f"DIFFERS from {reference}: {size_of(found)}"
        return Done(0 if found.same else 1, document, words, reference, not found.same)

    return work


def snapshot_work(voice: Voice, folder: Path, keep: Keep | None) -> Callable[[PlcEntry, Turn[Done]], Done]:
    """``fleet snapshot``: into a folder for each PLC, as two may have the same station."""
    from fatektool.jobs.snapshots.comments import snapshot_with_comments
    from fatektool.jobs.snapshots.formats import as_json
    from fatektool.jobs.snapshots.snapshot import take_snapshot
    from fatektool.jobs.snapshots.spec import load_spec
    from fatektool.jobs.snapshots.store import save_dated

    def work(entry: PlcEntry, turn: Turn[Done]) -> Done:
        if entry.spec is None:
            raise UsageError("it has no specification", hint='put spec = "FILE.toml" into the inventory')
        spec = load_spec(entry.spec)
        with opened(entry, turn, voice) as plc:
            snapshot = take_snapshot(plc, spec.items)
        snapshot = snapshot_with_comments(snapshot, comments_of_entry(entry, voice.of(entry.name)))
        own = _folder(folder / entry.name)
        path = save_dated(snapshot, as_json(snapshot), own, suffix="json", keep=keep)
        wrong = f", {len(snapshot.errors)} refused: {', '.join(snapshot.errors)}"[:200]
        words = f"{len(snapshot.values)} values{wrong if snapshot.errors else ''}"
        code = PlcError.exit_code if snapshot.errors else 0
        return Done(code, snapshot.document(), words, path)

    return work


def _folder(path: Path) -> Path:
    try:
        path.mkdir(mode=0o750, exist_ok=True)
    except OSError as error:
        raise DataError(f"cannot make the folder {path}: {error.strerror}", file=str(path)) from error
    return path


def flag_words(flags: StatusFlags) -> str:
    """RUN or STOP, and what is not as it should be."""
    odd = {
        "battery LOW": flags.battery_low,
        "ladder checksum ERROR": flags.ladder_checksum_error,
        "watchdog TIMED OUT": flags.watchdog_timeout,
        "emergency stop ACTIVE": flags.emergency_stop,
    }
    return ", ".join(["RUN" if flags.running else "STOP", *(word for word, on in odd.items() if on)])
