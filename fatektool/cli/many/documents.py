"""The JSON documents of ``fleet`` and ``check``."""

from __future__ import annotations

from dataclasses import dataclass
from typing import TYPE_CHECKING, Any, Final

from fatektool.cli import INTERRUPTED
from fatektool.files.times import utc

if TYPE_CHECKING:
    from collections.abc import Sequence
    from pathlib import Path

    from fatektool.cli.many.outcome import Outcome
    from fatektool.jobs.check.result import CheckResult, State

_SLOWEST: Final = 5


@dataclass(frozen=True, slots=True)
class FleetRun:
    """A job that was done with many PLCs.

    Attributes:
        job: as the command is called.
        time: when it was begun, UTC.
        duration_s: how long it took.
        inventory: the file that names the PLCs.
        outcomes: of all PLCs, in the inventory's order.
        interrupted: True if it was ended before all were done.
    """

    job: str
    time: str
    duration_s: float
    inventory: Path
    outcomes: Sequence[Outcome]
    interrupted: bool


def fleet_document(run: FleetRun) -> dict[str, Any]:
    """``fatektool.fleet/1``."""
    outcomes = run.outcomes
    not_done = sum(outcome.result.exit_code == INTERRUPTED for outcome in outcomes)
    ok = sum(outcome.result.exit_code == 0 for outcome in outcomes)
    slowest = sorted(outcomes, key=lambda outcome: outcome.duration_s, reverse=True)[:_SLOWEST]
    return {
        "schema": "fatektool.fleet/1",
        "time": run.time,
        "job": run.job,
        "inventory": str(run.inventory),
        "duration_s": round(run.duration_s, 3),
        "interrupted": run.interrupted,
        "summary": {
            "total": len(outcomes),
            "ok": ok,
            "failed": len(outcomes) - ok - not_done,
            "changed": sum(outcome.result.changed is True for outcome in outcomes),
            "not_done": not_done,
        },
        "slowest": [
            {"name": outcome.name, "duration_s": round(outcome.duration_s, 3)}
            for outcome in slowest
            if outcome.duration_s
        ],
        "plcs": [_plc(outcome) for outcome in outcomes],
    }


def _plc(outcome: Outcome) -> dict[str, Any]:
    result = outcome.result
    return {
        "name": outcome.name,
        "target": outcome.target,
        "station": outcome.station,
        "exit_code": result.exit_code,
        "duration_s": round(outcome.duration_s, 3),
        "changed": result.changed,
        "file": None if result.file is None else str(result.file),
        "words": result.words,
        "document": result.document,
    }


def check_document(
    state: State,
    words: str,
    found: CheckResult | None,
    *,
    name: str | None = None,
    target: str | None = None,
    station: int | None = None,
    protocol: str | None = None,
) -> dict[str, Any]:
    """``fatektool.check/1``; found and place are None where a check did not come to be."""
    return {
        "schema": "fatektool.check/1",
        "time": utc(),
        "name": name,
        "target": target,
        "station": station,
        "protocol": protocol,
        "state": state.name,
        "exit_code": int(state),
        "words": " ".join(words.split()),
        "facts": []
        if found is None
        else [{"state": fact.state.name, "words": fact.words} for fact in found.facts],
        "figures": {} if found is None else found.figures,
    }
