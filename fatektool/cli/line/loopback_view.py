"""The output of ``loopback``: counters while it runs, then figures, a histogram and the diagnosis."""

from __future__ import annotations

import shutil
import time
from typing import TYPE_CHECKING, Any, Final

from fatektool.cli.shared.bars import bar
from fatektool.cli.shared.colour import joined, word
from fatektool.cli.shared.output import shows_progress, table

if TYPE_CHECKING:
    from collections.abc import Iterable, Iterator
    from types import TracebackType
    from typing import Self

    from fatektool.cli.shared.output import Voice
    from fatektool.jobs.linetest.loopback.result import LoopbackResult

_EVERY_S: Final = 0.1
_WIDEST_BAR: Final = 50


class LiveFigures:
    """Counters on a terminal; nothing elsewhere. For a ``with`` statement."""

    def __init__(self, voice: Voice) -> None:
        self._shown = shows_progress(voice)
        self._due = 0.0

    def __enter__(self) -> Self:
        if self._shown:
            from rich.live import Live

            from fatektool.cli.shared.colour import stderr_console

            self._live = Live(
                console=stderr_console(), auto_refresh=False, transient=True, redirect_stdout=False
            )
            self._live.start()
        return self

    def __exit__(
        self, kind: type[BaseException] | None, error: BaseException | None, trace: TracebackType | None
    ) -> None:
        if self._shown:
            self._live.stop()

    def update(self, result: LoopbackResult) -> None:
        """Show the figures so far, ten times a second at most."""
        if not self._shown or time.perf_counter() < self._due:
            return
        from rich.text import Text

        self._due = time.perf_counter() + _EVERY_S
        total, plan = result.total, result.plan
        of = f" of {plan.count}" if plan.count is not None else ""
        until = f" of {plan.duration_s:g}" if plan.duration_s is not None else ""
        text = Text(f"{total.sent}{of} sent, {total.ok} ok, ")
        text.append(f"{total.failed} errors", "bold red" if total.failed else "")
        if total.latency.count:
            text.append(f", mean {total.latency.sum_s / total.latency.count * 1000:.1f} ms")
        text.append(f", {result.duration_s:.0f}{until} s")
        text.no_wrap, text.overflow = True, "ellipsis"
        self._live.update(text, refresh=True)


def lines(document: dict[str, Any]) -> Iterator[str]:
    """The document of a test as lines."""
    yield from table(_figures(document))
    yield ""
    yield from _sizes(document["by_size"])
    if document["histogram"]:
        yield ""
        yield "latency, ms"
        yield from _histogram(document["histogram"])
    yield ""
    yield from findings(document["diagnosis"])
    verdict = "; ".join(document["limits_passed"])
    yield joined(word(document["verdict"]), f": {verdict}" if verdict else "")


def _figures(document: dict[str, Any]) -> Iterator[tuple[str, object]]:
    errors = ", ".join(f"{count} {kind}" for kind, count in document["errors"].items() if count)
    line = f" ({document['line']})" if document["line"] else ""
    if document["raw"] is None:
        yield "PLC", f"station {document['station']} on {document['target']}{line}"
    else:
        start, end = (code or "none" for code in document["raw"].values())
        yield "line", f"{document['target']}{line}"
        yield "frame", f"start {start}, end {end}"
    yield "exchanges", f"{document['sent']} sent, {document['ok']} ok in {document['duration_s']:.1f} s"
    yield "errors", errors or "none"
    rate, most = document["error_rate"], document["error_rate_upper95"]
    yield "error rate", f"{rate:.3g}, at most {most:.3g} (95 % confidence)"
    for name, key in (("latency", "latency_ms"), ("turnaround", "turnaround_ms")):
        times = document[key]
        if times["p50"] is not None:
            figures = ", ".join(f"{part} {times[part]:.1f}" for part in ("min", "p50", "p99", "max"))
            yield name, f"{figures} ms"
    if document["line_use"] is not None:
        yield "line use", f"{document['line_use']:.1%}"
    yield "bytes", f"{document['bytes_sent']} sent, {document['bytes_received']} received"
    if document["ended"] not in {"count", "duration"}:
        yield "ended", f"{document['ended']}: figures so far"


def _sizes(by_size: Iterable[dict[str, Any]]) -> Iterator[str]:
    yield "size    sent  errors   rate   p50 ms   max ms"
    for row in by_size:
        times = row["latency_ms"]
        p50, most = ("-" if times[part] is None else f"{times[part]:.1f}" for part in ("p50", "max"))
        failed = row["sent"] - row["ok"]
        rate = f"{row['error_rate']:.1%}"
        yield f"{row['size']:>4}  {row['sent']:>6}  {failed:>6}  {rate:>5}  {p50:>7}  {most:>7}"


def _histogram(bars: list[dict[str, Any]]) -> Iterator[str]:
    """Bars that fit the terminal, in eighths of a character."""
    highest = max(part["count"] for part in bars)
    columns = min(_WIDEST_BAR, max(10, shutil.get_terminal_size().columns - 30))
    for before, part in zip([None, *bars], bars, strict=False):
        if not part["count"]:  # of a gap, one line
            if before is None or before["count"]:
                yield f"{'…':>17}"
            continue
        eighths = -(-part["count"] * columns * 8 // highest)
        drawn = bar(eighths)
        yield f"{part['from_ms']:>8.2f}-{part['to_ms']:<8.2f} {part['count']:>7} {drawn}".rstrip()


_FOUND: Final = "answers-elsewhere"


def findings(found: Iterable[dict[str, Any]]) -> Iterator[str]:
    """A diagnosis as lines: where the PLC was found, the faults, notes."""
    for finding in sorted(found, key=lambda finding: (finding["rule"] != _FOUND, not finding["fault"])):
        mark = "FOUND" if finding["rule"] == _FOUND else "FAULT" if finding["fault"] else "note"
        yield joined(word(mark), f": {finding['finding']}")
        yield f"  seen: {finding['evidence']}"
        yield f"  do:   {finding['advice']}"
