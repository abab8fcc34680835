"""The words for what became of a PLC's turn, in its line and in the summary.

``ok`` is not among them: OK is a state of ``check`` and ``fleet check``, by the rules of the inventory.
"""

from __future__ import annotations

from typing import TYPE_CHECKING, Any, Final

from fatektool.cli import INTERRUPTED
from fatektool.cli.shared.colour import bad, joined, word
from fatektool.errors import (
    DataError,
    FatektoolError,
    LineError,
    PlcError,
    RestoreIncomplete,
    UsageError,
)

if TYPE_CHECKING:
    from collections.abc import Iterator

    from fatektool.cli.many.outcome import JobResult

_DONE: Final = {"verify": "same"}
_CLASSES: Final = {
    UsageError.exit_code: "not possible",
    LineError.exit_code: "no valid answer",
    PlcError.exit_code: "refused",
    DataError.exit_code: "invalid data",
    RestoreIncomplete.exit_code: "not complete",
    FatektoolError.exit_code: "a fault of fatektool",
}


def done_word(job: str) -> str:
    """The word for a job that was done, with exit code 0."""
    return _DONE.get(job, "done")


def state_of(job: str, exit_code: int) -> str:
    """The word for a PLC's state after a job."""
    if exit_code == INTERRUPTED:
        return "not done"
    return {0: done_word(job), 1: "differs"}.get(exit_code, "FAILED")


def line_of(job: str, name: str, result: JobResult) -> str:
    """State and words of one PLC: ``FAILED    no valid answer: /dev/ttyUSB0: no such port``."""
    reason = _CLASSES.get(result.exit_code)
    words = " ".join(result.words.split())
    state = state_of(job, result.exit_code)
    space = " " * max(0, 8 - len(state))
    text = _flags(words) if job == "status" and not result.exit_code else words
    return joined(f"{name}  ", word(state), f"{space}  {f'{reason}: ' if reason else ''}", text)


def _flags(words: str) -> str:
    """``RUN, battery LOW``: the mode, then faults."""
    mode, *faults = words.split(", ")
    return joined(word(mode), *(part for fault in faults for part in (", ", bad(fault))))


def not_done_words(document: dict[str, Any]) -> str:
    """The PLCs whose job an interrupt ended or left out, by name."""
    names = [each["name"] for each in document["plcs"] if each["exit_code"] == INTERRUPTED]
    return ", ".join(names) if names else "none"


def summary_words(job: str, document: dict[str, Any]) -> Iterator[str]:
    """The parts of the summary: ``backup: 2 of 3 done``, ``1 failed``, ``3 changed``, ``1.0 s``."""
    summary = document["summary"]
    differ = sum(each["exit_code"] == 1 for each in document["plcs"])
    yield f"{job}: {summary['ok']} of {summary['total']} {done_word(job)}"
    for count, noun in (
        (differ, "differs" if differ == 1 else "differ"),
        (summary["failed"] - differ, "failed"),
        (summary["changed"], "changed"),
        (summary["not_done"], "not done"),
    ):
        if count:
            yield f"{count} {noun}"
    yield f"{document['duration_s']:.1f} s"
    for each in document["slowest"][:1]:
        yield f"slowest {each['name']} {each['duration_s']:.1f} s"
