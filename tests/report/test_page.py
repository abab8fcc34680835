"""What holds for every report: a well-formed file that stands alone and that everybody can read."""

from __future__ import annotations

import base64
import hashlib
import re
from functools import cache
from itertools import pairwise

import pytest

from fatektool.report import style
from fatektool.report.page import LONGEST_START, is_report
from fatektool.report.scale import Scale
from fatektool.version import __version__
from tests.report.documents import REPORTS, report
from tests.report.tree import Node, parse


@cache
def tree(name: str) -> Node:
    return parse(report(name))


@pytest.fixture(params=REPORTS)
def page(request: pytest.FixtureRequest) -> Node:
    return tree(request.param)


@pytest.mark.parametrize("name", REPORTS)
def test_the_same_documents_give_the_same_bytes(name: str) -> None:
    assert REPORTS[name]() == report(name)


def test_the_frame(page: Node) -> None:
    assert page.attributes["lang"] == "en-GB"
    assert len(page.first("title").text) > 10
    (main,) = page.every("main")
    (skip,) = (each for each in page.every("a") if each.attributes.get("class") == "skip")
    assert skip.attributes["href"] == f"#{main.attributes['id']}"
    metas = {each.attributes.get("name"): each.attributes.get("content") for each in page.every("meta")}
    assert metas["viewport"] == "width=device-width, initial-scale=1"
    footer = page.first("footer").text
    assert re.match(rf"fatektool {re.escape(__version__)}, fatektool\.[a-z]+/1, \d{{4}}-", footer)


def test_headings_are_in_order(page: Node) -> None:
    levels = [int(each.name[1]) for each in page.every("h1", "h2", "h3", "h4")]
    assert levels[0] == 1
    assert levels.count(1) == 1
    assert all(below <= above + 1 for above, below in pairwise(levels))
    assert all(each.text.strip() for each in page.every("h1", "h2", "h3"))


def test_names_are_unique_and_links_lead_somewhere(page: Node) -> None:
    names = [each.attributes["id"] for each in page.every() if "id" in each.attributes]
    assert len(names) == len(set(names))
    for each in page.every("a"):
        href = each.attributes["href"]
        assert href is not None
        assert href.startswith("#")  # nothing but the page itself
        assert href[1:] in names


def test_every_image_tells_what_it_shows(page: Node) -> None:
    for image in page.every("svg"):
        assert image.attributes["role"] == "img"
        titled = str(image.attributes["aria-labelledby"]).split()
        named = {each.attributes.get("id"): each for each in image.every("title", "desc")}
        assert [named[name].name for name in titled] == ["title", "desc"]
        assert all(named[name].text.strip() for name in titled)


def test_every_chart_has_its_figures_beside_it(page: Node) -> None:
    for figure in page.every("figure"):
        if figure.first("svg").attributes["id"] == "map":
            continue  # the table of the pages that differ follows it
        assert figure.first("details").first("table").first("tbody").first("tr").text


def test_every_table_can_be_read_aloud(page: Node) -> None:
    tables = list(page.every("table"))
    for table in tables:
        assert table.first("caption").text.strip()
        heads = list(table.first("thead").every("th"))
        assert all(each.attributes["scope"] == "col" and each.text.strip() for each in heads)
        for row in table.first("tbody").every("tr"):
            first, *rest = row.every("th", "td")
            assert (first.name, first.attributes["scope"]) == ("th", "row")
            assert {each.name for each in rest} == {"td"}
            assert len(rest) + 1 == len(heads)
    for region in page.every("div"):
        if region.attributes.get("class") == "scroll":
            assert region.attributes["tabindex"] == "0"
            assert region.attributes["aria-label"]


def test_nothing_runs_and_nothing_is_loaded(page: Node) -> None:
    (policy,) = (
        str(each.attributes["content"])
        for each in page.every("meta")
        if each.attributes.get("http-equiv") == "Content-Security-Policy"
    )
    (sheet,) = page.every("style")
    digest = base64.b64encode(hashlib.sha256(sheet.text.encode()).digest()).decode()
    allowed = dict(part.strip().split(" ", 1) for part in policy.split(";"))
    assert allowed == {
        "default-src": "'none'",
        "style-src": f"'sha256-{digest}'",
        "base-uri": "'none'",
        "form-action": "'none'",
    }
    for each in page.every():
        assert each.name not in {"script", "link", "img", "iframe", "object", "form", "base"}
        assert not {"style", "src"} & each.attributes.keys()
        assert not [name for name in each.attributes if name.startswith("on")]
    assert "@import" not in sheet.text
    assert "url(" not in sheet.text


def test_the_words_of_a_verdict_do_not_rest_on_its_colour(page: Node) -> None:
    (verdict,) = (each for each in page.every("p") if "verdict" in str(each.attributes.get("class")))
    assert verdict.first("strong").text
    assert len(verdict.text) > 20


@pytest.mark.parametrize("name", REPORTS)
def test_a_report_knows_itself(name: str) -> None:
    assert is_report(report(name)[:LONGEST_START])
    assert not is_report(report(name)[:LONGEST_START].replace("fatektool", "another"))
    assert not is_report(f" {report(name)}"[:LONGEST_START])


# --- the style sheet ------------------------------------------------------------------------------------


def luminance(colour: str) -> float:
    parts = [int(colour[place : place + 2], 16) / 255 for place in (1, 3, 5)]
    linear = [part / 12.92 if part <= 0.04045 else ((part + 0.055) / 1.055) ** 2.4 for part in parts]
    return sum(weight * part for weight, part in zip((0.2126, 0.7152, 0.0722), linear, strict=True))


def contrast(one: str, other: str) -> float:
    """WCAG 2.2: 1 to 21."""
    low, high = sorted(map(luminance, (one, other)))
    return (high + 0.05) / (low + 0.05)


@pytest.mark.parametrize("scheme", [style.LIGHT, style.DARK], ids=["light", "dark"])
def test_contrast(scheme: dict[str, str]) -> None:
    assert round(contrast("#000000", "#ffffff"), 9) == 21
    for ink in ("ink", "quiet", "line", "good", "bad"):
        assert contrast(scheme[ink], scheme["paper"]) >= 4.5, ink
    assert contrast(scheme["ink"], scheme["ground"]) >= 4.5


def test_light_dark_and_paper() -> None:
    sheet = style.SHEET
    assert style.LIGHT.keys() == style.DARK.keys()
    named = set(re.findall(r"var\(--([a-z]+)\)", sheet))
    assert named == style.LIGHT.keys()  # every colour is of a scheme, and every one is used
    assert re.search(r"@media screen and \(prefers-color-scheme:dark\)\{:root\{--paper:#15181c;", sheet)
    assert sheet.count(style.DARK["paper"]) == 1  # so paper is never dark
    on_paper = sheet.split("@media print{")[1]
    for rule in ("break-inside:avoid", "break-after:avoid", "table-header-group", "overflow:visible"):
        assert rule in on_paper
    assert sheet.count("{") == sheet.count("}")
    rest = sheet.replace(f":root{{color-scheme:light dark;{style._colours(style.LIGHT)}}}", "")
    rest = rest.replace(f":root{{{style._colours(style.DARK)}}}", "")
    assert not re.search(r"#[0-9a-f]{3,6}\b", rest)


def test_every_class_has_its_rule() -> None:
    used = {
        name for kind in REPORTS for each in tree(kind).every()
        for name in str(each.attributes.get("class") or "").split()
    }  # fmt: skip
    assert {name for name in used if not re.search(rf"\.{name}\b", style.SHEET)} == set()


def test_a_scale_ends_where_it_ends() -> None:
    assert Scale(-1.7e308, 1.7e308, 10, 20).at(1.7e308) == 20
    assert Scale(-1.7e308, 1.7e308, 10, 20).at(-1.7e308) == 10
    assert Scale(0, 4, 100, 0).at(1) == 75
