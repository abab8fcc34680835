"""Colour: which words have it, and the only place that decides where it is shown.

``NO_COLOR`` turns colour off and ``FORCE_COLOR`` turns it on, whatever the output is; ``NO_COLOR`` wins. Else
a terminal has colour, unless ``TERM`` is ``dumb``. A pipe and a file have none.

A coloured text is a ``str`` that also has the styles of its parts. Without colour it is the same text, so no
information is in the colour alone.
"""

from __future__ import annotations

import os
import sys
from enum import Enum
from typing import TYPE_CHECKING, Final, NamedTuple, TextIO

if TYPE_CHECKING:
    from collections.abc import Callable
    from typing import Self

    from rich.console import Console


class Style(Enum):
    """What a colour means, with its code (ECMA-48, SGR)."""

    GOOD = "32"
    NOTICE = "33"
    BAD = "1;31"
    REMOVED = "31"
    PLACE = "36"


_WORDS: Final = {
    "RUN": Style.GOOD,
    "STOP": Style.NOTICE,
    "ok": Style.GOOD,
    "FOUND": Style.GOOD,
    "FAULT": Style.BAD,
    "FAILED": Style.BAD,
    "DIFFERS": Style.BAD,
    "differs": Style.BAD,
    "same": Style.GOOD,
    "done": Style.GOOD,
    "not done": Style.NOTICE,
    "pass": Style.GOOD,
    "fail": Style.BAD,
}
_SIGNS: Final = {"+": Style.GOOD, "-": Style.REMOVED, "@": Style.PLACE}


class _Span(NamedTuple):
    start: int
    end: int
    style: Style


class Coloured(str):
    """A text with styles of its parts; f-strings and ``str`` methods give the plain text."""

    __slots__ = ("spans",)

    spans: tuple[_Span, ...]

    def __new__(cls, text: str, spans: tuple[_Span, ...] = ()) -> Self:
        """A text with the styles of its parts."""
        made = super().__new__(cls, text)
        made.spans = spans
        return made


def coloured(text: str, style: Style | None) -> Coloured:
    """A text in one style; None for none."""
    return Coloured(text, () if style is None or not text else (_Span(0, len(text), style),))


def word(text: str) -> Coloured:
    """A word for a state, such as RUN, in the style that it has everywhere."""
    return coloured(text, _WORDS.get(text))


def bad(text: str, rest: str = "") -> Coloured:
    """A fault in the style that faults have, and its explanation without."""
    return joined(coloured(text, Style.BAD), rest)


def joined(*parts: str) -> Coloured:
    """Texts one after the other, each with its styles."""
    spans: list[_Span] = []
    at = 0
    for part in parts:
        if isinstance(part, Coloured):
            spans += (_Span(at + start, at + end, style) for start, end, style in part.spans)
        at += len(part)
    return Coloured("".join(parts), tuple(spans))


def diff_line(text: str) -> Coloured:
    """A line of a unified diff: removed red, added green, its place cyan."""
    return coloured(text, _SIGNS.get(text[:1]))


def rendered(text: str, stream: TextIO, spell: Callable[[str], str]) -> str:
    """A text as it is written to a stream.

    Args:
        text: the text, perhaps with styles.
        stream: standard output or standard error.
        spell: makes each part safe for a terminal; it may change its length.
    """
    if not isinstance(text, Coloured) or not text.spans or not shows_colour(stream):
        return spell(text)
    parts, at = [], 0
    for start, end, style in text.spans:
        parts += [spell(text[at:start]), f"\x1b[{style.value}m", spell(text[start:end]), "\x1b[0m"]
        at = end
    return "".join([*parts, spell(text[at:])])


def shows_colour(stream: TextIO) -> bool:
    """True if colour is shown on this stream."""
    if os.environ.get("NO_COLOR"):
        return False
    forced = os.environ.get("FORCE_COLOR")
    if forced:
        return forced != "0"
    return stream.isatty() and os.environ.get("TERM") != "dumb"


def stderr_console() -> Console:
    """A console of rich on standard error, for a bar or a table that is drawn again and again."""
    from rich.console import Console

    return Console(stderr=True, no_color=not shows_colour(sys.stderr), highlight=False)
