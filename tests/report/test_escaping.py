"""Whatever a name holds, a report shows it as text: hostile strings in every place of a document."""

from __future__ import annotations

import re
from typing import TYPE_CHECKING

import pytest
from hypothesis import HealthCheck, example, given, settings
from hypothesis import strategies as st

from fatektool.report.loopback import loopback_report
from fatektool.report.markup import Html, escape, figure, percent, plain, table, tag
from fatektool.report.program import diff_report, verify_report
from fatektool.report.rounds import Rounds
from fatektool.report.series import series_report
from fatektool.report.snapshot import snapshot_report
from tests.program.samples import changed, program
from tests.report.documents import TIME, diffed, loopback, place, snapshot, verified
from tests.report.tree import parse

if TYPE_CHECKING:
    from collections.abc import Callable

HOSTILE = "</title></style></svg>--><script>alert(1)</script><img src=x onerror=\"alert('2')\">&amp;"
DARK = "a\x00b\x1b[31mc\r\nd\u202ee\u2066f\udcffg\u2028h\x7fi\ufeffj"
ANY = st.text(min_size=1, max_size=40)


def of_loopback(text: str) -> str:
    finding = {"rule": text, "fault": True, "finding": text, "evidence": text, "advice": text}
    other = {"target": text, "protocol": text, "line": text, "diagnosis": [finding]}
    return loopback_report(loopback(**other, errors={text: 1}))


def of_verify(text: str) -> str:
    a = program(64)
    return verify_report(verified(a, changed(a, 1), target=text, file=text, protocol=text), a)


def of_diff(text: str) -> str:
    a = program(64)
    document = diffed(a, changed(a, 1))
    for side in "ab":
        document[side]["file"] = text
    return diff_report(document, a, changed(a, 1), time=TIME)


def of_snapshot(text: str) -> str:
    part = {"element": "R0", "type": "hex", "raw": "0000", "unit": text}
    return snapshot_report(
        snapshot(target=text, protocol=text, values={text: text}, elements={text: part}, errors={text: text})
    )


def of_series(text: str) -> str:
    rounds = Rounds()
    unit = {"element": "R0", "type": "u16", "raw": "0000", "unit": text}
    keys = (text, f"on {text}", f"hex {text}")
    values = dict(zip(keys, (5, True, text), strict=True))
    for number in range(3):
        rounds.add(snapshot(number, values=values, elements=dict.fromkeys(keys, unit), errors={}))
    rounds.add(snapshot(3, values=dict.fromkeys(keys), elements={}, errors=dict.fromkeys(keys, text)))
    rounds.fail("2026-11-22T03:00:04Z", text)
    return series_report(rounds, place(target=text), ended=text, left_out=text)


REPORTS = (of_loopback, of_verify, of_diff, of_snapshot, of_series)


def names_of(html: str) -> list[tuple[str, tuple[str, ...]]]:
    """The elements of a page, and their attributes' names."""
    return [(each.name, tuple(each.attributes)) for each in parse(html).every()]


@pytest.mark.parametrize("report", REPORTS)
@given(text=ANY)
@example(text=HOSTILE)
@example(text=DARK)
@example(text="]]><!--")
@example(text="' onload='alert(1)' x=\"")
@settings(max_examples=12, deadline=None, suppress_health_check=[HealthCheck.function_scoped_fixture])
def test_a_text_makes_no_element_and_no_attribute(report: Callable[[str], str], text: str) -> None:
    html = report(text)
    assert names_of(html) == names_of(report("x"))
    assert html.count("<") == report("x").count("<")
    shown = html.replace("\n", "")
    assert shown.isprintable()
    html.encode()  # no half of a character is left


@pytest.mark.parametrize("report", REPORTS)
def test_a_hostile_text_is_there_to_be_read(report: Callable[[str], str]) -> None:
    html = report(HOSTILE)
    assert "<script" not in html
    assert "<img" not in html
    assert str(escape(HOSTILE)) in html
    assert HOSTILE in parse(html).text


@given(ANY)
@example(HOSTILE)
def test_what_can_be_seen_is_shown_as_it_is(text: str) -> None:
    page = parse("<!doctype html>\n" + tag("html", tag("p", text, title=text)))
    shown = page.first("p")
    assert shown.text == shown.attributes["title"]
    if text.isprintable():
        assert shown.text == text
    assert not re.search(r"[<>\"']", escape(text))


def test_what_cannot_be_seen_is_named() -> None:
    named = r"a\x00b\x1b[31mc\r\nd\u202ee\u2066f\udcffg\u2028h\x7fi\ufeffj"
    assert escape(DARK) == named
    assert escape("Öl °C ärger 温度") == "Öl °C ärger 温度"


def test_tags() -> None:
    assert tag("p", "a<b", Html("<b></b>"), 5, class_="x", aria_label='"', hidden=True, id=None) == (
        '<p class="x" aria-label="&quot;" hidden>a&lt;b<b></b>5</p>'
    )
    assert tag("meta", charset="utf-8") == '<meta charset="utf-8">'


@pytest.mark.parametrize(
    ("value", "shown", "stored"),
    [
        (1234567, "1234567", "1234567"),
        (21.399999618530273, "21.4", "21.399999618530273"),
        (True, "on", "true"),
        (False, "off", "false"),
        (None, "–", "null"),  # noqa: RUF001  # an en dash, on purpose
        ("00FF", "00FF", "&quot;00FF&quot;"),
        (-0.0, "-0", "-0.0"),
    ],
)
def test_a_figure_has_what_json_has(value: object, shown: str, stored: str) -> None:
    assert figure(value) == f'<data value="{stored}">{shown}</data>'
    assert plain(value) == shown


def test_units_and_per_cent() -> None:
    assert figure(2.5, unit="s") == '<data value="2.5">2.5 s</data>'
    assert figure(None, unit="s") == '<data value="null">–</data>'  # noqa: RUF001  # an en dash
    assert [percent(ratio) for ratio in (0, 0.01, 0.017384, 1, None)] == [
        "0 %", "1 %", "1.74 %", "100 %", "–",  # noqa: RUF001  # an en dash
    ]  # fmt: skip


def test_a_table() -> None:
    small = table("c", ("a", "b"), [("x", 1)], numeric=(1,))
    assert small == (
        '<table><caption>c</caption><thead><tr><th scope="col">a</th><th scope="col" class="n">b</th></tr>'
        '</thead><tbody><tr><th scope="row">x</th><td class="n">1</td></tr></tbody></table>'
    )
    wide = table("c", tuple("abcde"), [tuple("vwxyz")])
    assert wide.startswith('<div class="scroll" role="region" aria-label="c" tabindex="0"><table>')
