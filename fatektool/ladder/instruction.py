"""One instruction: its form, the form's free bits, and its operands.

Two instructions are equal if their words are equal. Its text and properties are computed from the form when
they are needed.
"""

from __future__ import annotations

from dataclasses import dataclass
from functools import cached_property
from typing import TYPE_CHECKING, NamedTuple

from fatektool.ladder.addresses import DRAWING, OUTPUTS, Span, bit_name, bit_span, drawing_grade
from fatektool.ladder.forms import UNKNOWN, Form, Shape
from fatektool.ladder.grades import Grade, worst
from fatektool.ladder.operands import Operand, operand, words_of
from fatektool.ladder.printing import print_function

if TYPE_CHECKING:
    from collections.abc import Iterator


class Access(NamedTuple):
    """The access of an instruction to an element.

    Attributes:
        element: its name.
        spans: the memory.
        reads: it depends on it.
        writes: it may change it.
        goes_on: an unknown number of registers after it belong to it too.
    """

    element: str
    spans: tuple[Span, ...]
    reads: bool
    writes: bool
    goes_on: bool


@dataclass(frozen=True)
class Instruction:
    """An instruction.

    Attributes:
        form: the row of the table; ``UNKNOWN`` if there is none.
        free: the free bits of each head word.
        values: each operand's value; of an unknown instruction its words.
    """

    form: Form
    free: tuple[int, ...]
    values: tuple[int, ...]

    @property
    def known(self) -> bool:
        """False for unknown words."""
        return self.form is not UNKNOWN

    @cached_property
    def words(self) -> tuple[int, ...]:
        """Its words, in the order of the code."""
        if not self.known:
            return self.values
        head = tuple(fixed | free for fixed, free in zip(self.form.fixed, self.free, strict=True))
        after = (
            words_of(value, part.words) for part, value in zip(self.form.parts, self.values, strict=True)
        )
        return sum(after, head)

    @property
    def bit(self) -> int | None:
        """The bit address of a contact or coil; None for other instructions."""
        if self.form.shape is not Shape.CONTACT:
            return None
        free = self.free[-1]
        return (free & 0x0F) << 8 | free >> 8

    @property
    def is_drawing(self) -> bool:
        """True for a wire or a gap, and for instructions only for the drawing."""
        return self.form.text == "" or (self.bit is not None and self.bit in DRAWING)

    @cached_property
    def operands(self) -> tuple[Operand, ...]:
        """The operands of a function, named."""
        if not self.known:
            return ()
        nibble = self.free[0] & 0x0F
        return tuple(
            operand(part, value, nibble) for part, value in zip(self.form.parts, self.values, strict=True)
        )

    @cached_property
    def grade(self) -> Grade:
        """The certainty of its text."""
        return worst((self.form.grade, self._head_grade(), *(part.grade for part in self.operands)))

    @cached_property
    def text(self) -> str:
        """The text as the vendor prints it, one space between parts; ``~`` before other names.

        ``?? 1AF5 2814`` for unknown words; empty for drawing that the vendor's software does not print.
        """
        if not self.known:
            return " ".join(["??", *(f"{word:04X}" for word in self.words)])
        plain = (
            self._contact()
            if self.bit is not None
            else print_function(self.form, self.free[0], self.operands)
        )
        return plain if self.grade is Grade.A else f"~{plain}"

    @property
    def accesses(self) -> Iterator[Access]:
        """The elements that it reads and writes."""
        if self.bit is not None:
            name = bit_name(self.bit)
            if name is not None and name.element is not None:
                writes = self.form.writes
                yield Access(name.element, (bit_span(self.bit),), not writes, writes, goes_on=False)
        for found in self.operands:
            use = found.part.use
            if found.element is not None:
                yield Access(found.element, found.spans, use.reads, use.writes, use.goes_on)

    @cached_property
    def elements(self) -> tuple[str, ...]:
        """Its elements, each once, in the order of their words."""
        return tuple(dict.fromkeys(access.element for access in self.accesses))

    def _contact(self) -> str:
        assert self.bit is not None  # noqa: S101  # the caller's condition
        name = self.form.text
        if self.bit in DRAWING:
            what = "OPEN" if " NOT" in name or " TD" in name else "SHORT"
            return name.replace(" NOT", "").format(bit=what)
        if self.bit in OUTPUTS:
            return f"FO {self.bit - OUTPUTS.start}"
        found = bit_name(self.bit)
        return name.format(bit=found.text if found else f"@{self.bit:03X}")

    def _head_grade(self) -> Grade:
        if self.bit is not None:
            if self.bit in DRAWING:
                return max(drawing_grade(self.bit), Grade.A if len(self.free) == 1 else Grade.C)
            return Grade.A
        if self.form.shape is not Shape.FUNCTION:
            return Grade.A
        nibble = f"{self.form.fixed[0] & 0x0F | self.free[0]:X}"
        if nibble in self.form.pulse:
            return Grade.B
        return Grade.A if nibble in self.form.usual else Grade.C


def unknown(words: tuple[int, ...]) -> Instruction:
    """An instruction of unknown words."""
    return Instruction(UNKNOWN, (), words)
