"""``xref``: where each element is read and written."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

import click

from fatektool.cli.programs.documents import xref_document
from fatektool.cli.programs.program_files import comments_beside, comments_options, program_file, warn_of_code
from fatektool.cli.shared.inventory_file import inventory_option
from fatektool.cli.shared.options import PATH, completing, voice_options
from fatektool.errors import UsageError
from fatektool.ladder.addresses import spans_of
from fatektool.ladder.cross_reference import CrossReference, FindingKind

if TYPE_CHECKING:
    from collections.abc import Iterator, Mapping, Sequence
    from pathlib import Path

    from fatektool.cli.shared.output import Voice
    from fatektool.ladder.cross_reference import InstructionPlace, XrefFinding
    from fatektool.ladder.networks import Code

_SAID = {
    FindingKind.DOUBLE_COIL: "has an OUT in several places: the last one wins",
    FindingKind.NEVER_READ: "is written and never read",
    FindingKind.NEVER_WRITTEN: "is read and never written",
}
_PLACES_SHOWN = 12


@click.command("xref", epilog="Example: fatektool xref press.pdw X0 Y0")
@click.argument("file", type=PATH)
@click.argument("elements", nargs=-1, shell_complete=completing("complete_elements"))
@comments_options
@inventory_option
@voice_options
def xref_command(
    file: Path,
    voice: Voice,
    *,
    elements: tuple[str, ...],
    comments: Path | None,
    encoding: str | None,
    inventory: Path | None,
) -> None:
    """Show where each of ELEMENTS is read and written in the program FILE, or each element. Needs no PLC.

    Also listed are elements with OUT in two places, elements that are written and never read, and elements
    that are read and never written. Elements that the PLC itself or a display uses can be among them.
    """
    asked = [element.upper() for element in elements]
    for element in asked:
        if not spans_of(element):
            raise UsageError(f"no element {element!r} of a program: expected such as M421, R100, WM8, T5")
    found = program_file(file, voice, encoding)
    texts = comments_beside(found, comments, inventory, voice, encoding).elements
    code = found.require_code()
    warn_of_code(found, voice)
    reference = CrossReference(code)
    shown = asked or reference.elements
    findings = [each for each in reference.findings() if not asked or each.element in asked]
    document = xref_document(found, reference, shown, findings, texts)
    voice.show(document, _lines(code, document["elements"], findings))


def _lines(code: Code, elements: Mapping[str, Any], findings: Sequence[XrefFinding]) -> Iterator[str]:
    texts = [instruction.text for instruction in code.instructions]
    for element, uses in elements.items():
        yield f"{element}  {uses['comment'] or ''}".rstrip()
        for name in ("writes", "reads"):
            for place in uses[name]:
                number = place["instruction"]
                yield f"  {name:<6}  N{place['network']:04}  {number:04}  {texts[number]}"
        if not uses["reads"] and not uses["writes"]:
            yield "  not in the program"
    if findings:
        yield ""
    for each in findings:
        yield f"{each.element} {_SAID[each.kind]}: {_networks(each.where)}"


def _networks(where: Sequence[InstructionPlace]) -> str:
    numbers = list(dict.fromkeys(place.network for place in where))
    more = len(numbers) - _PLACES_SHOWN
    shown = ", ".join(f"N{number:04}" for number in numbers[:_PLACES_SHOWN])
    return f"{shown}, {more} more" if more > 0 else shown
