"""``loopback``: the quality of a line. Result and limits, errors by kind, times, sizes, and what to do."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any, Final

from fatektool.report.markup import DASH, Html, figure, percent, table, tag, when
from fatektool.report.page import Report, Verdict, chart, note, render, section
from fatektool.report.svg import Columns, columns

if TYPE_CHECKING:
    from collections.abc import Mapping, Sequence

_KINDS: Final = {
    "timeout": "no answer in time",
    "checksum": "answer with a wrong checksum",
    "garbled": "bytes without a valid frame",
    "mismatch": "answer with other data than sent",
    "stale": "late answer to an earlier request",
    "refused": "refused by the PLC",
}
_TIMES: Final = {
    "min": "least",
    "mean": "mean",
    "p50": "half of all, p50",
    "p90": "90 %, p90",
    "p99": "99 %, p99",
    "p999": "99.9 %, p99.9",
    "max": "most",
}
_MARKED: Final = ("p50", "p99")
_ENDS: Final = {
    "interrupted": " The test was interrupted: the numbers are those until then.",
    "line lost": " The line was lost: the numbers are those until then.",
}


def loopback_report(document: Mapping[str, Any]) -> str:
    """The report of a loopback test.

    Args:
        document: ``fatektool.loopback/1``.
    """
    station = document["station"]
    where = f"station {station} on {document['target']}" if station is not None else document["target"]
    sections = [
        *_diagnosis(document["diagnosis"]),
        section("Errors", _errors(document)),
        section("Time of an exchange", _times(document), *_histogram(document)),
        *_sizes(document["by_size"]),
    ]
    report = Report(
        "Line test",
        where,
        _verdict(document),
        _facts(document, where),
        sections,
        document["schema"],
        document["time"],
    )
    return render(report)


def _verdict(document: Mapping[str, Any]) -> Verdict:
    good = document["verdict"] == "pass"
    errors = document["sent"] - document["ok"]
    said = f"{document['ok']} of {document['sent']} loopbacks were answered correctly"
    said += f", {percent(document['error_rate'])} did not." if errors else "."
    limits = document["limits"]
    asked = []
    if limits["max_error_rate"] is not None:
        asked.append(f"error rate at most {percent(limits['max_error_rate'])}")
    if limits["max_p99_ms"] is not None:
        asked.append(f"p99 at most {limits['max_p99_ms']:g} ms")
    if asked:
        said += f" Limits: {', '.join(asked)}."
    said += _ENDS.get(document["ended"], "")
    return Verdict("Pass" if good else "Fail", said, good=good)


def _facts(document: Mapping[str, Any], where: str) -> list[tuple[str, object]]:
    use = document["line_use"]
    return [
        ("PLC", f"{where}, {document['protocol']}"),
        ("Line", document["line"] or DASH),
        ("Time", when(document["time"])),
        ("Duration", figure(document["duration_s"], unit="s")),
        ("Sent", figure(document["sent"])),
        ("Answered correctly", figure(document["ok"])),
        ("Error rate", figure(document["error_rate"], percent(document["error_rate"]))),
        (
            "Error rate, at most (95 %)",
            figure(document["error_rate_upper95"], percent(document["error_rate_upper95"])),
        ),
        ("Bytes sent", figure(document["bytes_sent"])),
        ("Bytes received", figure(document["bytes_received"])),
        ("Line in use", figure(use, percent(use))),
    ]


def _errors(document: Mapping[str, Any]) -> Html:
    rows = [
        (
            name,
            _KINDS.get(name, ""),
            figure(count),
            percent(count / document["sent"]) if document["sent"] else DASH,
        )
        for name, count in document["errors"].items()
    ]
    return table("Errors by kind", ("Kind", "What it is", "Count", "Of all"), rows, numeric=(2, 3))


def _times(document: Mapping[str, Any]) -> Html:
    exchange, turn = document["latency_ms"], document["turnaround_ms"]
    rows = [(said, figure(exchange.get(name)), figure(turn.get(name))) for name, said in _TIMES.items()]
    head = ("Loopbacks", "Whole exchange, ms", "The PLC's part, ms")
    return table(
        "From request to answer; the PLC's part is without time on the wire", head, rows, numeric=(1, 2)
    )


def _histogram(document: Mapping[str, Any]) -> list[Html]:
    buckets = document["histogram"]
    if not buckets:
        return [note("There was no answer: there are no times to show.")]
    marks = [
        (place, f"{name} {value:.4g} ms")
        for name in _MARKED
        if (value := document["latency_ms"].get(name)) is not None
        and (place := _place(buckets, value)) is not None
    ]
    data = Columns(
        [f"{bucket['from_ms']:.3g}" for bucket in buckets],
        [bucket["count"] for bucket in buckets],
        "whole exchange, ms: lower limit of each column",
        marks,
    )
    caption = "Loopbacks by time"
    said = "; ".join(text for _, text in marks)
    rows = [(figure(each["from_ms"]), figure(each["to_ms"]), figure(each["count"])) for each in buckets]
    figures = table(caption, ("From, ms", "To, ms", "Loopbacks"), rows, numeric=(0, 1, 2))
    return [chart(caption, columns("histogram", caption, said, data), figures)]


def _place(buckets: Sequence[Mapping[str, Any]], value: float) -> float | None:
    """The column of a time; None if it is in none of them."""
    for number, bucket in enumerate(buckets):
        if bucket["from_ms"] <= value <= bucket["to_ms"]:
            wide = bucket["to_ms"] - bucket["from_ms"]
            share: float = (value - bucket["from_ms"]) / wide if wide else 0.5
            return number + share
    return None


def _sizes(sizes: Sequence[Mapping[str, Any]]) -> list[Html]:
    if not sizes:
        return []
    head = ("Bytes", "Sent", "Right", "Error rate", "p50, ms", "p99, ms", "Most, ms", "Errors")
    rows = [
        (
            figure(each["size"]),
            figure(each["sent"]),
            figure(each["ok"]),
            figure(each["error_rate"], percent(each["error_rate"])),
            *(figure(each["latency_ms"].get(name)) for name in ("p50", "p99", "max")),
            _named(each["errors"]),
        )
        for each in sizes
    ]
    figures = table("By size of the data sent", head, rows, numeric=range(7))
    names = [str(each["size"]) for each in sizes]
    rates = Columns(names, [(each["error_rate"] or 0) * 100 for each in sizes], "bytes of data")
    slow = Columns(names, [each["latency_ms"].get("p99") or 0 for each in sizes], "bytes of data")
    charts = [
        _bars("rates", "Error rate by size, %", rates),
        _bars("slow", "p99 by size, ms", slow),
    ]
    return [section("By size", figures, tag("div", *charts, class_="charts"))]


def _bars(name: str, caption: str, data: Columns) -> Html:
    most = max(range(len(data.values)), key=lambda place: data.values[place])
    said = f"most at {data.names[most]} bytes: {data.values[most]:.3g}"
    rows = [(text, f"{value:.7g}") for text, value in zip(data.names, data.values, strict=True)]
    figures = table(caption, ("Bytes", caption), rows, numeric=(0, 1))
    return chart(caption, columns(name, caption, said, data), figures)


def _named(errors: Mapping[str, int]) -> str:
    return ", ".join(f"{count} {name}" for name, count in errors.items() if count) or DASH


def _diagnosis(found: Sequence[Mapping[str, Any]]) -> list[Html]:
    if not found:
        return []
    parts = []
    for each in found:
        parts += [
            tag("h3", f"{'Fault' if each['fault'] else 'Note'}: {each['finding']}"),
            tag("p", f"Measured: {each['evidence']}"),
            tag("p", tag("strong", "What to do: "), each["advice"]),
            tag("p", f"Rule {each['rule']}", class_="what"),
        ]
    return [section("Diagnosis", *parts)]
