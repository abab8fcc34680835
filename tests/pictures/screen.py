"""What a command leaves on a terminal, as text and as SVG."""

from __future__ import annotations

import html
from typing import TYPE_CHECKING, Final

import pyte

if TYPE_CHECKING:
    from collections.abc import Iterable, Sequence

WIDTH: Final = 8.4
HEIGHT: Final = 18.0
MARGIN: Final = 16.0
COLOURS: Final = {
    "default": "#d7dae0", "black": "#5c6370", "red": "#ff7b72", "green": "#7ee787", "brown": "#e3b341",
    "blue": "#79c0ff", "magenta": "#d2a8ff", "cyan": "#76e3ea", "white": "#ffffff",
}  # fmt: skip

SVG: Final = """\
<svg xmlns="http://www.w3.org/2000/svg" viewBox="0 0 {width} {height}" width="{width}" height="{height}">
<title>{title}</title>
<rect width="100%" height="100%" rx="8" fill="#16181d"/>
<g font-family="ui-monospace, Consolas, Menlo, 'DejaVu Sans Mono', monospace" font-size="14">
{rows}
</g>
</svg>
"""


def screen_of(output: str, columns: int, lines: int) -> pyte.Screen:
    """The screen of a terminal after this output."""
    screen = pyte.Screen(columns, lines)
    pyte.Stream(screen).feed(output)
    return screen


def text_of(screen: pyte.Screen) -> list[str]:
    """Its lines, without what is blank at their ends and at its end."""
    found = [line.rstrip() for line in screen.display]
    while found and not found[-1]:
        found.pop()
    return found


def svg_of(rows: Sequence[tuple[str, Sequence[str]]], columns: int, title: str) -> str:
    """Lines of text, each with a colour for every character, as a picture."""
    drawn = "\n".join(
        f'<text y="{MARGIN + HEIGHT * (number + 0.8):.1f}">{_runs(text, colours)}</text>'
        for number, (text, colours) in enumerate(rows)
    )
    return SVG.format(
        width=round(2 * MARGIN + WIDTH * columns),
        height=round(2 * MARGIN + HEIGHT * len(rows)),
        title=html.escape(title),
        rows=drawn,
    )


def colours_of(screen: pyte.Screen, row: int) -> list[str]:
    """The colour of each character of a line, by its name in a terminal."""
    line = screen.buffer[row]
    return [
        "white" if line[at].bold and line[at].fg == "default" else line[at].fg for at in range(screen.columns)
    ]


def _runs(text: str, colours: Sequence[str]) -> str:
    return "".join(
        f'<tspan x="{MARGIN + WIDTH * at:.1f}" textLength="{WIDTH * len(piece):.1f}" '
        f'fill="{COLOURS.get(colour, "#" + colour)}">{_drawn(piece)}</tspan>'
        for at, piece, colour in _pieces(text, colours)
        if piece.strip()
    )


def _drawn(piece: str) -> str:
    """With spaces that no viewer takes for one."""
    return html.escape(piece).replace(" ", "\u00a0")


def _pieces(text: str, colours: Sequence[str]) -> Iterable[tuple[int, str, str]]:
    """Where each piece of one colour begins, the piece, the colour."""
    start = 0
    for at in range(1, len(text) + 1):
        if at == len(text) or colours[at] != colours[start]:
            yield start, text[start:at], colours[start]
            start = at
