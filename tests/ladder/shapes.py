"""A circuit as a short text: what is beside what, without the way in which a contact is written.

``(X0|Y4) !X1 [Y4]`` is OR of two contacts, one that is inverted behind it, and a coil.
"""

from __future__ import annotations

from fatektool.ladder.circuit.nodes import Block, Box, Circuit, Leaf, Line, Parallel, Part, Series
from fatektool.ladder.circuit.roles import PLACES, Role


def shape(circuit: Circuit) -> str:
    return " / ".join(map(_line, circuit.lines))


def _line(line: Line) -> str:
    return " ".join(map(_part, line.parts))


def _part(part: Part) -> str:
    match part:
        case Leaf():
            return _leaf(part)
        case Series(parts):
            return f"<{' '.join(map(_part, parts))}>"
        case Parallel(branches):
            return f"({'|'.join(map(_part, branches))})"
        case Block(body, join):
            return f"{_part(body)}" if join.role is Role.OR_BLOCK else f"&{_part(body)}"
        case Box(function, inputs, outputs):
            lines = "; ".join(map(_line, inputs)), "; ".join(map(_line, outputs))
            return f"{{{lines[0]} > {function.instruction.text.removeprefix('~')} > {lines[1]}}}"


def _leaf(leaf: Leaf) -> str:
    text = leaf.instruction.text.removeprefix("~")
    if leaf.role in PLACES:
        what = text.partition(" ")[2]
        return what.replace("NOT ", "!").replace("TU ", "^").replace("TD ", "v")
    if leaf.role is Role.COIL:
        name, _, element = text.rpartition(" ")
        return f"[{element}]" if name == "OUT" else f"[{name} {element}]"
    return text
