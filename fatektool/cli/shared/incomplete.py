"""What a person reads of a write that ended half way: a headline, a fact a line, the command to run."""

from __future__ import annotations

from typing import TYPE_CHECKING, Final

from fatektool.cli.shared.output import table

if TYPE_CHECKING:
    from collections.abc import Iterator

    from fatektool.errors import RestoreIncomplete

_LONGEST_NAME: Final = 24


def incomplete_lines(error: RestoreIncomplete, plc: str, copied: str, command: str) -> list[str]:
    """What is shown of it.

    Args:
        error: what the job said.
        plc: station and target.
        copied: what the safety copy is of: ``program``, ``values``.
        command: what finishes the write.
    """
    saved = f"saved in {error.saved}" if error.saved else "not saved"
    rows = [*_facts(error, plc), (f"previous {copied}", saved)]
    facts = table((name, " ".join(str(fact).split())) for name, fact in rows)
    return [error.headline, *(f"  {row}" for row in facts), "fix the cause, then run:", command]


def _facts(error: RestoreIncomplete, plc: str) -> Iterator[tuple[str, object]]:
    yield "PLC", plc
    if error.mode:
        yield "mode", error.mode
    yield "cause", error.details["cause"]
    long = any(len(place) > _LONGEST_NAME for place, _ in error.states)
    for place, holds in error.states:
        yield (holds, place) if long else (place, holds)  # scattered pages would push all facts aside
