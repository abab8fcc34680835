"""How an instruction looks, whatever it is drawn with: its sign or box, and what is written at it."""

from __future__ import annotations

from dataclasses import dataclass
from enum import Enum, auto
from typing import TYPE_CHECKING, Final

from fatektool.ladder.addresses import bit_name
from fatektool.ladder.circuit.pins import pins_of
from fatektool.ladder.circuit.roles import Role
from fatektool.ladder.forms import Shape
from fatektool.ladder.grades import Grade
from fatektool.ladder.printing import function_words

if TYPE_CHECKING:
    from fatektool.ladder.circuit.nodes import Leaf


class Look(Enum):
    """The kinds of signs."""

    CONTACT = auto()  # ─┤ ├─
    COIL = auto()  # ─( )─
    STEP = auto()  # ─[ ]─
    LINE = auto()  # an edge of the line, or what turns it round
    GAP = auto()  # nothing conducts


@dataclass(frozen=True, slots=True)
class Sign:
    """A sign of one column.

    Attributes:
        look: what it is.
        name: what stands above it.
        inside: what stands in it: empty, ``/``, ``TU``, ``TD``, ``S``, ``R``, ``C1>=R1400``.
        elements: those whose comments stand under it.
    """

    look: Look
    name: str
    inside: str
    elements: tuple[str, ...] = ()


@dataclass(frozen=True, slots=True)
class Setting:
    """An operand in a box.

    Attributes:
        text: as it is printed: ``SR:R1300``.
        elements: those in it.
    """

    text: str
    elements: tuple[str, ...] = ()


@dataclass(frozen=True, slots=True)
class Frame:
    """A function as a box.

    Attributes:
        title: its name.
        settings: its operands.
        inputs: the names of its inputs, as far as they are known.
        outputs: those of its outputs.
    """

    title: str
    settings: tuple[Setting, ...]
    inputs: tuple[str, ...]
    outputs: tuple[str, ...]

    def input_name(self, number: int) -> str:
        """The name of an input, from 0; empty if it is not known."""
        return self.inputs[number] if number < len(self.inputs) else ""

    def output_name(self, number: int) -> str:
        """The name of an output, from 0: that of the vendor, or FO and the number."""
        return self.outputs[number] if number < len(self.outputs) else f"FO {number}"


_COILS: Final = {"OUT": "", "OUT NOT": "/", "OUTS": "S", "OUTR": "R"}


def sign_of(leaf: Leaf) -> Sign:
    """The sign of what is no function."""
    text, sure = leaf.instruction.text.removeprefix("~"), _mark(leaf)
    bit = leaf.instruction.bit
    if leaf.is_gap:
        return Sign(Look.GAP, "", "")
    if bit is None:
        return _of_words(leaf, text, sure)
    name = bit_name(bit)
    shown = sure + (name.text if name else f"@{bit:03X}")
    elements = leaf.instruction.elements
    if leaf.role in {Role.COIL, Role.STORE}:
        return Sign(Look.COIL, shown, _COILS[leaf.instruction.form.text.removesuffix(" {bit}")], elements)
    return Sign(Look.CONTACT, shown, "/" if leaf.is_inverted else leaf.edge, elements)


def _of_words(leaf: Leaf, text: str, sure: str) -> Sign:
    """A sign of what has operands, or nothing at all."""
    elements = leaf.instruction.elements
    match leaf.role:
        case Role.COIL:  # SET, RST, TO
            kind, _, element = text.rpartition(" ")
            inside = {"SET": "S", "RST": "R", "TO": "TO"}[kind[:3].rstrip("(")]
            return Sign(Look.COIL, sure + element, inside + ("P" if "(P)" in kind else ""), elements)
        case Role.STEP:
            kind, _, element = text.partition(" ")
            return Sign(Look.STEP, sure + element, kind, elements)
        case Role.LINE:
            return Sign(Look.LINE, sure + text, "/" if text == "INV" else text)
    words = text.split(" ")  # ANDF 171 > Sa:R6 Sb:0
    first, second = words[-2].removeprefix("Sa:"), words[-1].removeprefix("Sb:")
    return Sign(Look.CONTACT, f"{sure}{words[1]}", f"{first}{words[2]}{second}", elements)


def frame_of(leaf: Leaf) -> Frame:
    """The box of a function."""
    instruction = leaf.instruction
    pins = pins_of(instruction.form)
    title: list[str] = []
    settings: list[Setting] = []
    for text, operands in function_words(instruction.form, instruction.free[0], instruction.operands):
        if instruction.form.shape is Shape.LABEL or not (operands or ":" in text) or not title:
            title.append(text)  # of a timer its own name comes first: T30 .01 R8
        else:
            settings.append(
                Setting(text, tuple(each.element for each in operands if each.element is not None))
            )
    return Frame(
        _mark(leaf) + " ".join(title),
        tuple(settings),
        pins.inputs if pins else (),
        pins.outputs if pins else (),
    )


def _mark(leaf: Leaf) -> str:
    """What stands before that which is not the vendor's own word."""
    return "" if leaf.instruction.grade is Grade.A else "~"
