"""``listing``: a program's instructions in tables, a network each."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

from fatektool.report.markup import Html, counted, figure, table, tag
from fatektool.report.page import Report, Verdict, code, note, render, section

if TYPE_CHECKING:
    from collections.abc import Iterator, Mapping

_SAID = {
    "A": "",
    "B": "read from use, not the vendor's own word",
    "C": "a guess that fits, not the vendor's own word",
}


def listing_report(document: Mapping[str, Any], *, time: str) -> str:
    """A listing as a page.

    Args:
        document: ``fatektool.listing/1``.
        time: the present, UTC, RFC 3339.
    """
    header = document["header"]
    networks = document["networks"]
    instructions = sum(len(network["instructions"]) for network in networks)
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
            [_legend(), *_networks(document)],
            document["schema"],
            time,
        )
    )


def _legend() -> Html:
    return section(
        "How to read it",
        note(
            "The text is as the vendor's program prints it. What has ~ before it is not its own word: it was "
            "read from use. What has ?? before it is not known: its words are shown in hex."
        ),
    )


def _networks(document: Mapping[str, Any]) -> Iterator[Html]:
    comments = document["comments"]
    for network in document["networks"]:
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
            table(f"Network {name}", ("Number", "Instruction", "Comments", "Evidence"), rows, numeric=(0,)),
            id_=name.lower(),
        )
