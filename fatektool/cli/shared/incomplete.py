"""What did not complete, for a person: a headline, a line a fact, the command that goes on alone."""

from __future__ import annotations

from typing import TYPE_CHECKING

from fatektool.cli.shared.output import table
from fatektool.program.image import ranges

if TYPE_CHECKING:
    from collections.abc import Iterator

    from fatektool.errors import RestoreIncomplete

_STATES = {
    "pages_written": "the new program",
    "pages_unread": "written, not read back",
    "pages_uncertain": "uncertain",
    "pages_old": "the old program",
}
_LONGEST_NAME = 24


def restore_lines(error: RestoreIncomplete, plc: str, command: str) -> list[str]:
    """Of a restore.

    Args:
        error: what the job said.
        plc: station and target.
        command: what finishes it.
    """
    return _lines("the restore did not complete", list(_restore_facts(error, plc)), command)


def write_lines(error: RestoreIncomplete, headline: str, plc: str, command: str) -> list[str]:
    """Of a write of registers; ``headline`` says what was not written whole."""
    facts = [
        ("PLC", plc),
        ("cause", error.details["cause"]),
        ("values before", error.details["safety_snapshot"] or "not saved"),
    ]
    return _lines(headline, facts, command)


def _restore_facts(error: RestoreIncomplete, plc: str) -> Iterator[tuple[str, object]]:
    details = error.details
    yield "PLC", f"{plc}, in STOP; it must not RUN"
    yield "cause", details["cause"]
    unread = set(details["pages_unread"])
    states = {
        holds: [page for page in details[key] if key == "pages_unread" or page not in unread]
        for key, holds in _STATES.items()
    }
    told = [(f"page {ranges(pages)}", holds) for holds, pages in states.items() if pages]
    if any(len(pages) > _LONGEST_NAME for pages, _ in told):  # scattered pages would push all facts aside
        told = [(holds, pages) for pages, holds in told]
    yield from told
    yield "old program", details["safety_backup"] or "not saved"


def _lines(headline: str, facts: list[tuple[str, object]], command: str) -> list[str]:
    rows = table((name, " ".join(str(fact).split())) for name, fact in facts)
    return [headline, *(f"  {row}" for row in rows), "mend the cause, then go on with:", command]
