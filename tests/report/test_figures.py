"""The figures of a report are those of its document: each where it belongs."""

from __future__ import annotations

from itertools import pairwise
from typing import TYPE_CHECKING, Any

import pytest

from fatektool.report.loopback import loopback_report
from fatektool.report.program import MOST_PAGES, diff_report, verify_report
from fatektool.report.rounds import MOST_GAPS, Rounds
from fatektool.report.series import MOST_CHARTS, series_report
from fatektool.report.snapshot import MOST_ROWS, snapshot_report
from tests.program.samples import changed, program
from tests.report.documents import TIME, dead_line, diffed, loopback, place, series, snapshot, verified
from tests.report.tree import Node, facts, parse, rows, section, texts

if TYPE_CHECKING:
    from fatektool.program.image import Program


def flat(page: Node, caption: str) -> list[list[Any]]:
    """The figures of a table, row by row."""
    return [[figure for cell in row for figure in cell.figures] for row in rows(page, caption)]


# --- loopback -------------------------------------------------------------------------------------------


@pytest.mark.parametrize("document", [loopback(), dead_line()], ids=["a few errors", "nothing"])
def test_loopback(document: dict[str, Any]) -> None:
    page = parse(loopback_report(document))
    names = {
        "Duration": "duration_s",
        "Sent": "sent",
        "Answered correctly": "ok",
        "Error rate": "error_rate",
        "Error rate, at most (95 %)": "error_rate_upper95",
        "Bytes sent": "bytes_sent",
        "Bytes received": "bytes_received",
        "Line in use": "line_use",
    }
    found = facts(page)
    assert {name: found[name].figures for name in names} == {n: [document[k]] for n, k in names.items()}
    assert {row[0]: int(row[2]) for row in texts(page, "Errors by kind")} == document["errors"]
    order = ("min", "mean", "p50", "p90", "p99", "p999", "max")
    assert flat(page, "From request to answer; the PLC's part is without time on the wire") == [
        [document["latency_ms"][name], document["turnaround_ms"][name]] for name in order
    ]
    assert flat(page, "By size of the data sent") == [
        [
            *(each[key] for key in ("size", "sent", "ok", "error_rate")),
            *(each["latency_ms"][name] for name in ("p50", "p99", "max")),
        ]
        for each in document["by_size"]
    ]
    if document["histogram"]:
        assert flat(page, "Loopbacks by time") == [list(each.values()) for each in document["histogram"]]
        bars = section(page, "Time of an exchange").every("rect")
        heights = [float(str(bar.attributes["height"])) for bar in bars]
        for bar, height in zip(document["histogram"], heights, strict=True):
            assert (height == 0) == (bar["count"] == 0)
        assert heights.index(max(heights)) == 2
    else:
        assert "there are no times" in section(page, "Time of an exchange").text


def test_a_verdict_in_words() -> None:
    good = loopback(sent=5, ok=5, error_rate=0.0, verdict="pass", diagnosis=[])
    good["limits"] = {"max_error_rate": None, "max_p99_ms": None}
    said = parse(loopback_report(good)).first("header").text
    assert "Pass 5 of 5 loopbacks were answered correctly." in said
    said = parse(loopback_report(loopback())).first("header").text
    assert "Fail 891 of 900 loopbacks were answered correctly, 1 % did not." in said
    assert "Limits: error rate at most 0 %, p99 at most 50 ms." in said
    assert "interrupted" in parse(loopback_report(dead_line())).first("header").text
    assert "The line was lost" in loopback_report(loopback(ended="line lost"))


def test_a_diagnosis_in_words() -> None:
    found = section(parse(loopback_report(loopback())), "Diagnosis").text
    for part in loopback()["diagnosis"][0].values():
        assert part is True or part in found
    assert "Diagnosis" not in loopback_report(loopback(diagnosis=[]))


# --- programs -------------------------------------------------------------------------------------------


def shown_words(page: Node, caption: str) -> tuple[list[str], set[int]]:
    """The words of a side of a page, and the places of those that are marked."""
    cells = [cell for row in rows(page, caption) for cell in row[1:]]
    marked = {place for place, cell in enumerate(cells) if list(cell.every("mark"))}
    return [cell.text for cell in cells], marked


def words_of(image: Program, number: int) -> list[str]:
    page = image.pages[number].hex().upper()
    return [page[place : place + 4] for place in range(0, 256, 4)]


@pytest.mark.parametrize("command", ["verify", "diff"])
def test_what_changed_is_marked_on_both_sides(command: str) -> None:
    a = program(1000)
    b = changed(a, 3, 7, 16)
    document = verified(a, b) if command == "verify" else diffed(a, b)
    html = verify_report(document, a) if command == "verify" else diff_report(document, a, b, time=TIME)
    page = parse(html)
    sides = ("file", "PLC") if command == "verify" else ("A", "B")
    assert facts(page)["Pages that differ"].figures == [3]
    assert facts(page)["Pages that differ"].text == "3: 3, 7, 16"
    assert facts(page)["Words that differ"].figures == [3]
    assert flat(page, f"From {sides[0]} to {sides[1]}") == [[3, 1], [7, 1], [16, 1]]
    for number in (3, 7, 16):
        for side, image in zip(sides, (a, b), strict=True):
            words, marked = shown_words(page, f"Page {number}, {side}")
            assert words == words_of(image, number)
            assert marked == {32}
        (listed,) = texts(page, f"Page {number}, the words that differ")
        assert listed == ["32", words_of(a, number)[32], words_of(b, number)[32]]
    marks = [each.first("title").text for each in page.every("g") if each.attributes["class"] == "changed"]
    assert marks == [*(f"page {number}: 1 word differs" for number in (3, 7, 16)), "differs"]


def test_the_map_has_a_cell_for_every_page() -> None:
    for words in (1, 64, 65, 13_184, 65_535):
        image = program(words)
        page = parse(verify_report(verified(image, image), image))
        cells, legend = (each for each in page.every("path") if each.attributes["class"] == "cell")
        assert str(cells.attributes["d"]).count("M") == len(image.pages)
        assert str(legend.attributes["d"]).count("M") == 1
        assert f"all {len(image.pages)} pages" in page.first("header").text
        assert not list(page.every("table"))


def test_pages_that_one_side_does_not_have() -> None:
    a, b = program(400), program(500)
    for one, other, lone, missing in ((a, b, "B", "A"), (b, a, "A", "B")):
        page = parse(diff_report(diffed(one, other), one, other, time=TIME))
        assert shown_words(page, f"Page 8, {lone}") == (words_of(b, 8), set())
        assert f"Page 8, {missing}: not in this program." in page.text
        assert texts(page, "From A to B")[-1] == ["8", "–", "only in one of the two"]  # noqa: RUF001
        assert "The ladder size is" in page.first("header").text
        (drawn, key) = (each for each in page.every("g") if each.attributes["class"] == "lone")
        assert drawn.first("title").text == "page 8: only in one of the two"
        assert key.first("title").text == "one"


def test_a_plc_of_another_size() -> None:
    a = program(400)
    document = verified(a, a) | {"same": False, "b_ladder_words": 500}
    page = parse(verify_report(document, a))
    assert "The ladder size is 400 words (file) and 500 words (PLC)." in page.first("header").text
    assert "were not read" in page.text
    assert not list(page.every("svg"))


def test_a_thousand_changed_pages() -> None:
    a, b = program(65_535, seed=1), program(65_535, seed=2)
    html = diff_report(diffed(a, b, check_it=False), a, b, time=TIME)
    assert len(html) < 1_500_000
    page = parse(html)
    shown = [row[0].text for row in rows(page, "From A to B")]
    assert len(shown) < 1024
    numbers = [tuple(map(int, text.split("-"))) for text in shown]
    assert [each for ends in numbers for each in range(ends[0], ends[-1] + 1)] == list(range(1, 1025))
    assert facts(page)["Pages that differ"].text == "1024: 1-1024"
    sides = [each for each in page.every("section") if each.attributes.get("class") == "page"]
    assert len(sides) == MOST_PAGES
    assert f"The first {MOST_PAGES} pages that differ are shown. The other {1024 - MOST_PAGES}" in page.text


# --- series ---------------------------------------------------------------------------------------------


def test_a_snapshot() -> None:
    document = snapshot(13)
    page = parse(snapshot_report(document))
    found = rows(page, "Values in the PLC")
    assert {row[0].text: row[3].figures[0] for row in found} == document["values"]
    assert {row[0].text: row[6].text for row in found if row[6].text} == document["errors"]
    assert [row[1].text for row in found] == [part["element"] for part in document["elements"].values()]
    assert facts(page)["Duration"].figures == [document["duration_s"]]
    assert facts(page)["Mode"].text == "RUN"
    assert "Read in part 5 values read in 4 requests. 1 could not be read." in page.first("header").text


def test_a_series() -> None:
    page = parse(series_report(series(), place(), ended="interrupted"))
    documents = [snapshot(number) for number in range(120) if not 60 <= number < 64]
    overview = {row[0].text: row for row in rows(page, "All values, all rounds")}
    assert list(overview) == list(documents[0]["values"])
    for key, row in overview.items():
        values = [each["values"][key] for each in documents if each["values"][key] is not None]
        numbers = [each for each in values if type(each) is not bool and not isinstance(each, str)]
        last, least, mean, most, changes, read, gaps = (cell.figures[0] for cell in row[3:])
        assert last == values[-1]
        assert (least, most) == ((min(numbers), max(numbers)) if numbers else (None, None))
        assert mean == (pytest.approx(sum(numbers) / len(numbers)) if numbers else None)
        assert changes == sum(one != other for one, other in pairwise(values))
        assert (read, gaps) == (len(values), len(documents) - len(values))
    assert facts(page)["Rounds read"].figures == [116]
    assert facts(page)["Rounds lost"].figures == [4]
    assert facts(page)["Changes of mode"].figures == [1]
    assert facts(page)["Mode at the end"].text == "STOP"
    assert "Ended: interrupted." in page.first("header").text
    named = texts(page, "Missing values")
    assert [row[2:] for row in named].count(["oil temperature", "2", "7FC00000 is not a number as f32"]) == 6
    lost = ["2026-11-22 03:01:00 UTC", "2026-11-22 03:01:03 UTC", "all", "4"]
    assert [*lost, "no answer from station 1 in 4 tries of 0.5 s"] in named
    assert texts(page, "Hex values: first values, then changes") == [
        ["2026-11-22 03:00:00", "recipe", "BEEF"],
        ["2026-11-22 03:00:50", "recipe", "0001"],
    ]


def is_line(node: Node) -> bool:
    return node.attributes["class"] == "series"


def test_the_line_of_a_series_breaks_at_its_gaps() -> None:
    page = parse(series_report(series(), place()))
    lines = {each.first("figcaption").text: each.first("svg") for each in page.every("figure")}
    drawn = {
        caption: [str(each.attributes["d"]) for each in image.every("path") if is_line(each)]
        for caption, image in lines.items()
    }
    assert drawn["pressure, bar"][0].count("M") == 2
    assert drawn["oil temperature, °C"][0].count("M") == 8
    assert drawn["pressure, bar"][0].count("L") == 116 - 2
    assert len(drawn["valve[0] to valve[1]"]) == 2
    gaps = [each for each in lines["strokes"].every("path") if each.attributes["class"] == "gap"]
    assert len(gaps) == 1


def test_a_long_series_is_thinned_and_says_so() -> None:
    page = parse(series_report(series(5000, most_points=300), place()))
    assert "The charts show one of 32 rounds and the last" in page.text
    assert facts(page)["Rounds read"].figures == [4996]
    assert len(texts(page, "Missing values")) == MOST_GAPS
    assert "more are left out" in section(page, "Gaps").text
    image = next(each for each in page.every("svg") if each.first("title").text == "strokes")
    (line,) = (each for each in image.every("path") if each.attributes["class"] == "series")
    assert 100 < str(line.attributes["d"]).count("L") <= 301


def test_a_series_of_very_many_values_is_bounded() -> None:
    rounds = Rounds()
    keys = [f"R{number}" for number in range(6000)]
    part = {"type": "u16", "raw": "0000"}
    elements = {key: {"element": key, **part} for key in keys}
    for number in range(3):
        values = dict.fromkeys(keys, 0) | {"R5999": number, "R100": 1}
        rounds.add(snapshot(number, values=values, elements=elements, errors={}, check_it=False))
    html = series_report(rounds, place())
    assert len(html) < 3_000_000
    page = parse(html)
    assert len(rows(page, "All values, all rounds")) == MOST_ROWS
    assert texts(page, "All values, all rounds")[-1][0] == "R5999"  # what changed comes first
    charts = [each.first("title").text for each in page.every("svg")]
    assert len(charts) == MOST_CHARTS
    assert "R5999" in charts
    assert f"{MOST_ROWS} values of 6000 are shown, values that changed first" in page.text


def test_nothing_read() -> None:
    rounds = Rounds()
    rounds.fail(TIME, "no answer")
    for empty in (Rounds(), rounds):
        page = parse(series_report(empty, place(), ended="no answer"))
        assert "Nothing read" in page.first("header").text
        assert "Ended: no answer." in page.text
        assert not list(page.every("svg"))
