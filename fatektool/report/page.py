"""The common parts of all reports: one HTML file that loads nothing.

::

    head      title, policy, style sheet
    header    what · where · result · facts
    main      sections
    footer    the tool's version, the document's schema, the time

No script, picture or font is loaded: the policy in its head allows only its style sheet, by the hash. So a
report received by mail is safe to open.
"""

from __future__ import annotations

from dataclasses import dataclass
from typing import TYPE_CHECKING, Final

from fatektool.report.markup import NEWLINE, Html, escape, join, tag, when
from fatektool.report.style import SHEET, SHEET_HASH
from fatektool.version import __version__

if TYPE_CHECKING:
    from collections.abc import Iterable, Sequence

_POLICY: Final = f"default-src 'none'; style-src '{SHEET_HASH}'; base-uri 'none'; form-action 'none'"
START: Final = "<!doctype html>"
_MARK: Final = '<meta name="generator" content="fatektool'
LONGEST_START: Final = 200


@dataclass(frozen=True, slots=True)
class Verdict:
    """The result of a report, as a word and a sentence.

    Attributes:
        word: ``Same``, ``Fail``.
        said: the sentence.
        good: True and False have their own colours; None is neutral.
    """

    word: str
    said: str
    good: bool | None = None


@dataclass(frozen=True, slots=True)
class Report:
    """The contents of a report.

    Attributes:
        title: of the report.
        what: its subject and source.
        verdict: the result.
        facts: names and values.
        sections: the rest, each made by ``section``.
        schema: of the document with the numbers.
        time: of the reading, UTC, RFC 3339.
    """

    title: str
    what: str
    verdict: Verdict
    facts: Sequence[tuple[str, object]]
    sections: Sequence[Html]
    schema: str
    time: str


def render(report: Report) -> str:
    """The complete file, with a line end at the end."""
    head = tag(
        "head",
        tag("meta", charset="utf-8"),
        tag("meta", name="generator", content=f"fatektool {__version__}"),
        tag("meta", http_equiv="Content-Security-Policy", content=_POLICY),
        tag("meta", name="viewport", content="width=device-width, initial-scale=1"),
        tag("meta", name="referrer", content="no-referrer"),
        tag("title", f"{report.title}: {report.what}"),
        tag("style", Html(SHEET)),
    )
    verdict = report.verdict
    mood = {True: "verdict good", False: "verdict bad", None: "verdict"}[verdict.good]
    header = tag(
        "header",
        tag("h1", report.title),
        tag("p", report.what, class_="what"),
        tag("p", tag("strong", verdict.word), " ", verdict.said, class_=mood),
        facts(report.facts),
    )
    footer = tag("footer", tag("p", f"fatektool {__version__}, {report.schema}, ", when(report.time)))
    skip = tag("a", "Skip to the report", href="#report", class_="skip")
    main = tag("main", join([header, *report.sections], NEWLINE), id="report")
    return f"{START}\n" + tag("html", head, NEWLINE, tag("body", skip, main, footer), lang="en-GB") + "\n"


def is_report(start: str) -> bool:
    """True if a file with this beginning is a report of this program.

    Args:
        start: its first ``LONGEST_START`` characters or more.
    """
    return start.startswith(START) and _MARK in start[:LONGEST_START]


def section(heading: str, *content: object, id_: str | None = None) -> Html:
    """A section with its heading."""
    return tag("section", tag("h2", heading), *content, id=id_)


def facts(pairs: Iterable[tuple[str, object]]) -> Html:
    """Names and values, side by side; a long one has its own line."""
    return tag(
        "dl",
        *(
            tag("div", tag("dt", name), tag("dd", what), class_="long" if "<code>" in str(what) else None)
            for name, what in pairs
        ),
    )


def note(text: str) -> Html:
    """A remark on what is shown."""
    return tag("p", text, class_="note")


def chart(caption: str, svg: Html, figures: Html) -> Html:
    """A chart with its numbers as a folded table.

    Args:
        caption: of the chart.
        svg: the chart.
        figures: the table.
    """
    return tag(
        "figure",
        tag("figcaption", caption),
        svg,
        tag("details", tag("summary", f"Figures: {caption}"), figures),
    )


def code(text: str) -> Html:
    """A text to copy: a hash, a path."""
    return tag("code", escape(text))
