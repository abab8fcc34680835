"""``watch`` and ``snapshot``: the data of a PLC over time.

Numbers are shown as lines, discretes as a timing diagram, texts as a table of their changes; the overview
includes all rounds. Missing values are gaps: crosses in the chart, and rows in a table.
"""

from __future__ import annotations

from dataclasses import dataclass
from typing import TYPE_CHECKING, Any, Final

from fatektool.counts import counted
from fatektool.report.markup import DASH, Html, figure, plain, table, tag, when
from fatektool.report.page import Report, Verdict, chart, note, render, section
from fatektool.report.rounds import MOST_GAPS, KeptRound, Rounds, Track, is_number
from fatektool.report.scale import stamp
from fatektool.report.snapshot import MOST_ROWS, bounded, mode_of
from fatektool.report.svg import line, timing

if TYPE_CHECKING:
    from collections.abc import Callable, Iterable, Mapping, Sequence

    from fatektool.report.svg import Point

MOST_CHARTS: Final = 60
MOST_DISCRETES: Final = 96
_MOST_FIGURES: Final = 100
_MOST_CHANGES: Final = 200
_IN_ONE_DIAGRAM: Final = 16


@dataclass(frozen=True, slots=True)
class SeriesSource:
    """The PLC of a series.

    Attributes:
        target: as the user wrote it.
        station: 1 to 254.
        protocol: ``facon``.
        schema: of the documents.
        time: of the report, if nothing was read, UTC, RFC 3339.
    """

    target: str
    station: int
    protocol: str
    schema: str
    time: str


def series_report(
    rounds: Rounds, place: SeriesSource, *, ended: str | None = None, left_out: str = ""
) -> str:
    """A series of rounds.

    Args:
        rounds: the series.
        place: the PLC.
        ended: why it ended early; None if it did not.
        left_out: what is missing in it, as a sentence.
    """
    kept = rounds.kept()
    keys = _chosen(rounds.tracks)
    figures = {key: _points(key, kept, is_number) for key in keys}
    discretes = {key: _points(key, kept, lambda value: isinstance(value, bool)) for key in keys}
    sections = [
        section(
            "Overview",
            *_remarks(rounds, left_out),
            bounded(len(rounds.tracks), "values that changed first"),
            _overview(rounds, keys),
        ),
        *_numbers(rounds, {key: points for key, points in figures.items() if points}),
        *_discretes({key: points for key, points in discretes.items() if points}),
        *_texts(keys, kept),
        *_gaps(rounds),
    ]
    where = f"station {place.station} on {place.target}"
    facts: list[tuple[str, object]] = [
        ("PLC", f"{where}, {place.protocol}"),
        ("First round", when(rounds.first_time)),
        ("Last round", when(rounds.last_time)),
        ("Rounds read", figure(rounds.count)),
        ("Rounds lost", figure(rounds.lost)),
        ("Mode at the end", mode_of(rounds.last)),
        ("Changes of mode", figure(rounds.mode_changes)),
    ]
    report = Report(
        "Values over time",
        where,
        _verdict(rounds, ended),
        facts,
        sections,
        place.schema,
        rounds.last_time or place.time,
    )
    return render(report)


def _verdict(rounds: Rounds, ended: str | None) -> Verdict:
    failed = sum(1 for track in rounds.tracks.values() if track.failed)
    said = f"{counted(rounds.count, 'round')} of {counted(len(rounds.tracks), 'value')}"
    said += f", {rounds.lost} more lost" if rounds.lost else ""
    said += f", {failed} of the values with gaps." if failed else "."
    if ended:
        said += f" Ended: {ended}."
    if not rounds.count:
        return Verdict("Nothing read", said, good=False)
    gaps = bool(rounds.lost or failed)
    return Verdict("Read with gaps" if gaps else "Read", said, good=False if gaps else None)


def _remarks(rounds: Rounds, left_out: str) -> list[Html]:
    found = [note(left_out)] if left_out else []
    if rounds.stride > 1:
        found.append(
            note(
                f"This table includes all rounds. The charts show one of {rounds.stride} rounds and the "
                f"last, so short peaks or gaps may be missing in them."
            )
        )
    return found


def _chosen(tracks: Mapping[str, Track]) -> list[str]:
    """The keys that are shown, in their order: if there are too many, first those that changed."""
    ranked = sorted(enumerate(tracks), key=lambda each: (not tracks[each[1]].changes, each[0]))
    return [key for _, key in sorted(ranked[:MOST_ROWS])]


def _overview(rounds: Rounds, keys: Sequence[str]) -> Html:
    head = ("Key", "Element", "Unit", "Last", "Least", "Mean", "Most", "Changes", "Read", "Gaps")
    rows = []
    for key in keys:
        track = rounds.tracks[key]
        rows.append(
            (
                key,
                track.part.get("element", DASH),
                track.part.get("unit", ""),
                figure(track.last),
                figure(track.least),
                figure(track.mean, None if track.mean is None else f"{track.mean:.5g}"),
                figure(track.most),
                figure(track.changes),
                figure(track.read),
                figure(track.failed),
            )
        )
    return table("All values, all rounds", head, rows, numeric=range(3, 10))


def _points(key: str, kept: Iterable[KeptRound], fits: Callable[[Any], bool]) -> list[Point]:
    """A key's values over time; None for a missing one; empty if none fits."""
    found: list[tuple[float, Any]] = [(each.time_s, each.values.get(key)) for each in kept]
    points: list[Point] = [(time_s, float(value) if fits(value) else None) for time_s, value in found]
    return points if any(value is not None for _, value in points) else []


def _numbers(rounds: Rounds, figures: Mapping[str, list[Point]]) -> list[Html]:
    if not figures:
        return []
    ranked = sorted(figures, key=lambda key: not rounds.tracks[key].changes)
    shown = set(ranked[:MOST_CHARTS])
    charts = []
    for number, (key, points) in enumerate(each for each in figures.items() if each[0] in shown):
        track = rounds.tracks[key]
        unit = track.part.get("unit", "")
        caption = f"{key}, {unit}" if unit else key
        said = f"from {plain(track.least)} to {plain(track.most)}, {plain(track.last)} at the end"
        drawn = line(f"line-{number}", caption, said, points)
        charts.append(chart(caption, drawn, _figures(caption, points)))
    left = len(figures) - len(shown)
    remark = [note(f"{left} more have no chart: values that changed come first.")] if left else []
    return [section("Numbers", *remark, tag("div", *charts, class_="charts"))]


def _figures(caption: str, points: Sequence[Point]) -> Html:
    every = -(-len(points) // _MOST_FIGURES)
    rows = [
        (stamp(time_s), figure(value))
        for number, (time_s, value) in enumerate(points)
        if number % every == 0 or number == len(points) - 1
    ]
    said = caption if every == 1 else f"{caption}: one of {every} points, and the last"
    return table(said, ("Time, UTC", "Value"), rows, numeric=(1,))


def _discretes(figures: Mapping[str, list[Point]]) -> list[Html]:
    if not figures:
        return []
    keys = list(figures)[:MOST_DISCRETES]
    charts = []
    for number, start in enumerate(range(0, len(keys), _IN_ONE_DIAGRAM)):
        rows = [(key, figures[key]) for key in keys[start : start + _IN_ONE_DIAGRAM]]
        caption = rows[0][0] if len(rows) == 1 else f"{rows[0][0]} to {rows[-1][0]}"
        drawn = timing(f"timing-{number}", caption, f"{counted(len(rows), 'discrete')}; high is on", rows)
        charts.append(chart(caption, drawn, _changes(caption, rows)))
    left = len(figures) - len(keys)
    remark = [note(f"{left} more have no diagram.")] if left else []
    return [section("Discretes", *remark, tag("div", *charts, class_="charts"))]


def _changes(caption: str, rows: Sequence[tuple[str, Sequence[Point]]]) -> Html:
    """The time and new value of each change, after the first value."""
    found = []
    for key, points in rows:
        before: float | None = None
        for time_s, value in points:
            if value is not None and value != before:
                found.append((time_s, key, bool(value)))
                before = value
    found.sort(key=lambda each: each[0])
    return _changes_table(caption, found)


def _texts(keys: Iterable[str], kept: Sequence[KeptRound]) -> list[Html]:
    found = []
    for key in keys:
        before = None
        for each in kept:
            value = each.values.get(key)
            if isinstance(value, str) and value != before:
                found.append((each.time_s, key, value))
                before = value
    found.sort(key=lambda each: each[0])
    return [section("Texts", _changes_table("Hex values", found))] if found else []


def _changes_table(caption: str, found: Sequence[tuple[float, str, object]]) -> Html:
    rows = [(stamp(time_s), key, figure(value)) for time_s, key, value in found[:_MOST_CHANGES]]
    left = len(found) - len(rows)
    said = f"{caption}: first values, then changes" + (f"; {left} more are left out" if left else "")
    return table(said, ("Time, UTC", "Key", "Value"), rows)


def _gaps(rounds: Rounds) -> list[Html]:
    if not rounds.gaps:
        return []
    head = ("First", "Last", "Key", "Rounds", "Why")
    rows = [
        (
            when(gap.first),
            when(gap.last),
            gap.key or "all",
            figure(gap.rounds),
            tag("span", gap.reason, class_="text"),
        )
        for gap in rounds.gaps
    ]
    left = rounds.gaps_in_all - len(rounds.gaps)
    remark = [note(f"The first {MOST_GAPS} are shown, {left} more are left out.")] if left else []
    return [section("Gaps", *remark, table("Missing values", head, rows, numeric=(3,)))]
