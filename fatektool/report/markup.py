"""The conversion of text to HTML: everything that is not yet ``Html`` is escaped.

A name from a file, a target or an error message may contain any characters. ``<>&"'`` become references.
Characters without a visible form (control characters, marks for the direction of writing, surrogates) are
shown as Python escapes them, so that no text can be misleading.
"""

from __future__ import annotations

import html
import json
from typing import TYPE_CHECKING, Final

if TYPE_CHECKING:
    from collections.abc import Iterable, Sequence

_VOID: Final = frozenset({"meta"})
_WIDE: Final = 4
DASH: Final = "–"  # noqa: RUF001  # an en dash means no value


class Html(str):
    """Text that is HTML already."""

    __slots__ = ()


NEWLINE: Final = Html("\n")
"""Between elements, so that the source is readable and a mail program can break its lines."""


def escape(text: str) -> Html:
    """Text escaped for an element or a quoted attribute."""
    if not text.isprintable():
        text = "".join(each if each.isprintable() else _as_escape(each) for each in text)
    return Html(html.escape(text))


def _as_escape(character: str) -> str:
    return character.encode("unicode_escape").decode("ascii")


def markup(content: object) -> Html:
    """Anything as HTML: ``Html`` unchanged, everything else as escaped text."""
    return content if isinstance(content, Html) else escape(str(content))


def join(parts: Iterable[object], between: object = "") -> Html:
    """Pieces one after the other."""
    return Html(markup(between).join(markup(part) for part in parts))


def tag(name: str, /, *content: object, **attributes: object) -> Html:
    """An element.

    Args:
        name: ``p``, ``rect``.
        content: its contents.
        attributes: ``class_`` is ``class``, ``aria_label`` is ``aria-label``. An attribute that is None is
            omitted, one that is True has no value.
    """
    shown = "".join(_attribute(key, value) for key, value in attributes.items() if value is not None)
    if name in _VOID:
        return Html(f"<{name}{shown}>")
    return Html(f"<{name}{shown}>{join(content)}</{name}>")


def _attribute(name: str, value: object) -> str:
    name = name.rstrip("_").replace("_", "-")
    return f" {name}" if value is True else f' {name}="{escape(str(value))}"'


def figure(value: object, shown: str | None = None, unit: str = "") -> Html:
    """A value of the document: as in JSON in the ``value`` of ``<data>``, and as text.

    Args:
        value: as in the document: a number, true or false, a text, None.
        shown: the text; by default the value itself, seven digits of a float, a dash for None.
        unit: after the value.
    """
    if shown is None:
        shown = plain(value)
    after = f" {unit}" if unit and value is not None else ""
    return tag("data", f"{shown}{after}", value=json.dumps(value, allow_nan=False))


def plain(value: object) -> str:
    """A value as text."""
    match value:
        case None:
            return DASH
        case bool():
            return "on" if value else "off"
        case float():
            return f"{value:.7g}"
        case _:
            return str(value)


def when(time: str | None) -> Html:
    """A time of a document, RFC 3339 in UTC, as text."""
    if time is None:
        return escape(DASH)
    return tag("time", f"{time.removesuffix('Z').replace('T', ' ')} UTC", datetime=time)


def percent(ratio: object) -> str:
    """A ratio of 0 to 1 in per cent, three digits."""
    return f"{ratio * 100:.3g} %" if isinstance(ratio, int | float) else DASH


def table(
    caption: str,
    head: Sequence[object],
    rows: Iterable[Sequence[object]],
    *,
    numeric: Iterable[int] = (),
    scroll: bool | None = None,
) -> Html:
    """A table; the first cell of a row is its name.

    Args:
        caption: of the table.
        head: the names of the columns.
        rows: the cells.
        numeric: the columns that are aligned right.
        scroll: in a narrow window the table scrolls, not the page; by default if it has many columns.
    """
    right = set(numeric)
    classes = ["n" if number in right else None for number in range(len(head))]
    top = (tag("th", name, scope="col", class_=each) for name, each in zip(head, classes, strict=True))
    body = (
        tag(
            "tr",
            tag("th", row[0], scope="row", class_=classes[0]),
            *(tag("td", cell, class_=each) for cell, each in zip(row[1:], classes[1:], strict=True)),
        )
        for row in rows
    )
    whole = tag(
        "table", tag("caption", caption), tag("thead", tag("tr", *top)), tag("tbody", join(body, NEWLINE))
    )
    if not (len(head) > _WIDE if scroll is None else scroll):
        return whole
    return tag("div", whole, class_="scroll", role="region", aria_label=caption, tabindex="0")
