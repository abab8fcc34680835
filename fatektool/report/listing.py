"""``listing``: a program's networks, each drawn and as a table of its instructions."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

from fatektool.counts import counted
from fatektool.report.ladder import ladder, not_drawn
from fatektool.report.markup import Html, figure, table, tag
from fatektool.report.page import Report, Verdict, code, note, render, section

if TYPE_CHECKING:
    from collections.abc import Iterator, Mapping, Sequence

    from fatektool.ladder.networks import Network

_SAID = {
    "A": "",
    "B": "found from its use, not the vendor's name",
    "C": "assumed, not the vendor's name",
}


def listing_report(document: Mapping[str, Any], networks: Sequence[Network], *, time: str) -> str:
    """A listing as a page.

    Args:
        document: ``fatektool.listing/1``.
        networks: the same networks, for the drawings.
        time: the present, UTC, RFC 3339.
    """
    header = document["header"]
    instructions = sum(len(network.instructions) for network in networks)
    unknown = document["unknown_words"]
    said = f"{counted(instructions, 'instruction')} in {counted(len(networks), 'network')}."
    left = (
        f"{counted(unknown, 'word')} of the program not understood."
        if unknown
        else "Every word is understood."
    )
    facts = [
        ("File", code(document["file"])),
        ("Header", header["signature"] or "unknown"),
        ("Networks", figure(len(networks))),
        ("Instructions", figure(instructions)),
        ("Words not understood", figure(unknown)),
    ]
    return render(
        Report(
            "Program listing",
            document["file"],
            Verdict("Listed", f"{said} {left}"),
            facts,
            [_legend(), *_networks(document, networks)],
            document["schema"],
            time,
        )
    )


def _legend() -> Html:
    return section(
        "How to read it",
        note(
            "The text is as the vendor's software prints it. A name with ~ is not the vendor's: it was found "
            "from its use. ?? marks code that is not known: its words are shown in hex."
        ),
    )


def _networks(document: Mapping[str, Any], networks: Sequence[Network]) -> Iterator[Html]:
    comments = document["comments"]
    for network, drawn in zip(document["networks"], networks, strict=True):
        name = f"N{network['number']:04}"
        rows = [
            (
                figure(found["number"], f"{found['number']:04}"),
                tag("code", found["text"]),
                ", ".join(f"{each}: {comments[each]}" for each in found["elements"] if each in comments),
                _SAID[found["grade"]] if found["known"] else "not known",
            )
            for found in network["instructions"]
            if found["text"]
        ]
        yield section(
            name,
            tag("p", network["comment"]) if network["comment"] else "",
            *_drawn(drawn, comments, rows),
            id_=name.lower(),
        )


def _drawn(
    network: Network, comments: Mapping[str, str], rows: Sequence[Sequence[object]]
) -> tuple[Html, Html]:
    """A network's ladder and its instructions, folded; if it cannot be drawn, the reason and the table."""
    listed = table(
        f"Network {network.name}", ("Number", "Instruction", "Comments", "Evidence"), rows, numeric=(0,)
    )
    shown = ladder(network, comments, f"ladder-{network.name.lower()}")
    if shown is None:
        return not_drawn(network), listed
    return shown, tag("details", tag("summary", f"Instructions of {network.name}"), listed)
