"""Ladders in SVG: each instruction that shows is drawn, what was added or removed is marked."""

from __future__ import annotations

from typing import TYPE_CHECKING

from hypothesis import given

from fatektool.ladder.circuit.writing import instructions_of
from fatektool.ladder.drawing.layout import plan_of
from fatektool.ladder.drawing.signs import frame_of, sign_of
from fatektool.ladder.networks import Code
from fatektool.report.ladder import DiffMark, ladder
from tests.ladder.circuits import coded, words_of
from tests.ladder.drawing.test_layout import CIRCUITS
from tests.report.ladders import COMMENTS, comparison, ladder_diff, listing
from tests.report.tree import Node, parse

if TYPE_CHECKING:
    from fatektool.ladder.circuit.nodes import Circuit


def drawings(html: str) -> dict[str, Node]:
    images = [each for each in parse(html).every("svg") if each.attributes.get("class") == "ladder"]
    return {str(each.attributes["id"]): each for each in images}


def texts(drawing: Node) -> list[str]:
    return [each.text.strip() for each in drawing.every("text")]


def marked(drawing: Node) -> list[str]:
    return [str(each.attributes["class"]) for each in drawing.every("g")]


def test_a_listing_has_each_network_drawn_with_its_instructions_to_open() -> None:
    html = listing()
    found = drawings(html)
    assert list(found) == [f"ladder-n{number:04}" for number in (0, 1, 2, 4, 5)]
    servo = texts(found["ladder-n0001"])
    for text in (
        "S10",
        "FUN 140 HSPSO",
        "EN",
        "PAU",
        "ABT",
        "ACT",
        "DN",
        "Ps:1",
        "SR:R1300 <b>&tabela",
        "M460",
    ):
        assert text in servo, servo
    assert {"►1", "1►", "Zawór", "główny"} <= set(texts(found["ladder-n0002"]))
    assert {"~S20", "STP", "TO"} <= set(texts(found["ladder-n0004"]))
    page = parse(html)
    summaries = [each.text for each in page.every("summary")]
    assert summaries == [f"Instructions of N{number:04}" for number in (0, 1, 2, 3, 4, 5)]
    assert "An empty network." in page.text
    assert (
        "Not drawn: ?? 3FF4 9041 is not known, and its number of words is not known either (instruction"
        in page.text
    )


def test_a_comparison_has_both_sides_with_marks() -> None:
    found = drawings(ladder_diff())
    assert list(found) == ["a-n0000", "b-n0004", "a-n0005", "b-n0005"]
    assert marked(found["a-n0000"]) == ["removed"] * 2
    assert marked(found["b-n0004"]) == ["added"] * 3
    assert marked(found["a-n0005"]) == ["removed"]
    assert marked(found["b-n0005"]) == ["added"]
    (added,) = (each for each in found["b-n0005"].every("g"))
    assert [each.text for each in added.every("text")] == ["+"]
    page = parse(ladder_diff()).text
    assert "Not in B" in page
    assert "Not in A" in page
    assert "N0005 in A" in page


def test_the_numbers_that_are_marked_are_those_that_differ() -> None:
    gone, came, changed = comparison().networks or ()
    assert set(gone.removed) == {0, 1}
    assert not gone.added
    assert not came.removed
    assert came.b is not None
    assert came.added == {number for number, _, _ in came.b.places}
    for network, numbers in ((changed.a, changed.removed), (changed.b, changed.added)):
        assert network is not None
        assert [each.text[-2:] for number, _, each in network.places if number in numbers] == ["M3"]


@given(CIRCUITS)
def test_every_instruction_that_shows_is_drawn(circuit: Circuit) -> None:
    (network,) = coded(instructions_of(circuit))
    numbers = [number for number, _, _ in network.places]
    drawing = ladder(network, COMMENTS, "x", marks=dict.fromkeys(numbers, DiffMark.ADDED))
    assert drawing is not None
    plan, shown = plan_of(circuit), parse(f"<!doctype html>\n<html>{drawing}</html>\n")
    if not list(shown.every("svg")):
        assert "An empty network." in drawing
        return
    found = texts(shown)
    for cell in plan.cells:
        assert sign_of(cell.leaf).name in (*found, "")
    for box in plan.boxes:
        assert frame_of(box.leaf).title in found
    assert len(marked(shown)) == len(plan.cells) + len(plan.boxes)


def test_what_cannot_be_drawn_is_none() -> None:
    (network,) = Code.of(words_of("ORG X0", "ANDLD")).networks
    assert ladder(network, {}, "x") is None
