"""Words -> instructions, and back. Total: any words are decoded, each into one instruction.

Unknown words, and instructions that the end of the code cuts off, are kept as words. The length of an unknown
function is not known either, so decoding continues at the next word that begins a network. Words of registers
can look like one (D200 is 9041, ORG Y144): it counts as a beginning if a valid instruction can follow.
"""

from __future__ import annotations

from functools import lru_cache
from typing import TYPE_CHECKING, Final

from fatektool.ladder.addresses import DRAWING, LAST_BIT, OUTPUTS, STORES
from fatektool.ladder.forms import Shape
from fatektool.ladder.instruction import Instruction, unknown
from fatektool.ladder.operands import value_of
from fatektool.ladder.table import FORMS

if TYPE_CHECKING:
    from collections.abc import Iterable, Sequence

    from fatektool.ladder.forms import Form

_LD: Final = 0x60
_RESET_AND_SET: Final = (0x00, 0x10)
_PREFIX: Final = 0xE0
_END: Final = 0xFFFF
_LABEL: Final = 0xEF
"""The low byte of a label; below are instructions of one word (with a prefix two), above are functions."""

_X: Final = range(0x100)
_LAST_LIKE_D: Final = 0x48
"""ORG of X, Y, T, C or S at an even address is D0 to D1023, too: ``9041`` is D200 and ORG Y144."""


def _index(head_words: int) -> list[tuple[tuple[int, ...], dict[tuple[int, ...], Form]]]:
    """The forms with heads of this number of words, by the mask and value of their fixed bits."""
    found: dict[tuple[int, ...], dict[tuple[int, ...], Form]] = {}
    for form in FORMS:
        if form.head_words == head_words:
            mask = tuple(0xFFFF ^ free for free in form.free)
            found.setdefault(mask, {})[form.fixed] = form
    return list(found.items())


_ONE: Final = [(mask, {fixed[0]: form for fixed, form in forms.items()}) for (mask,), forms in _index(1)]
_TWO: Final = _index(2)


def decode(words: Sequence[int]) -> tuple[Instruction, ...]:
    """Decode code.

    Args:
        words: 0 to 65535 each, from the beginning of a unit to its end.

    Returns:
        The instructions; their words in order are the words.
    """
    found = []
    place = 0
    while place < len(words):
        instruction = _instruction(words, place) or _unknown(words, place)
        found.append(instruction)
        place += len(instruction.words)
    return tuple(found)


def end_of(words: Sequence[int], place: int) -> int:
    """The end of a unit that begins here: at FFFF instead of an instruction, or at the end of the words."""
    while place < len(words) and words[place] != _END:
        instruction = _instruction(words, place)
        place += len(instruction.words) if instruction is not None else 1
    return min(place, len(words))


def encode(instructions: Iterable[Instruction]) -> tuple[int, ...]:
    """The words of instructions."""
    return tuple(word for instruction in instructions for word in instruction.words)


def form_at(words: Sequence[int], place: int) -> Form | None:
    """The form whose head is at this place; None if there is none."""
    first = words[place]
    for mask, forms in _ONE:
        form = forms.get(first & mask)
        if form is not None:
            return form
    if place + 1 < len(words):
        pair = first, words[place + 1]
        for masks, two in _TWO:
            form = two.get((pair[0] & masks[0], pair[1] & masks[1]))
            if form is not None:
                return form
    return None


@lru_cache(maxsize=8192)
def _of_one_word(word: int) -> Instruction | None:
    """A contact, coil or mark, the most frequent instructions; None for the head of a longer one."""
    for mask, forms in _ONE:
        form = forms.get(word & mask)
        if form is not None:
            return None if form.parts else Instruction(form, (word & form.free[0],), ())
    return None


def _instruction(words: Sequence[int], place: int) -> Instruction | None:
    """The instruction that begins here; None if no form is known, or the code ends before it does."""
    short = _of_one_word(words[place])
    if short is not None:
        return short if _has_an_address(short) else None
    form = form_at(words, place)
    if form is None or place + form.head_words + form.operand_words > len(words):
        return None
    free = tuple(words[place + number] & bits for number, bits in enumerate(form.free))
    place += form.head_words
    values = []
    for part in form.parts:
        values.append(value_of(words[place : place + part.words]))
        place += part.words
    instruction = Instruction(form, free, tuple(values))
    return instruction if _has_an_address(instruction) else None


def _has_an_address(instruction: Instruction) -> bool:
    """False for a contact with an invalid address: the last one, or an output of a function without LD."""
    bit = instruction.bit
    if bit is None or bit not in {LAST_BIT, *OUTPUTS}:
        return True
    return bit in OUTPUTS and instruction.form.fixed == (_LD,)


def _unknown(words: Sequence[int], place: int) -> Instruction:
    """An unknown instruction, with the words that may belong to it."""
    form = form_at(words, place)
    if form is not None:  # an address that is none, or cut short
        contact = form.shape is Shape.CONTACT
        return unknown(tuple(words[place : place + form.head_words] if contact else words[place:]))
    if words[place] & 0xFF < _LABEL:  # contacts, edges, marks: all that is known below labels and functions
        return unknown((words[place],))
    end = place + 1
    while end < len(words) and not _begins(words, end):
        end += 1
    return unknown(tuple(words[place:end]))


def _begins(words: Sequence[int], place: int) -> bool:
    """True if a network can begin here: a word that begins one, and a valid instruction after it."""
    first = _instruction(words, place)
    if first is None or not first.form.begins:
        return False
    if first.form.shape is not Shape.CONTACT or first.bit in DRAWING:
        return True
    after = place + len(first.words)
    if after == len(words):
        return False
    second = _instruction(words, after)
    if second is None:  # a function or mark that is not known; below stand registers, and FFFF is -1
        return words[after] & 0xFF >= _PREFIX and words[after] != _END
    return _can_follow(second, like_a_register=words[place] & 0x01FF < _LAST_LIKE_D)


def _can_follow(second: Instruction, *, like_a_register: bool) -> bool:
    """True if this can follow the contact that begins a network.

    Args:
        second: the instruction that the next words look like.
        like_a_register: True if the contact's word is a much used register, too: then OUTR and OUTS, which
            constants and registers look like, prove nothing.
    """
    bit = second.bit
    if second.form.begins or bit in OUTPUTS:
        return False
    if bit is None or second.form.head_words > 1:
        return True
    op = second.form.fixed[0]
    if op == _LD:
        return bit not in STORES  # nothing is kept there yet
    return not (second.form.writes and (bit in _X or (like_a_register and op in _RESET_AND_SET)))
