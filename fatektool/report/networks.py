"""Networks that differ between two programs: drawings of both, then the instructions as a unified diff."""

from __future__ import annotations

from itertools import zip_longest
from typing import TYPE_CHECKING, Any, Final

from fatektool.report.ladder import HALF, DiffMark, ladder, not_drawn
from fatektool.report.markup import Html, table, tag
from fatektool.report.page import note, section

if TYPE_CHECKING:
    from collections.abc import Mapping, Sequence

    from fatektool.ladder.differences import NetworkChange
    from fatektool.ladder.networks import Network

MOST_DRAWN: Final = 200
_SIGNS: Final = {"-": "removed", "+": "added", " ": "unchanged"}


def changed_networks(
    networks: Sequence[Mapping[str, Any]],
    changes: Sequence[NetworkChange],
    comments: Mapping[str, str],
    sides: tuple[str, str],
) -> Html:
    """The networks that differ.

    Args:
        networks: of the document.
        changes: the same, for the drawings; empty for none.
        comments: of elements.
        sides: the names of the two programs.
    """
    said: list[Html] = []
    if changes:
        said.append(
            tag(
                "p",
                f"Instructions only in {sides[0]} have a dashed frame and a minus, those only in "
                f"{sides[1]} a frame and a plus.",
            )
        )
    if len(changes) > MOST_DRAWN:
        said.append(note(f"The first {MOST_DRAWN} networks are drawn; all are in the tables."))
    shown = [
        tag("section", _both(change, comments, sides) if change else "", _diff(network), class_="network")
        for network, change in zip_longest(networks, changes[:MOST_DRAWN])
    ]
    return section("Networks that differ", *said, *shown, id_="networks")


def _both(change: NetworkChange, comments: Mapping[str, str], sides: tuple[str, str]) -> Html:
    """A network before and after, side by side."""
    removed = dict.fromkeys(change.removed, DiffMark.REMOVED)
    added = dict.fromkeys(change.added, DiffMark.ADDED)
    pairs = ((change.a, sides[0], removed, "a"), (change.b, sides[1], added, "b"))
    return tag("div", *(_side(*pair, comments) for pair in pairs), class_="sides")


def _side(
    network: Network | None, side: str, marks: Mapping[int, DiffMark], key: str, comments: Mapping[str, str]
) -> Html:
    if network is None:
        return tag("div", tag("h3", f"Not in {side}"), class_="side")
    drawn = ladder(network, comments, f"{key}-{network.name.lower()}", HALF, marks)
    return tag("div", tag("h3", f"{network.name} in {side}"), drawn or not_drawn(network), class_="side")


def _diff(network: Mapping[str, Any]) -> Html:
    """A network's instructions as in a unified diff."""
    numbers = [f"N{network[side]:04}" for side in ("a", "b") if network[side] is not None]
    name = f"{' → '.join(dict.fromkeys(numbers))} {network['change']}"
    rows = [
        (_SIGNS[line[0]], tag("mark", tag("code", line[1:])) if line[0] != " " else tag("code", line[1:]))
        for line in network["lines"]
    ]
    return table(name, ("Change", "Instruction"), rows)
