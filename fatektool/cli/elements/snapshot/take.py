"""``snapshot take``: a PLC's data to JSON and other formats."""

from __future__ import annotations

import os
import re
from functools import wraps
from pathlib import Path
from typing import TYPE_CHECKING, Any, Final, TypeVar

import click

from fatektool.cli.elements.selection import selected, spec_options
from fatektool.cli.elements.values import SELECTION, warn_of
from fatektool.cli.programs.program_files import comments_for, comments_options
from fatektool.cli.shared.connection_options import connection_options_but_format
from fatektool.cli.shared.modbus_map import modbus_map_option
from fatektool.cli.shared.options import PATH, completing, standard
from fatektool.cli.shared.output import elements_bar, passed
from fatektool.cli.shared.places import require_folder_for, require_free
from fatektool.cli.shared.report import report_option, write_snapshot_report
from fatektool.cli.shared.streams import print_text
from fatektool.counts import counted
from fatektool.errors import PlcError, UsageError
from fatektool.files.atomic import write_whole
from fatektool.jobs.snapshots.comments import snapshot_with_comments
from fatektool.jobs.snapshots.formats import FORMATS, SUFFIXES, as_json, as_ndjson, as_prometheus
from fatektool.jobs.snapshots.snapshot import take_all, take_snapshot
from fatektool.jobs.snapshots.store import Keep, append_line, encoded, require_lines, save_dated
from fatektool.protocol.commands import Command

if TYPE_CHECKING:
    from collections.abc import Callable

    from fatektool.cli.shared.connection import Connection
    from fatektool.cli.shared.output import Voice

_LINE: Final = re.compile(r"\d[A-Za-z][\d.]{1,3}", re.ASCII)
_LOOKED_AT: Final = 200
_SERIES: Final = {"json", "ndjson"}
_BACKUP: Final = b'"fatektool.backup/'
F = TypeVar("F", bound="Callable[..., Any]")


def either_format(function: F) -> F:
    """``--format`` is that of the snapshot; the line's, which is ``--line``, is taken too, in any order."""

    @wraps(function)
    def with_formats(*args: Any, formats: tuple[str, ...], **rest: Any) -> Any:
        forms = [text for text in formats if text.lower() in FORMATS]
        lines = [text for text in formats if text.lower() not in FORMATS]
        if len(forms) > 1 or len(lines) > 1:
            raise UsageError(
                f"--format {' '.join(formats)}: expected one of {', '.join(FORMATS)}, "
                f"once, and --line for the line"
            )
        if lines and not _LINE.fullmatch(lines[0]):
            raise UsageError(
                f"--format {lines[0]}: expected one of {', '.join(FORMATS)}; the line's format is --line"
            )
        form = forms[0].lower() if forms else None
        return function(*args, form=form, old_format=lines[0] if lines else None, **rest)

    return with_formats  # type: ignore[return-value]  # click's decorators hand back what they get


@click.command(
    "take",
    epilog="Example: fatektool snapshot --spec press.toml -p sim: --append press.ndjson --keep 90d",
    help=f"Read data from the PLC and save it.\n\n{SELECTION}",
)
@click.argument("elements", nargs=-1, shell_complete=completing("complete_elements"))
@spec_options
@click.option("--all", "whole", is_flag=True, help="All elements that the PLC has, by its status (53).")
@click.option(
    "-o",
    "--output",
    type=str,
    metavar="FILE|DIR/",
    help="Write to FILE, or to a dated file in DIR; without it, and for -, to stdout.",
)
@click.option("--append", type=PATH, metavar="FILE.ndjson", help="Append one line to FILE.")
@click.option(
    "--format",
    "formats",
    multiple=True,
    metavar="json|ndjson|csv|influx|prometheus",
    help="Format of the snapshot.  [default: that of FILE's ending, else json]",
)
@click.option(
    "--keep", metavar="N|DAYSd", help="Keep N snapshots, or those of so many days, in DIR or FILE.ndjson."
)
@comments_options
@report_option
@either_format
@connection_options_but_format
@modbus_map_option
def take_command(
    elements: tuple[str, ...],
    connection: Connection,
    voice: Voice,
    *,
    spec: Path | None,
    groups: tuple[str, ...],
    whole: bool,
    output: str | None,
    append: Path | None,
    form: str | None,
    keep: str | None,
    report: Path | None,
    comments: Path | None,
    encoding: str | None,
) -> int:
    """Read data from the PLC."""
    texts = comments_for(connection, comments, voice, encoding)
    items = selected(elements, spec, groups, whole=whole).items
    kept = None if keep is None else Keep.parse(keep)
    output = None if output is None else standard(output)
    to_stdout = output == "-" or (output is None and append is None)
    output = None if output == "-" else output
    folder = _folder(output)
    form = _form(form, voice, output, append, to_stdout=to_stdout)
    if kept is not None and folder is None and append is None:
        raise UsageError("--keep goes with -o DIR/ or --append FILE")
    if report is not None and folder is not None and form not in _SERIES:
        raise UsageError(
            f"--report shows the snapshots in {folder}: expected --format json or ndjson, got {form}"
        )
    _require_places(output, folder, append, kept, voice)
    needs = (Command.DETAILED_STATUS,) if whole else ()
    with connection.open(voice, needs=needs) as plc, elements_bar(voice, items, whole=whole) as bar:
        began = plc.link.transport.clock()
        snapshot = take_all(plc, bar.update) if whole else take_snapshot(plc, items, bar.update)
        took = passed(plc, plc.link.transport.clock() - began)
    snapshot = snapshot_with_comments(snapshot, texts)
    values = counted(len(snapshot.values) - len(snapshot.errors), "value")
    if form == "prometheus":
        text = as_prometheus(snapshot, _name(output, folder, spec))
    else:
        text = FORMATS[form](snapshot)
    if folder is not None:
        path = save_dated(snapshot, text, folder, suffix=SUFFIXES[form], keep=kept)
        voice.say(f"saved {path}: {values}, took {took}")
    elif output is not None:
        write_whole(Path(output), encoded(text), overwrite=True)
        voice.say(f"saved {output}: {values}, took {took}")
    if append is not None:
        wait_s = max(60.0, connection.address.lock_wait_s)
        append_line(append, as_ndjson(snapshot), kept, wait_s=wait_s, waiting=voice.say)
        voice.say(f"appended to {append}: {values}, took {took}")
    if report is not None:
        write_snapshot_report(report, snapshot, append or folder)
    if to_stdout:
        print_text(as_json(snapshot) if voice.json else text)
    elif voice.json:
        click.echo(as_json(snapshot), nl=False)
    warn_of(snapshot.errors, voice, snapshot.not_asked)
    return PlcError.exit_code if snapshot.errors else 0


def _name(output: str | None, folder: Path | None, spec: Path | None) -> str:
    """What distinguishes the metrics of two snapshots of one PLC: the file, or the specification."""
    if folder is not None:
        return folder.name
    if output is not None:
        return Path(output).stem
    return "" if spec is None else spec.stem


def _form(form: str | None, voice: Voice, output: str | None, append: Path | None, *, to_stdout: bool) -> str:
    """The format of the snapshot: of ``--format``, else of FILE's ending, else JSON.

    Raises:
        UsageError: a format that nothing would be written in.
    """
    suffix = "" if output is None else Path(output).suffix.lower().removeprefix(".")
    of_name = next((name for name, ending in SUFFIXES.items() if ending == suffix), None)
    if append is not None:
        ending = append.suffix.lower().removeprefix(".")
        if ending in SUFFIXES.values() and ending not in _SERIES:
            raise UsageError(f"--append {append} writes NDJSON: expected a name such as x.ndjson")
        if form not in {None, "ndjson"} and output is None and not to_stdout:
            raise UsageError(
                f"--append writes NDJSON, which does not go with --format {form}",
                hint=f"leave out --format, or add -o FILE for {form}",
            )
    if form not in {None, "json"} and voice.json and to_stdout:
        raise UsageError(
            f"--json does not go with --format {form} on standard output",
            hint=f"leave one out, or add -o FILE for {form}",
        )
    return form or of_name or "json"


def _require_places(
    output: str | None, folder: Path | None, append: Path | None, kept: Keep | None, voice: Voice
) -> None:
    """Check, before the PLC is asked, that the snapshot can be written."""
    if folder is not None:
        require_folder_for(folder, voice)
    if append is not None:
        require_lines(append, kept)
    if output is not None and folder is None:
        _require_output(Path(output))


def _require_output(path: Path) -> None:
    """Check that a snapshot can be written here, and does not replace the backup of a program.

    Raises:
        UsageError: it cannot be written, or there is a backup.
    """
    require_free(path)
    real = Path(os.path.realpath(path))
    try:
        with real.open("rb") as file:
            start = file.read(_LOOKED_AT)
    except OSError:  # it is not there, or cannot be read, but perhaps replaced
        return
    if _BACKUP in start:
        raise UsageError(
            f"{path} is the backup of a program, and is kept", hint="name another file", file=str(path)
        )


def _folder(output: str | None) -> Path | None:
    if output is None or not (output.endswith(("/", "\\")) or Path(output).is_dir()):
        return None
    return Path(output)
