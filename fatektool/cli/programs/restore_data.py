"""What a restore of data will do and did, in words and for JSON."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any, Final

from fatektool.counts import counted
from fatektool.jobs.elements.reads import named
from fatektool.jobs.elements.spans import spans_of
from fatektool.program.data.uses import Use
from fatektool.protocol.values import raw_text

if TYPE_CHECKING:
    from collections.abc import Iterator

    from fatektool.jobs.data.plan import DataPlan
    from fatektool.jobs.elements.planned import RegisterChange
    from fatektool.jobs.programs.restore import RestorePlan, RestoreResult

_LEFT: Final = {
    Use.INPUT: ("inputs", "they follow their terminals"),
    Use.OUTPUT: ("outputs", "the program sets them in RUN"),
    Use.CLOCK: ("clock", "set it by hand"),
    Use.STATUS: ("commands and states of the PLC", "the PLC sets them"),
    Use.SETTING: ("settings", "--system writes them"),
}


def data_plan_lines(plan: DataPlan) -> Iterator[str]:
    """What will be written, and what differs and will not be."""
    if plan.values:
        spans = spans_of(change.element for change in plan.values)
        yield f"The PLC's data differ in {counted(len(plan.values), 'value')}: {named(spans)}."
    if plan.enable:
        yield f"Will be enabled: {', '.join(map(str, plan.enable))}."
    if plan.hold:
        states = (f"{element} {'on' if on else 'off'}" for element, on in plan.hold.items())
        yield f"Will be disabled and held: {', '.join(states)}."
    for change in plan.settings:
        yield f"Setting {_change(change)}"
    if plan.wanted.running:
        yield "The data of FILE were read in RUN: its values are not all of one moment."
    if not plan.changes:
        yield "The PLC's data are those of FILE already, as far as they are written."
    for use, elements in plan.left.items():
        what, why = _LEFT[use]
        yield f"Not written, {what}: {named(spans_of(elements))} ({why})."
    if plan.moving:
        yield f"Not written, settings that changed while they were read: {named(spans_of(plan.moving))}."
    if plan.missing:
        yield f"Not written, without a value in this PLC: {named(spans_of(plan.missing))}."


def data_warnings(plan: DataPlan) -> Iterator[str]:
    """What may move something as soon as it is written."""
    outputs = [str(element) for element, on in plan.hold.items() if on and element.symbol == "Y"]
    if outputs:
        yield (
            f"{', '.join(outputs)} will be disabled and held on, as in FILE: "
            "the output may switch on at once, in STOP too"
        )


def data_rows(plan: RestorePlan, result: RestoreResult) -> Iterator[tuple[str, object]]:
    """What was written, as rows of name and value."""
    data = plan.data
    if data is None:
        return
    taken = data.changes - len(result.not_taken)
    yield (
        "data",
        f"{taken} of {data.changes} changes made and read back, {data.equal} values were equal already",
    )
    if data.wanted.disabled:
        yield "disabled", ", ".join(data.wanted.disabled)


def _change(change: RegisterChange) -> str:
    bits = change.element.kind.bits
    return f"{change.element}: {raw_text(change.before, bits)} -> {raw_text(change.after, bits)}"


def data_document(plan: RestorePlan, result: RestoreResult) -> dict[str, Any] | None:
    """The part ``data`` of ``fatektool.restore/1``; None if the program alone is restored."""
    data = plan.data
    if data is None:
        return None
    settings = {
        str(change.element): {
            "before": raw_text(change.before, change.element.kind.bits),
            "after": raw_text(change.after, change.element.kind.bits),
        }
        for change in data.settings
    }
    return {
        "sha256": data.wanted.sha256,
        "values_to_write": len(data.values),
        "values_equal": data.equal,
        "enable": [str(element) for element in data.enable],
        "disable": {str(element): on for element, on in data.hold.items()},
        "settings": settings,
        "not_written": {use.name.lower(): spans_of(elements) for use, elements in data.left.items()},
        "moving_settings": spans_of(data.moving),
        "missing": spans_of(data.missing),
        "not_taken": dict(result.not_taken),
    }
