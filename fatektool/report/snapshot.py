"""``snapshot``: the data of a PLC at one time, as a table."""

from __future__ import annotations

from itertools import islice
from typing import TYPE_CHECKING, Any, Final

from fatektool.counts import counted
from fatektool.report.markup import DASH, Html, figure, table, tag, when
from fatektool.report.page import Report, Verdict, note, render, section

if TYPE_CHECKING:
    from collections.abc import Mapping

MOST_ROWS: Final = 5000


def snapshot_report(document: Mapping[str, Any]) -> str:
    """One snapshot as a table.

    Args:
        document: ``fatektool.snapshot/1``.
    """
    errors = document["errors"]
    head = ("Key", "Element", "Type", "Value", "Unit", "Raw, hex", "Why missing")
    rows = [
        (
            key,
            part["element"],
            part["type"],
            figure(document["values"][key]),
            part.get("unit", ""),
            part["raw"] or DASH,
            tag("span", errors.get(key, ""), class_="text"),
        )
        for key, part in islice(document["elements"].items(), MOST_ROWS)
    ]
    count = len(document["values"])
    said = f"{counted(count - len(errors), 'value')} read in {counted(document['requests'], 'request')}."
    verdict = Verdict("Read", said)
    if errors:
        verdict = Verdict("Read in part", f"{said} {len(errors)} could not be read.", good=False)
    place = f"station {document['station']} on {document['target']}"
    facts: list[tuple[str, object]] = [
        ("PLC", f"{place}, {document['protocol']}"),
        ("Time", when(document["time"])),
        ("Mode", mode_of(document)),
        ("Duration", figure(document["duration_s"], unit="s")),
        ("Values", figure(count)),
        ("Not read", figure(len(errors))),
    ]
    parts = [bounded(count, "the first"), table("Values in the PLC", head, rows, numeric=(3, 5))]
    report = Report(
        "Snapshot", place, verdict, facts, [section("Values", *parts)], document["schema"], document["time"]
    )
    return render(report)


def bounded(count: int, which: str) -> Html | str:
    """A remark if there are more values than the table shows."""
    if count <= MOST_ROWS:
        return ""
    return note(f"{MOST_ROWS} values of {count} are shown, {which}; the JSON document (--json) has all.")


def mode_of(document: Mapping[str, Any] | None) -> str:
    """RUN or STOP in a document; a dash if it has none."""
    if document is None or document["running"] is None:
        return DASH
    return "RUN" if document["running"] else "STOP"
