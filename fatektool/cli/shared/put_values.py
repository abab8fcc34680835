"""What the commands that write values have in common."""

from __future__ import annotations

from functools import partial
from typing import TYPE_CHECKING

from fatektool.cli.shared.addressee import ExchangeTime, with_status
from fatektool.cli.shared.write_back import Offer, WriteCommand
from fatektool.counts import counted
from fatektool.jobs.snapshots.write_values import SafetySnapshot, ValuesPlan, Written, write_values
from fatektool.protocol.values import raw_text

if TYPE_CHECKING:
    from collections.abc import Iterable, Iterator
    from pathlib import Path

    from fatektool.client import Plc
    from fatektool.jobs.elements.planned import RegisterChange
    from fatektool.protocol.elements import Element


def offer_of(
    plc: Plc,
    plan: ValuesPlan,
    writing: WriteCommand,
    pace: ExchangeTime,
    *,
    rows: Iterable[tuple[str, object]],
    lines: Iterable[str],
) -> Offer:
    """A write of values as it is shown.

    Args:
        plc: the PLC.
        plan: of this PLC, just now.
        writing: the command.
        pace: of the exchanges that the plan took.
        rows: what is written and where that came from.
        lines: what will change.
    """
    here = with_status(plc, plan.status)
    count = len(plan.changes)
    time = [("time", pace.time_of(plan.exchanges(plc)))] if count else []
    question = f"Write {counted(count, 'value')} into {here.name}?"
    return Offer(writing, here, [*rows, *time], [*lines], question, "values")


def put_values(plc: Plc, plan: ValuesPlan, offer: Offer, pace: ExchangeTime, name: str) -> Written:
    """Save, ask, write and read back, unless nothing differs or it is a dry run.

    Args:
        plc: the PLC.
        plan: of this PLC, just now.
        offer: shows it and asks.
        pace: counts the time, but for that of the question.
        name: what the safety snapshot's name begins with.

    Raises:
        UsageError: the user does not agree.
        RestoreIncomplete: some values are written.
        FatektoolError: as ``write_back`` says; nothing was changed.
    """
    writing = offer.writing
    done = Written(None, [])
    if writing.terms.dry_run:
        return done
    if plan.changes:
        copy = SafetySnapshot(plan, name, writing.folder, writing.earlier_copy)

        def agree(saved: Path | None) -> None:
            with pace.stopped():
                offer.agree(saved)

        with offer.carry_out() as mark:
            done = write_values(plc, plan, copy, agree, rollback=writing.terms.rollback, mark=mark)
    else:
        writing.forget()
    return done


def result_lines(
    plan: ValuesPlan, done: Written, offer: Offer, pace: ExchangeTime, *details: str
) -> Iterator[str]:
    """The result in words.

    Args:
        plan: what was to be written.
        done: what came of it.
        offer: what was shown.
        pace: of all exchanges.
        details: what a dry run shows more.
    """
    count = len(plan.changes)
    if not count:
        yield "same: nothing was written"
    elif offer.writing.terms.dry_run:
        yield from offer.dry_run(*details)
    else:
        taken = count - len(done.not_taken)
        yield f"{taken} of {counted(count, 'value')} written and read back, {plan.same} were equal already"
        yield offer.here.line
        yield f"took {pace.passed}"


def change_line(change: RegisterChange) -> str:
    """The value of an element, and its new value."""
    element = change.element
    return f"{element}  {_text(element, change.before)} -> {_text(element, change.after)}"


def not_taken_words(done: Written) -> dict[str, str]:
    """Values that the PLC did not keep, in words, by element."""
    return {str(each.element): each.words(partial(_text, each.element)) for each in done.not_taken}


def _text(element: Element, raw: int) -> str:
    return raw_text(raw, element.kind.bits)
