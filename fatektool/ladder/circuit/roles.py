"""The roles of instructions in a circuit, and the forms of a contact at each place.

A contact or comparison has one of four forms, by its place; the rest is the same::

    ORG X0    LD X0    AND X0    OR X0            ORGF 171 > ..    LDF ..    ANDF ..    ORF ..
"""

from __future__ import annotations

from enum import Enum, auto
from typing import TYPE_CHECKING, Final

from fatektool.ladder.addresses import DRAWING, OUTPUTS, STORES
from fatektool.ladder.forms import Form, Shape
from fatektool.ladder.instruction import Instruction
from fatektool.ladder.table import FORMS

if TYPE_CHECKING:
    from collections.abc import Mapping


class Role(Enum):
    """The role of an instruction."""

    ORG = auto()  # begins a network with a contact
    LD = auto()  # begins a block with a contact
    AND = auto()  # a contact in series
    OR = auto()  # a contact in parallel
    AND_BLOCK = auto()  # ANDLD: the last block in series with the one before
    OR_BLOCK = auto()  # ORLD: in parallel
    LINE = auto()  # TU, TD, INV of the state of the line so far
    STORE = auto()  # OUT TR n
    RECALL = auto()  # LD TR n
    OUTPUT = auto()  # FO n: an output of the function before begins a line
    STEP = auto()  # STP, FROM: a step begins a line
    COIL = auto()  # has the state of the line, which continues
    FUNCTION = auto()  # has one input line or several
    ALONE = auto()  # no line leads to it
    END = auto()  # alone, or at the end of a line
    MARK = auto()  # drawing that the vendor's software does not print
    UNKNOWN = auto()
    ODD = auto()  # words that can be decoded, but occur in no known program


PLACES: Final = (Role.ORG, Role.LD, Role.AND, Role.OR)
_MARKS: Final = {"ANDLD": Role.AND_BLOCK, "ORLD": Role.OR_BLOCK, "": Role.MARK}
_FUNCTIONS: Final = {
    "SET{brackets} {0}": Role.COIL,
    "RST{brackets} {0}": Role.COIL,
    "TO {0}": Role.COIL,
    "STP {0}": Role.STEP,
    "FROM {0}": Role.STEP,
    "STPEND": Role.ALONE,
    "END": Role.END,
    "FUN 68 RTS": Role.ALONE,
}


def role_of(instruction: Instruction) -> Role:
    """The role of an instruction in a circuit."""
    form = instruction.form
    bit = instruction.bit
    if bit is not None:
        return _contact_role(form, bit)
    place = _PLACE_OF.get(form)
    if place is not None:
        return place
    match form.shape:
        case Shape.UNKNOWN:
            return Role.UNKNOWN
        case Shape.MARK:
            return _MARKS.get(form.text, Role.LINE)
        case Shape.LABEL:
            return Role.ALONE
    return _FUNCTIONS.get(form.text, Role.FUNCTION)


def placed(instruction: Instruction, place: Role) -> Instruction:
    """A contact or comparison in the form for another place.

    Args:
        instruction: the contact or comparison.
        place: one of ``PLACES``.
    """
    form = _AT[_WHAT[instruction.form], place]
    return Instruction(form, instruction.free, instruction.values)


def _contact_role(form: Form, bit: int) -> Role:
    if bit in OUTPUTS:
        return Role.OUTPUT
    if bit in STORES:
        return {"OUT {bit}": Role.STORE, "LD {bit}": Role.RECALL}.get(form.text, Role.ODD)
    if bit in DRAWING and (form.writes or form.head_words > 1):
        return Role.ODD
    return Role.COIL if form.writes else _PLACE_OF[form]


def _by_place() -> Mapping[Form, tuple[str, Role]]:
    """Each form of a contact or comparison: its name without the place, and the place."""
    found = {}
    for form in FORMS:
        place, _, what = form.text.partition(" ")
        if form.shape is Shape.CONTACT and not form.writes:
            found[form] = (what, Role[place])
        elif form.text.startswith(("ORGF ", "LDF ", "ANDF ", "ORF ")):
            found[form] = (f"F {what}", Role[place.removesuffix("F")])
    return found


_FORMS: Final = _by_place()
_WHAT: Final = {form: what for form, (what, _) in _FORMS.items()}
_PLACE_OF: Final = {form: place for form, (_, place) in _FORMS.items()}
_AT: Final = {found: form for form, found in _FORMS.items()}
