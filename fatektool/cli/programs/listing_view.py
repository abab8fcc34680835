"""A program for people: its instructions in lines, or its networks drawn."""

from __future__ import annotations

import shutil
import sys
from typing import TYPE_CHECKING, Final

from fatektool.cli.programs.differences import beside
from fatektool.project.comments import text_in

if TYPE_CHECKING:
    from collections.abc import Iterator, Mapping, Sequence

    from fatektool.ladder.drawing.text.pen import Pen
    from fatektool.ladder.networks import Network
    from fatektool.project.comments import Comments

_WIDEST: Final = 200


def listing_lines(networks: Sequence[Network], comments: Comments, *, words: bool) -> Iterator[str]:
    """The listing for people: a heading a network, a line an instruction."""
    for network in networks:
        yield from _heading(network, comments)
        yield from _instruction_lines(network, comments.elements, words=words)


def _heading(network: Network, comments: Comments) -> Iterator[str]:
    """A network's heading, after its unit's where that begins."""
    unit = text_in(network.addresses, comments.units)
    if unit:
        yield f"unit {unit}"
    yield f"{network.name}  {text_in(network.addresses, comments.networks) or ''}".rstrip()


def _instruction_lines(network: Network, comments: Mapping[str, str], *, words: bool) -> Iterator[str]:
    for number, _, instruction in network.places:
        if not instruction.text and not words:  # drawing that the vendor's program does not print
            continue
        shown = f"{' '.join(f'{each:04X}' for each in instruction.words):<19}  " if words else ""
        remark = beside(instruction.elements, comments)
        line = f"{instruction.text:<28}  {remark}" if remark else instruction.text
        yield f"  {number:04}  {shown}{line}".rstrip()


def ladder_lines(networks: Sequence[Network], comments: Comments) -> Iterator[str]:
    """The networks drawn, as wide as the terminal; what cannot be drawn as instructions, with the reason."""
    from fatektool.ladder.circuit.reading import NoCircuit, circuit_of
    from fatektool.ladder.drawing.text.draw import NARROWEST, draw
    from fatektool.ladder.drawing.text.letters import Letters
    from fatektool.ladder.drawing.text.pen import Pen

    columns = min(max(shutil.get_terminal_size().columns, NARROWEST), _WIDEST)
    pen = Pen(Letters(sys.stdout.encoding))
    for count, network in enumerate(networks):
        if count:
            yield ""
        for line in _heading(network, comments):
            yield from _fitted(line, columns, pen)
        circuit = circuit_of(network)
        if isinstance(circuit, NoCircuit):
            yield from _fitted(f"not drawn: {circuit.reason} (instruction {circuit.number:04})", columns, pen)
            for line in _instruction_lines(network, comments.elements, words=False):
                yield from _fitted(line, columns, pen)
        else:
            yield from draw(circuit, comments.elements, columns, pen)


def _fitted(line: str, columns: int, pen: Pen) -> Iterator[str]:
    """A line that is no drawing: as it is, or broken if it is too wide, the rest indented."""
    from fatektool.ladder.drawing.text.letters import width_of, wrapped

    spelt = pen.letters.spell(line)
    if width_of(spelt) <= columns:
        yield spelt
        return
    first, *more = wrapped(spelt, columns - 10)
    yield f"{' ' * (len(spelt) - len(spelt.lstrip()))}{first}"
    yield from (f"{' ' * 8}{each}" for each in more)
