"""Charts as inline SVG: columns, a line over time, a timing diagram of discretes.

For a screen reader, every chart is one image with a title and a description; its numbers are in a table.
Colours come from the style sheet, so a chart is readable on a dark screen and on paper.

A chart is ``WIDTH`` wide and scales with the window::

    left | plot                     | right
         |                          |
    -----+--------------------------+ bottom: labels, then the name of the axis
"""

from __future__ import annotations

from dataclasses import dataclass
from itertools import groupby, pairwise
from typing import TYPE_CHECKING, Final

from fatektool.report.markup import NEWLINE, Html, join, tag
from fatektool.report.scale import Scale, ends, labels, stamp, ticks, time_ticks

if TYPE_CHECKING:
    from collections.abc import Iterator, Sequence

WIDTH: Final = 520
_LEFT: Final = 62
_RIGHT: Final = WIDTH - 12
_TOP: Final = 22
_PLOT: Final = 150
_BOTTOM: Final = _TOP + _PLOT
_HEIGHT: Final = _BOTTOM + 42
_ROW: Final = 26
_LINE: Final = 14
_MARKS: Final = 20
_NAMES: Final = 120
_MOST_DOTS: Final = 40
_MOST_LABELS: Final = 9
_MOST_COUNTS: Final = 16
_LONGEST_NAME: Final = 17

Point = tuple[float, float | None]
"""Seconds since 1970, and a value; None for a gap."""


@dataclass(frozen=True, slots=True)
class Columns:
    """A column chart.

    Attributes:
        names: under the columns.
        values: their heights, from 0.
        axis: the meaning of the names, with unit.
        marks: vertical lines: the place in columns (2.5 is the middle of the third), and a text.
    """

    names: Sequence[str]
    values: Sequence[float]
    axis: str
    marks: Sequence[tuple[float, str]] = ()


def canvas(name: str, title: str, said: str, height: float, content: Html) -> Html:
    """An image with a title and a description.

    Args:
        name: its id.
        title: of the chart.
        said: a description.
        height: in units of the image, which is ``WIDTH`` wide.
        content: the drawing.
    """
    return tag(
        "svg",
        tag("title", title, id=f"{name}-title"),
        tag("desc", said, id=f"{name}-desc"),
        content,
        id=name,
        role="img",
        aria_labelledby=f"{name}-title {name}-desc",
        viewBox=f"0 0 {WIDTH} {height:g}",
    )


def label(x: float, y: float, text: object, *, anchor: str = "start", strong: bool = False) -> Html:
    """A text; ``anchor`` is the part of it at x: start, middle, end."""
    return tag(
        "text", text, x=_short(x), y=_short(y), text_anchor=anchor, class_="strong" if strong else None
    )


def columns(name: str, title: str, said: str, data: Columns) -> Html:
    """Columns from zero; one that is not zero is always visible."""
    low, high = ends([*data.values, 0.0], zero=True)
    roof = _TOP + (_MARKS if data.marks else 0)
    up = Scale(low, high, _BOTTOM, roof)
    count = len(data.names)
    pitch = (_RIGHT - _LEFT) / max(1, count)
    wide = max(1.0, min(pitch - 2, 60.0))
    drawn = list(_levels(up))
    every = -(-count // _MOST_LABELS)
    for number, (text, value) in enumerate(zip(data.names, data.values, strict=True)):
        middle = _LEFT + (number + 0.5) * pitch
        top = _BOTTOM if not value else min(up.at(value), _BOTTOM - 2)
        drawn.append(
            tag(
                "rect",
                tag("title", f"{text}: {value:g}"),
                x=_short(middle - wide / 2),
                y=_short(top),
                width=_short(wide),
                height=_short(_BOTTOM - top),
                class_="bar",
            )
        )
        if count <= _MOST_COUNTS and value:
            drawn.append(
                label(
                    middle,
                    top - 4,
                    f"{value:.3g}" if value < 1000 else f"{value:.0f}",
                    anchor="middle",
                    strong=True,
                )
            )
        if number % every == 0:
            drawn.append(label(middle, _BOTTOM + 15, text, anchor="middle"))
    for row, (place, text) in enumerate(data.marks):
        x = _LEFT + place * pitch
        drawn.append(tag("path", d=f"M{_short(x)} {4 + _LINE * row}V{_BOTTOM}", class_="limit"))
        at_end = x > _RIGHT - 100
        beside = x - 4 if at_end else x + 4
        drawn.append(label(beside, _LINE * (row + 1), text, anchor="end" if at_end else "start"))
    drawn.append(label((_LEFT + _RIGHT) / 2, _BOTTOM + 34, data.axis, anchor="middle"))
    return canvas(name, title, said, _HEIGHT, join(drawn, NEWLINE))


def line(name: str, title: str, said: str, points: Sequence[Point]) -> Html:
    """A line over time, with a gap where there is no value; crosses mark the gap.

    Args:
        name: the chart's id.
        title: of the chart.
        said: a description.
        points: in the order of their times, at least one.
    """
    across = _times(points, _LEFT, _RIGHT)
    up = Scale(*ends([value for _, value in points if value is not None] or [0.0]), _BOTTOM, _TOP)
    drawn = [*_levels(up), *_clock(across, _BOTTOM)]
    drawn.append(tag("path", d=_path(points, across, up), class_="series"))
    if len(points) <= _MOST_DOTS:
        dots = "".join(f"M{_short(across.at(x))} {_short(up.at(y))}h0" for x, y in points if y is not None)
        drawn.append(tag("path", d=dots, class_="dots"))
    gaps = "".join(_gap(x, _BOTTOM) for x in _gap_places(points, across))
    if gaps:
        drawn.append(tag("path", d=gaps, class_="gap"))
    return canvas(name, title, said, _HEIGHT, join(drawn, NEWLINE))


def timing(name: str, title: str, said: str, rows: Sequence[tuple[str, Sequence[Point]]]) -> Html:
    """Discretes over time, one row each: high and filled is on.

    Args:
        name: the chart's id.
        title: of the chart.
        said: a description.
        rows: names and points of 0 and 1, in the order of their times.
    """
    across = _times([point for _, points in rows for point in points], _NAMES, _RIGHT)
    bottom = 6 + _ROW * len(rows)
    drawn = list(_clock(across, bottom))
    for number, (text, points) in enumerate(rows):
        base = 6 + _ROW * (number + 1) - 4
        up = Scale(0.0, 1.0, base, base - _ROW + 10)
        short = text if len(text) <= _LONGEST_NAME else f"{text[: _LONGEST_NAME - 1]}…"
        drawn.append(label(_NAMES - 8, base - 3, short, anchor="end", strong=True))
        drawn.append(tag("path", d=f"M{_NAMES} {base}H{_RIGHT}", class_="grid"))
        on = _blocks(points, across)
        filled = "".join(f"M{_short(x)} {base}V{_short(up.at(1))}H{_short(end)}V{base}z" for x, end in on)
        drawn.append(tag("path", d=filled, class_="under"))
        drawn.append(tag("path", d=_steps(points, across, up), class_="series"))
        gaps = "".join(_gap(x, base) for x in _gap_places(points, across))
        if gaps:
            drawn.append(tag("path", d=gaps, class_="gap"))
    return canvas(name, title, said, bottom + 42, join(drawn, NEWLINE))


def _levels(up: Scale) -> Iterator[Html]:
    """The lines of the round values, and the values."""
    values = ticks(up.low, up.high)
    for value, text in zip(values, labels(values), strict=True):
        y = _short(up.at(value))
        yield tag("path", d=f"M{_LEFT} {y}H{_RIGHT}", class_="grid")
        yield label(_LEFT - 6, up.at(value) + 4, text, anchor="end")
    yield tag("path", d=f"M{_LEFT} {_short(up.end)}V{_BOTTOM}H{_RIGHT}", class_="axis")


def _clock(across: Scale, bottom: float) -> Iterator[Html]:
    """The time axis: round times, then the whole span."""
    yield tag("path", d=f"M{_short(across.start)} {bottom}H{_short(across.end)}", class_="axis")
    for seconds, text in time_ticks(across.low, across.high):
        x = across.at(seconds)
        yield tag("path", d=f"M{_short(x)} {bottom}v4", class_="axis")
        yield label(x, bottom + 17, text, anchor="end" if x > WIDTH - 30 else "middle")
    span = f"{stamp(across.low)} to {stamp(across.high)} UTC"
    yield label((across.start + across.end) / 2, bottom + 35, span, anchor="middle")


def _times(points: Sequence[Point], start: float, end: float) -> Scale:
    times = [time_s for time_s, _ in points]
    return Scale(min(times), max(*times, min(times) + 1), start, end)


def _runs(points: Sequence[Point]) -> Iterator[list[tuple[float, float]]]:
    """The points between gaps."""
    for there, run in groupby(points, lambda point: point[1] is not None):
        if there:
            yield [(x, y) for x, y in run if y is not None]


def _path(points: Sequence[Point], across: Scale, up: Scale) -> str:
    """A line from point to point; a single point is a dot: the round end of a line without length."""
    found = []
    for run in _runs(points):
        places = [f"{_short(across.at(x))} {_short(up.at(y))}" for x, y in run]
        found.append("M" + "L".join(places) + ("h0" if len(run) == 1 else ""))
    return "".join(found)


def _steps(points: Sequence[Point], across: Scale, up: Scale) -> str:
    """Horizontal to the next point, then up or down."""
    found = []
    for run in _runs(points):
        found.append(f"M{_short(across.at(run[0][0]))} {_short(up.at(run[0][1]))}h0")
        for (_, before), (x, y) in pairwise(run):
            if y != before:
                found.append(f"H{_short(across.at(x))}V{_short(up.at(y))}")
        found.append(f"H{_short(across.at(run[-1][0]))}")
    return "".join(found)


def _blocks(points: Sequence[Point], across: Scale) -> Iterator[tuple[float, float]]:
    """The spans in which it is on."""
    for run in _runs(points):
        begin: float | None = None
        for x, y in run:
            if y and begin is None:
                begin = x
            elif not y and begin is not None:
                yield across.at(begin), across.at(x)
                begin = None
        if begin is not None:
            yield across.at(begin), across.at(run[-1][0])


def _gap_places(points: Sequence[Point], across: Scale) -> Iterator[float]:
    """The places of crosses for missing values, far enough apart that they do not touch."""
    last = None
    for time_s, value in points:
        x = across.at(time_s)
        if value is None and (last is None or x - last >= 8):
            last = x
            yield x


def _gap(x: float, base: float) -> str:
    return f"M{_short(x - 3)} {base - 7}l6 6m0 -6l-6 6"


def _short(place: float) -> str:
    return f"{place:.1f}".removesuffix(".0")
