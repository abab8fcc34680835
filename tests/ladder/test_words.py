"""Any words come back from their instructions, and any instruction of the table from its words."""

from __future__ import annotations

import random
from typing import TYPE_CHECKING

from hypothesis import given
from hypothesis import strategies as st

from fatektool.ladder.addresses import (
    DRAWING,
    LAST_BIT,
    OUTPUTS,
    bit_address,
    bit_name,
    register_address,
    register_name,
    spans_of,
)
from fatektool.ladder.decode import decode, encode
from fatektool.ladder.forms import Shape
from fatektool.ladder.instruction import Instruction
from fatektool.ladder.networks import Code
from fatektool.ladder.table import FORMS
from tests.ladder.vectors import PRINTED, READ

if TYPE_CHECKING:
    from fatektool.ladder.forms import Form

WORDS = st.integers(0, 0xFFFF)
PIECES = st.sampled_from([vector.words for vector in (*PRINTED, *READ)]) | st.tuples(WORDS)
PROGRAMS = st.lists(PIECES).map(lambda pieces: sum(pieces, ()))


@st.composite
def instructions(draw: st.DrawFn) -> Instruction:
    form: Form = draw(st.sampled_from(FORMS))
    free = tuple(draw(WORDS) & bits for bits in form.free)
    values = tuple(draw(st.integers(0, (1 << 16 * part.words) - 1)) for part in form.parts)
    found = Instruction(form, free, values)
    if found.bit is not None and (found.bit == LAST_BIT or found.bit in OUTPUTS):
        return Instruction(form, (*free[:-1], 0), values)
    return found


@given(st.lists(instructions(), max_size=30))
def test_instructions_come_back(given_: list[Instruction]) -> None:
    assert decode(encode(given_)) == tuple(given_)


@given(st.lists(WORDS) | PROGRAMS)
def test_words_come_back(words: tuple[int, ...] | list[int]) -> None:
    found = decode(words)
    assert encode(found) == tuple(words)
    for instruction in found:
        assert instruction.words
        assert instruction.text.isprintable()
        assert instruction.known == (not instruction.text.startswith("??"))
        assert instruction.text or instruction.is_drawing
        for access in instruction.accesses:
            assert access.reads or access.writes
            assert spans_of(access.element), access


@given(PROGRAMS, PROGRAMS)
def test_networks_hold_every_word(main: tuple[int, ...], sub: tuple[int, ...]) -> None:
    code = Code.of(main, sub)
    assert code.words == main + sub
    assert tuple(word for network in code.networks for word in network.words) == code.words
    numbers = iter(range(len(code.instructions)))
    place = 0
    for number, network in enumerate(code.networks):
        assert network.number == number
        assert network.unit == (network.word >= len(main))
        for instruction_number, word, instruction in network.places:
            assert (instruction_number, word) == (next(numbers), place)
            assert not (instruction.form.begins and instruction_number > network.first)
            place += len(instruction.words)
    assert next(numbers, None) is None


def test_a_whole_memory_of_noise() -> None:
    noise = random.Random(20480)  # noqa: S311  # a fixed seed
    words = tuple(noise.randrange(0x10000) for _ in range(20480))
    code = Code.of(words)
    assert encode(code.instructions) == words
    assert len([text for text in (found.text for found in code.instructions) if text.startswith("??")]) > 1000


def test_a_whole_memory_of_one_unknown_function() -> None:
    words = (0x3FF4, *[0x9041] * 20479)  # each of them looks like the beginning of a network
    assert encode(Code.of(words).instructions) == words


def test_bits_by_name() -> None:
    named = {address: bit_name(address) for address in range(LAST_BIT + 1)}
    for address, name in named.items():
        if name is None:
            assert address in DRAWING or address in OUTPUTS or address == LAST_BIT
        else:
            assert bit_address(name.text) == address
    ends = {
        0x000: "X0",
        0x0FF: "X255",
        0x427: "TR 39",
        0x428: "S0",
        0x80F: "S999",
        0x810: "M0",
        0xFE1: "M2001",
    }
    for address, text in ends.items():
        name = named[address]
        assert name is not None
        assert name.text == text


def test_registers_by_name() -> None:
    for address in range(0x10000):
        name = register_name(address)
        if name.element is not None:
            assert register_address(name.element) == address
    ends = {
        0x0100: "R3840",
        0x038E: "R4167",
        0x058E: "T255",
        0x071E: "C199",
        0x0720: "C200",
        0x07FC: "C255",
        0x0902: "WM0",
        0x09FC: "WM2000",
        0x27FE: "R3839",
        0x2800: "R5000",
        0x3FFE: "R8071",
        0x5FFE: "D4095",
        0x700F: "P15",
        0x7581: "D0[P8+P1]?",
        0x8A00: "R0V",
        0x0000: "@0000",
        0x0A01: "@0A01",
        0x6000: "@6000",
        0xF000: "@F000",
        0xFFFF: "@FFFF",
    }
    assert {address: register_name(address).text for address in ends} == ends


def test_spans() -> None:
    assert not spans_of("R12")[0].meets(spans_of("R13")[0])
    assert spans_of("DR12")[0].meets(spans_of("R13")[0])
    assert spans_of("WM8")[0].meets(spans_of("M23")[0])
    assert not spans_of("WM8")[0].meets(spans_of("M24")[0])
    assert spans_of("DWM8")[0].meets(spans_of("M39")[0])
    assert len(spans_of("T5")) == 2
    assert spans_of("RT5") == spans_of("T5")[1:]
    assert spans_of("D7")[0].meets(spans_of("DD6")[0])
    for nothing in ("", "Q1", "R", "X256", "R9999", "WT0", "TR0", "F12"):
        assert spans_of(nothing) == (), nothing


def test_networks_begin() -> None:
    begins = {form.text.split()[0] for form in FORMS if form.begins}
    assert begins == {"ORG", "ORGF", "FUN", "STP", "FROM", "STPEND"}  # FUN 65 is the label
    assert [form.text for form in FORMS if form.begins and form.shape is Shape.LABEL]
