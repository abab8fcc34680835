"""``--report FILE.html``: what a command found, as a page to look at.

An existing report is kept unless ``--force`` replaces it. Any other file is always kept: a wrong name
must not destroy a backup. That is looked at before a PLC is asked, and again before FILE is written.
"""

from __future__ import annotations

from contextlib import contextmanager
from functools import wraps
from typing import TYPE_CHECKING, Any, TypeVar

import click

from fatektool.cli.shared.options import PATH
from fatektool.cli.shared.places import force_option, require_free
from fatektool.errors import FatektoolError, UsageError
from fatektool.files.atomic import file_error, require_place, write_whole
from fatektool.files.times import utc

if TYPE_CHECKING:
    from collections.abc import Callable, Iterator
    from pathlib import Path

    from fatektool.cli.shared.output import Voice
    from fatektool.client import Plc
    from fatektool.jobs.snapshots.series import LeftOut
    from fatektool.jobs.snapshots.snapshot import Snapshot
    from fatektool.report.rounds import Rounds

F = TypeVar("F", bound="Callable[..., Any]")


def report_option(function: F) -> F:
    """``--report FILE.html`` and ``--force``; the command gets ``report``, checked, or None."""

    @force_option
    @click.option(
        "--report", type=PATH, metavar="FILE.html", help="Also write an HTML report, to view, mail or print."
    )
    @wraps(function)
    def with_report(*args: Any, report: Path | None, **rest: Any) -> Any:
        if report is not None:
            _require_report(report)
            require_free(report)
        return function(*args, report=report, **rest)

    return with_report  # type: ignore[return-value]  # click's decorators hand back what they get


def write_report(path: Path, html: str) -> None:
    """Put a report into its file, whole or not at all.

    Raises:
        UsageError: the file cannot be written, or is not a report.
        DataError: the disk is full or broken.
    """
    _require_report(path)
    write_whole(path, html.encode(), overwrite=True)


@contextmanager
def watch_report(path: Path | None, plc: Plc, voice: Voice) -> Iterator[Rounds | None]:
    """Gather rounds; at the end, however it comes, write their report.

    Args:
        path: where to; None for no report, and then nothing is gathered.
        plc: the PLC.
        voice: warns if the report of a failed series cannot be written: the failure is more important.
    """
    if path is None:
        yield None
        return
    from fatektool.report.rounds import Rounds
    from fatektool.report.series import SeriesSource, series_report

    place = SeriesSource(plc.target, plc.link.station, plc.link.codec.name, "fatektool.watch/1", utc())
    rounds = Rounds()
    try:
        yield rounds
    except (FatektoolError, KeyboardInterrupt, OSError) as error:
        told = "interrupted"
        if not isinstance(error, KeyboardInterrupt):
            told = str(error) if isinstance(error, FatektoolError) else error.strerror or str(error)
        try:
            write_report(path, series_report(rounds, place, ended=told))
        except FatektoolError as lost:
            voice.warn(str(lost))
        raise
    write_report(path, series_report(rounds, place))


def write_snapshot_report(path: Path, snapshot: Snapshot, series: Path | None) -> None:
    """Put the report of a snapshot into its file.

    Args:
        path: where to.
        snapshot: the snapshot.
        series: the folder or NDJSON file to which it was added, and whose snapshots are shown with it; None
            for only this one.

    Raises:
        UsageError: as for ``write_report``; or the series cannot be read.
        DataError: as for ``write_report``.
    """
    from fatektool.jobs.snapshots.series import LeftOut, snapshot_series
    from fatektool.jobs.snapshots.snapshot import SCHEMA
    from fatektool.report.rounds import Rounds
    from fatektool.report.series import SeriesSource, series_report
    from fatektool.report.snapshot import snapshot_report

    rounds, left_out = Rounds(), LeftOut()
    if series is not None:
        for each in snapshot_series(series, snapshot, left_out):
            rounds.add(each.document())
    if rounds.count < 2:
        write_report(path, snapshot_report(snapshot.document()))
        return
    place = SeriesSource(snapshot.target, snapshot.station, snapshot.protocol, SCHEMA, snapshot.time)
    write_report(path, series_report(rounds, place, left_out=_said(left_out, series)))


def _said(left_out: LeftOut, series: Path | None) -> str:
    counts = {"of another PLC": left_out.foreign, "incomplete": left_out.broken}
    named = " and ".join(f"{count} {what}" for what, count in counts.items() if count)
    return f"Snapshots in {series} that are left out here: {named}." if named else ""


def _require_report(path: Path) -> None:
    """Check that a report can be put here, and that nothing else is lost by it.

    Raises:
        UsageError: it cannot, or there is another kind of file.
    """
    from fatektool.report.page import LONGEST_START, is_report

    if str(path) == "-":
        raise UsageError("--report -: expected a file name")
    real = require_place(path, overwrite=True)
    try:
        with real.open("rb") as file:
            start = file.read(LONGEST_START)
    except FileNotFoundError:
        return
    except OSError as error:
        raise file_error("look at", path, error) from error
    if start and not is_report(start.decode(errors="replace")):
        raise UsageError(
            f"{path} exists and is not a report: it is not replaced", hint="name another file", file=str(path)
        )
