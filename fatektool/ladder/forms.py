"""The forms of instructions: their words, and their text.

A form's head is one or two words, part of their bits fixed and the others free::

    contact      .... 84 ..     low byte: op, and four bits of the address;  high byte: the rest
    function     AC F.          high byte: which;  low nibble: constants and pulse;  then operand words
    extended     7F F. 22 0.    two words: which;  then operand words
    prefix       00 E0 .... 4.  an edge, and a contact
    label        xx EF          the first character;  then three words of text
"""

from __future__ import annotations

from dataclasses import dataclass
from enum import Enum, auto
from typing import TYPE_CHECKING

from fatektool.ladder.grades import Grade

if TYPE_CHECKING:
    from fatektool.ladder.operands import OperandForm


class Shape(Enum):
    """The kinds of forms."""

    CONTACT = auto()  # a contact or coil: the free bits of its last head word are a bit address
    MARK = auto()  # one word, the free bits define the drawing
    FUNCTION = auto()  # the free bits are the low nibble
    LABEL = auto()  # the free bits are a character
    UNKNOWN = auto()  # no form: the words as they are


@dataclass(frozen=True, slots=True)
class Form:
    """A row of the table: one instruction of the PLC.

    Attributes:
        shape: the kind of form.
        text: how it is printed: ``{0}`` the first operand's text, ``{bit}`` a contact's element, ``{P}`` the
            pulse form's mark; the other names are in ``printing``.
        fixed: the head's words with their free bits 0.
        free: the free bits of each of these words.
        parts: the operands, in the order of their words.
        grade: the certainty of the text.
        usual: the low nibbles, as hex digits, that were seen; others are of grade C.
        pulse: those of them that are the pulse form, of grade B.
        begins: True if a network begins with it.
        use: for contacts and coils: reads, or writes.
    """

    shape: Shape
    text: str
    fixed: tuple[int, ...]
    free: tuple[int, ...]
    parts: tuple[OperandForm, ...] = ()
    grade: Grade = Grade.A
    usual: str = "4567"
    pulse: str = ""
    begins: bool = False
    writes: bool = False

    @property
    def head_words(self) -> int:
        """Words before the operands."""
        return len(self.fixed)

    @property
    def operand_words(self) -> int:
        """Words after the head."""
        return sum(part.words for part in self.parts)


UNKNOWN = Form(Shape.UNKNOWN, "??", (), (), grade=Grade.C)
"""The form of unknown instructions: their words are kept."""
