"""Reports in Chromium: they load without a complaint and ask for nothing, their figures are there to be read.

They fit a wide window, a narrow one and paper, light and dark.
"""

from __future__ import annotations

import json
import os
import re
import shutil
from typing import TYPE_CHECKING, Any

import pytest

from fatektool.report import style
from tests.report.browser import Browser, Page
from tests.report.documents import REPORTS, loopback, report, snapshot
from tests.report.tree import parse

if TYPE_CHECKING:
    from collections.abc import Iterator
    from pathlib import Path

CHROMIUM = shutil.which("chromium") or shutil.which("chromium-browser") or shutil.which("google-chrome")
SHOWN = ("loopback", "dead line", "verify", "diff", "snapshot", "watch", "listing", "ladder diff")

pytestmark = pytest.mark.skipif(
    CHROMIUM is None and not os.environ.get("CI"), reason="there is no Chromium here; in CI there must be"
)

FIGURES = "JSON.stringify([...document.querySelectorAll('data')].map(each => each.value))"
FACTS = """JSON.stringify(Object.fromEntries([...document.querySelectorAll('dl div')]
    .map(each => [each.querySelector('dt').innerText, each.querySelector('dd').innerText])))"""
TABLE = """JSON.stringify([...document.querySelectorAll('tbody tr')]
    .map(each => [each.cells[0].innerText, each.cells[3].innerText]))"""
TEXT_COLOURS = """JSON.stringify([...document.querySelectorAll('h1,p,td,th,dt,dd,summary,a,mark,text')]
    .filter(each => !each.closest('.skip'))
    .map(each => getComputedStyle(each)[each.tagName == 'text' ? 'fill' : 'color']))"""
WIDEST = """Math.max(...[...document.querySelectorAll('.ladder')]
    .map(each => each.getBoundingClientRect().width))"""
SIDES = """JSON.stringify([...document.querySelectorAll('.network .sides')].map(each =>
    [...each.children].map(side => side.getBoundingClientRect()).map(box => [box.left, box.top])))"""
MARKS = """JSON.stringify(Object.fromEntries(['added', 'removed'].map(name => {
    const mark = document.querySelector(`g.${name}`)
    const drawn = getComputedStyle(mark.querySelector('rect'))
    return [name, [drawn.stroke, drawn.strokeDasharray, mark.querySelector('text').textContent]]
})))"""
COVERED = """JSON.stringify([...document.querySelectorAll('g.added text,g.removed text')].flatMap(sign => {
    const box = sign.getBoundingClientRect()
    return [...sign.closest('svg').querySelectorAll('text')]
        .filter(each => !each.closest('g.added,g.removed'))
        .filter(each => {
            const other = each.getBoundingClientRect()
            return other.left < box.right && box.left < other.right
                && other.top < box.bottom && box.top < other.bottom
        }).map(each => each.textContent)
}))"""
OUTSIDE = """JSON.stringify([...document.querySelectorAll('svg')].flatMap(image => {
    const box = image.getBoundingClientRect()
    return [...image.querySelectorAll('text,path,rect')].map(each => each.getBoundingClientRect())
        .filter(each => each.width && (each.left < box.left - 2 || each.right > box.right + 2
            || each.top < box.top - 2 || each.bottom > box.bottom + 2))
        .map(each => [image.id, each.left - box.left, each.right - box.right])
}))"""


@pytest.fixture(scope="module")
def page(tmp_path_factory: pytest.TempPathFactory) -> Iterator[Page]:
    assert CHROMIUM is not None, "install chromium: without it nobody has looked at the reports"
    with Browser(CHROMIUM, tmp_path_factory.mktemp("chromium")) as browser:
        yield browser.page()


@pytest.fixture(scope="module")
def folder(tmp_path_factory: pytest.TempPathFactory) -> Path:
    place = tmp_path_factory.mktemp("reports")
    for name, html in ((name, report(name)) for name in REPORTS):
        (place / f"{name}.html").write_text(html, encoding="utf-8")
    return place


def asked(page: Page, expression: str) -> Any:
    return json.loads(page.value(expression))


@pytest.mark.parametrize("name", SHOWN)
def test_it_loads_and_shows_what_it_has(page: Page, folder: Path, name: str) -> None:
    path = folder / f"{name}.html"
    page.requests.clear()
    page.show()
    page.open(path)
    assert page.complaints == []
    assert page.requests == [path.as_uri()]
    tree = parse(path.read_text(encoding="utf-8"))
    assert asked(page, FIGURES) == [each.attributes["value"] for each in tree.every("data")]
    assert page.value("document.title") == tree.first("title").text
    for width, dark in ((1200, False), (1200, True), (400, False)):
        page.show(width=width, dark=dark)
        assert page.value("document.documentElement.scrollWidth") <= width
        paper = style.DARK["paper"] if dark else style.LIGHT["paper"]
        assert page.value("getComputedStyle(document.documentElement).backgroundColor") == rgb(paper)
        scheme = style.DARK if dark else style.LIGHT
        inks = {rgb(scheme[ink]) for ink in ("ink", "quiet", "line", "good", "bad")}
        assert set(asked(page, TEXT_COLOURS)) <= inks
        assert asked(page, OUTSIDE) == []
    assert page.complaints == []


CUT = """JSON.stringify([...document.querySelectorAll('table')]
    .map(each => [each.caption && each.caption.innerText, each.getBoundingClientRect().right - innerWidth])
    .filter(each => each[1] > 0))"""


@pytest.mark.parametrize("name", SHOWN)
@pytest.mark.parametrize("width", [360, 390])
def test_no_table_is_cut_on_a_phone(page: Page, folder: Path, name: str, width: int) -> None:
    """Only a table with a column for each element, and a ladder, may be wider than the screen."""
    page.show(width=width)
    page.open(folder / f"{name}.html")
    assert [caption for caption, _ in asked(page, CUT) if caption != "All values, all rounds"] == []


def test_the_figures_on_the_screen_are_those_of_the_document(page: Page, folder: Path) -> None:
    page.show()
    page.open(folder / "loopback.html")
    found, document = asked(page, FACTS), loopback()
    assert found["Sent"] == str(document["sent"])
    assert found["Error rate"] == "1 %"
    assert found["Duration"] == f"{document['duration_s']} s"
    page.open(folder / "snapshot.html")
    document = snapshot(13)
    shown = {True: "on", False: "off", None: "–"}  # noqa: RUF001  # an en dash
    expected = {
        key: shown[value] if value is None or isinstance(value, bool) else str(value)
        for key, value in document["values"].items()
    }
    assert dict(asked(page, TABLE)) == expected


def test_paper_is_light_and_nothing_is_cut(page: Page, folder: Path) -> None:
    page.open(folder / "verify.html")
    page.show(width=720, dark=True, media="print")
    assert page.value("getComputedStyle(document.documentElement).backgroundColor") == "rgb(255, 255, 255)"
    assert page.value("getComputedStyle(document.querySelector('h1')).color") == rgb(style.LIGHT["ink"])
    assert page.value("document.documentElement.scrollWidth") <= 720
    sheets = page.paper()
    assert sheets.startswith(b"%PDF-")
    assert 2 <= len(re.findall(rb"/Type\s*/Page\b", sheets)) <= 3


def test_a_ladder_keeps_its_size_and_fits_the_paper(page: Page, folder: Path) -> None:
    """On a phone it scrolls in its own frame; both sides of a comparison are in view on a wide screen."""
    page.show(width=400)
    page.open(folder / "listing.html")
    on_a_phone = page.value(WIDEST)
    assert on_a_phone > 400
    page.show()
    assert page.value(WIDEST) == on_a_phone
    page.show(width=720, media="print")
    assert page.value(WIDEST) <= 720
    page.show()
    page.open(folder / "ladder diff.html")
    places = asked(page, SIDES)
    assert len(places) == 3
    for (a_left, a_top), (b_left, b_top) in places:
        assert a_left < b_left
        assert a_top == b_top


def test_what_was_added_or_removed_is_seen_without_its_colour(page: Page, folder: Path) -> None:
    for dark in (False, True):
        page.show(dark=dark)
        page.open(folder / "ladder diff.html")
        scheme = style.DARK if dark else style.LIGHT
        assert asked(page, MARKS) == {
            "added": [rgb(scheme["good"]), "none", "+"],
            "removed": [rgb(scheme["bad"]), "5px, 3px", "\N{MINUS SIGN}"],
        }


def test_a_plus_or_minus_covers_no_name(page: Page, folder: Path) -> None:
    for width in (390, 1200):
        page.show(width=width)
        page.open(folder / "ladder diff.html")
        assert asked(page, COVERED) == []


def test_a_list_opens_without_a_script(page: Page, folder: Path) -> None:
    page.show()
    page.open(folder / "verify.html")
    tall = "document.querySelector('details').getBoundingClientRect().height"
    closed = page.value(tall)
    page.value("document.querySelector('summary').click()")
    assert page.value(tall) > closed + 20


def test_a_page_that_does_complain_is_noticed(page: Page, tmp_path: Path, folder: Path) -> None:
    """The check itself: a style that the policy does not know, and a picture from elsewhere."""
    html = (folder / "verify same.html").read_text(encoding="utf-8")
    bad = tmp_path / "bad.html"
    bad.write_text(html.replace("<h1>", '<h1 style="color:red"><img src="http://192.0.2.1/x.png">'))
    page.open(bad)
    assert any("Content Security Policy" in each for each in page.complaints)
    page.complaints.clear()


def rgb(colour: str) -> str:
    parts = [int(colour[place : place + 2], 16) for place in (1, 3, 5)]
    return f"rgb({parts[0]}, {parts[1]}, {parts[2]})"
