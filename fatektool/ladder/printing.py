"""The text of a function: that of its form, with its operands and the meaning of the low nibble."""

from __future__ import annotations

import re
from dataclasses import replace
from typing import TYPE_CHECKING, Final

from fatektool.ladder.forms import Form, Shape
from fatektool.ladder.operands import character

if TYPE_CHECKING:
    from collections.abc import Iterator, Sequence

    from fatektool.ladder.operands import Operand

_KEY: Final = 0x55
_OPERAND: Final = re.compile(r"\{([0-9]+)")


def print_function(form: Form, free: int, operands: Sequence[Operand]) -> str:
    """The text of a function, a mark or a label.

    Args:
        form: its row.
        free: the free bits of its first word.
        operands: its operands, with their text.
    """
    return " ".join(text for text, _ in function_words(form, free, operands))


def function_words(
    form: Form, free: int, operands: Sequence[Operand]
) -> Iterator[tuple[str, tuple[Operand, ...]]]:
    """The same, word by word, each with the operands in it.

    Args:
        form: its row.
        free: the free bits of its first word.
        operands: its operands, with their text.
    """
    nibble = (form.fixed[0] | free) & 0x0F if form.shape is Shape.FUNCTION else 0
    pulse = f"{nibble:X}" in form.pulse
    shown = _with_key_in_hex(operands)
    for word in form.text.split(" "):
        text = word.format(
            *shown,
            P="P" if pulse else "",
            D="D" if nibble & 2 else "",
            brackets=_brackets(operands, pulse=pulse),
            one=nibble & 1,
            two=nibble & 3,
            three=nibble & 7,
            char=character(free >> 8) if free >> 8 else "",
        )
        yield text, tuple(shown[int(number)] for number in _OPERAND.findall(word))


def _brackets(operands: Sequence[Operand], *, pulse: bool) -> str:
    """Brackets of SET and RST. In the notes, a word of discretes (WY0) has none, T and C have them (A)."""
    if operands and operands[0].text.startswith("W"):
        return ""
    return "(P)" if pulse else "( )"


def _with_key_in_hex(operands: Sequence[Operand]) -> Sequence[Operand]:
    """``S:5501H D:R4055``: that register takes a key of 55H and a number, in a byte each (notes)."""
    match operands:
        case [constant, target] if (
            target.element == "R4055" and constant.element is None and constant.high == _KEY
        ):
            return [replace(constant, text=f"{constant.value:04X}H"), target]
    return operands
