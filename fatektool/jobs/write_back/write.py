"""The order of every write that can be undone, and what the PLC has if it ends at a step.

::

    1. the plan: what is in the PLC is read and compared       as before
    2. the safety copy is on disk                              as before; the copy is removed again
    3. the plan is shown and agreed to                         the same
    4. still the same PLC? STOP it if that is planned          the same
    5. the record of an unfinished write is on disk            the same; the record is removed again
    6. each part is written, read back and compared            part before, part new; copy and record stay
    7. the record is removed                                   as planned; the copy stays

Step 1 is the job's (``plan_restore``, ``plan_apply`` …). An end at step 6 says for each part what the PLC
holds, and the same command again writes what is left: it finds the copy of the first run and keeps that one.
"""

from __future__ import annotations

from collections.abc import Callable
from contextlib import suppress
from pathlib import Path
from typing import TYPE_CHECKING

from fatektool.callbacks import ignore
from fatektool.errors import FatektoolError, LineError, PlcError, RestoreIncomplete
from fatektool.jobs.write_back.record import NO_MARK, WriteMark
from fatektool.jobs.write_back.safety_copy import kept

if TYPE_CHECKING:
    from fatektool.client import Plc
    from fatektool.jobs.progress import Progress
    from fatektool.jobs.write_back.plan import WritePlan

Agree = Callable[[Path | None], object]
"""Gets where the safety copy is, shows the plan, and raises an error if the user does not agree."""


def agreed(_: Path | None) -> None:
    """Agree to everything: for a caller that has asked already."""


def write_back(
    plc: Plc,
    plan: WritePlan,
    agree: Agree = agreed,
    *,
    mark: WriteMark = NO_MARK,
    progress: Progress = ignore,
) -> Path | None:
    """Save what is there, ask, write, read back.

    Args:
        plc: the PLC.
        plan: of this PLC, just now.
        agree: gets where the safety copy is, shows the plan, and raises an error if the user does not agree.
        mark: records that a write has begun.
        progress: called as it goes on.

    Returns:
        Where the safety copy is; None if nothing is saved.

    Raises:
        RestoreIncomplete: part of it is written; ``states`` and ``details`` have the contents of the PLC.
        UsageError: the copy cannot be written, or the user does not agree; nothing was written.
        DataError: the disk is full, or this is not the PLC of the plan; nothing was written.
        PlcError: the PLC refuses and nothing was changed, or it was rolled back.
        LineError: no answer and nothing was written, or it was rolled back.
        KeyboardInterrupt: nothing was written; says so.
    """
    with kept(plan.copy) as copy:
        agree(copy.path)
        try:
            for part in plan.parts:
                part.prepare()
        except (FatektoolError, KeyboardInterrupt) as error:
            raise _with(error, "nothing was written") from None
        counters = plc.link.counters
        sent = counters.writes
        copy.needed = True
        try:
            mark.begin(copy.path)
            for part in plan.parts:
                part.write(progress)
        except (Exception, KeyboardInterrupt) as error:
            # Whatever it is, a trace that cannot be written among it: what the PLC holds must be said.
            copy.needed = counters.writes != sent
            if copy.needed:
                _look(plan)
            known = isinstance(error, PlcError | LineError | KeyboardInterrupt)
            if not copy.needed or (known and all(part.untouched for part in plan.parts)):
                mark.end(complete=False)
                raise _with(error, f"nothing was changed, the PLC holds {_before(plan)}") from None
            raise _failed(plan, copy.path, error, mark, progress) from error
        mark.end(complete=True)
    return copy.path


def _look(plan: WritePlan) -> None:
    """Ask the PLC what it holds and does now, after a failure, as far as it answers."""
    with suppress(Exception, KeyboardInterrupt):  # the failure itself is what is said
        for part in plan.parts:
            part.look()


def _with(error: Exception | KeyboardInterrupt, unchanged: str) -> BaseException:
    """The same error, which says that the PLC is as it was."""
    if isinstance(error, KeyboardInterrupt):
        return KeyboardInterrupt("; ".join([*map(str, error.args), unchanged]))
    if isinstance(error, FatektoolError):
        error.message = f"{error.message}: {unchanged}"
    return error


def _failed(
    plan: WritePlan,
    path: Path | None,
    error: Exception | KeyboardInterrupt,
    mark: WriteMark,
    progress: Progress,
) -> FatektoolError:
    """The error for a write that failed on the way; it is rolled back first if that is planned."""
    cause = _cause(error)
    if plan.rollback and isinstance(error, Exception):
        try:
            for part in reversed(plan.parts):
                part.put_back(progress)
        except (Exception, KeyboardInterrupt) as second:  # noqa: BLE001  # it is said, whatever it is
            cause = f"{cause}; and rolling back failed: {_cause(second)}"
            _look(plan)
        else:
            mark.end(complete=False)
            return (LineError if isinstance(error, LineError) else PlcError)(
                f"{cause}; rolled back: the PLC holds {_before(plan)}, read back and verified",
                hint=getattr(error, "hint", None),
                rolled_back=True,
                **_saved(plan, path),
            )
    return _incomplete(plan, path, cause)


def _incomplete(plan: WritePlan, path: Path | None, cause: str) -> RestoreIncomplete:
    states = [state for part in plan.parts for state in part.states()]
    held = "; ".join(f"{what}: {holds}" for what, holds in states)
    saved = f"previous {plan.copy.what} {'not saved' if path is None else f'saved in {path}'}"
    mode = next((part.mode for part in plan.parts if part.mode), "")
    details = {key: value for part in plan.parts for key, value in part.details().items()}
    error = RestoreIncomplete(
        "; ".join(
            (f"{plan.failed} ({cause}): {held}", saved, *([f"the PLC's mode is {mode}"] if mode else []))
        ),
        hint="fix the cause and run the same command again: it writes what is left",
        cause=cause,
        **details,
        **_saved(plan, path),
    )
    error.headline, error.mode, error.states = plan.failed, mode, states
    error.saved = error.details[plan.copy.key]
    return error


def _before(plan: WritePlan) -> str:
    return " and ".join(part.before for part in plan.parts if part.before)


def _saved(plan: WritePlan, path: Path | None) -> dict[str, str | None]:
    return {plan.copy.key: None if path is None else str(path)}


def _cause(error: BaseException) -> str:
    if isinstance(error, FatektoolError):
        return error.message
    if isinstance(error, KeyboardInterrupt):
        return "interrupted"
    return f"a fault of fatektool itself: {type(error).__name__}: {error}"
