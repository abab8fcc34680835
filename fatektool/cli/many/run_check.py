"""The check of one PLC, as ``check`` and ``fleet check`` run it."""

from __future__ import annotations

from datetime import UTC, datetime
from functools import partial
from typing import TYPE_CHECKING, Any

from fatektool.callbacks import ignore
from fatektool.cli.many.documents import check_document
from fatektool.cli.many.outcome import JobResult
from fatektool.cli.shared.unfinished import unfinished
from fatektool.jobs.check.plc import check_plc

if TYPE_CHECKING:
    from fatektool.cli.shared.connection import Connection
    from fatektool.cli.shared.output import Voice
    from fatektool.jobs.check.plc import CheckPlan
    from fatektool.jobs.check.result import CheckResult
    from fatektool.jobs.progress import Progress
    from fatektool.transport.limit import Limit
    from fatektool.transport.shared_line import SharedLine


def run_check(
    connection: Connection,
    plan: CheckPlan,
    voice: Voice,
    *,
    limit: Limit,
    shared: SharedLine | None = None,
    progress: Progress = ignore,
) -> CheckResult:
    """Check one PLC.

    Args:
        connection: where it is.
        plan: what is checked.
        voice: prints notes about the line.
        limit: ends the check.
        shared: keeps the line open for the next PLC on it.
        progress: called for each page.

    Raises:
        FatektoolError: the user ended it.
    """
    return check_plc(
        plan,
        partial(connection.open, voice, limit=limit, shared=shared),
        unfinished=partial(unfinished, connection.address.target, connection.address.station),
        now=datetime.now(UTC),
        progress=progress,
        is_stopped=lambda: limit.stopped,
    )


def check_result(connection: Connection, name: str, plan: CheckPlan, found: CheckResult) -> JobResult:
    """What a check found, as the result of a turn."""
    return JobResult(
        int(found.state),
        found_document(connection, name, found),
        found.words,
        plan.reference,
        found.differs,
        found.flags,
        found.flags is not None,
    )


def found_document(connection: Connection, name: str, found: CheckResult) -> dict[str, Any]:
    """``fatektool.check/1`` of a PLC; ``name`` is what it is called."""
    return check_document(
        found.state,
        found.words,
        found,
        name=name,
        target=connection.address.target,
        station=connection.address.station,
        protocol=connection.address.protocol,
    )
