"""Random ladder code of an FBs, in words of 16 bits, the same for the same seed.

::

    network   ORG .. AND .. OUT                      contacts in a row, a coil
              ORG .. LD .. ORLD .. OUT               two branches
              ORG .. SET / RST                       a state
              ORG TU .. FUN 08 MOV, FUN 15 (+1)      once a rising edge
              ORG .. T30 preset .. FO 0 OUT          a timer and its output

One-word instructions have an operation and four bits of the address in their low byte, the other eight in the
high byte; functions have their code in the high byte, and operands after it. No paper describes this code: it
was found in example programs of the vendor, and only what is certain is used here (docs/programs.md).
"""

from __future__ import annotations

from typing import TYPE_CHECKING

if TYPE_CHECKING:
    from random import Random

OUT, ORG, ORG_NOT, AND, AND_NOT, OR, LD = 0xC, 0x4, 0x5, 0x8, 0x9, 0xA, 0x6
"""Operations of one-word instructions: the high half of the low byte."""

TU, ORLD, ANDLD = 0x00E0, 0x00E4, 0x00E2
FO_0 = 0xFC6F
MOV, INCREMENT, SET, RESET, TIMER = 0xAC, 0x96, 0x82, 0xC4, 0x80
_X, _Y, _S, _M = 0x000, 0x100, 0x428, 0x810
_CONSTANT, _PLAIN, _MOVE_CONSTANT, _MOVE = 0xFD, 0xFC, 0xF5, 0xF4
"""Low bytes of functions: bit 0 means that the first operand is a constant."""
_TIMERS = range(30, 50)


def one_word(operation: int, bit: int) -> int:
    """An instruction with the bit at this address, 0 to FFF: X0 is 000, Y0 100, S0 428, M0 810."""
    return (bit & 0xFF) << 8 | operation << 4 | bit >> 8


def operand(value: int) -> int:
    """A register's byte address or a constant after a function: with its bytes swapped."""
    return (value & 0xFF) << 8 | value >> 8


def register(number: int) -> int:
    """R ``number`` as an operand."""
    return operand(0x0A00 + 2 * number)


def function(code: int, low: int, *operands: int) -> list[int]:
    """A function and its operands."""
    return [code << 8 | low, *operands]


def random_code(random: Random, words: int) -> list[int]:
    """Networks of ``words`` words in total."""
    code: list[int] = []
    while len(code) < words:
        network = _network(random)
        left = words - len(code)
        if len(network) > left:
            network = [one_word(ORG, _contact(random)), one_word(OUT, _coil(random))] * (left // 2)
            network += [one_word(ORG, _contact(random))] * (left % 2)
        code += network
    return code


def _network(random: Random) -> list[int]:
    kind = random.randrange(5)
    start = [one_word(random.choice((ORG, ORG_NOT)), _contact(random))]
    row = [one_word(random.choice((AND, AND_NOT, OR)), _contact(random)) for _ in range(random.randrange(5))]
    coil = one_word(OUT, _coil(random))
    if kind == 1:
        branch = [one_word(LD, _contact(random)), one_word(AND, _contact(random))]
        return [*start, *row, *branch, random.choice((ORLD, ANDLD)), coil]
    if kind == 2:
        state = operand(_S + random.randrange(100))
        return [*start, *row, *function(random.choice((SET, RESET)), _PLAIN, state)]
    if kind == 3:
        target = register(random.randrange(3800))
        constant = operand(random.randrange(1000))
        move = function(MOV, _MOVE_CONSTANT, constant, target)
        return [TU, *start, *row, *move, *function(INCREMENT, _MOVE, target)]
    if kind == 4:
        timer = random.choice(_TIMERS)
        preset, place = operand(10 * random.randrange(1, 100)), operand(0x0390 + 2 * timer)
        return [*start, *row, *function(TIMER, _CONSTANT, preset, place), FO_0, coil]
    return [*start, *row, coil]


def _contact(random: Random) -> int:
    return random.choice((_X, _Y, _M, _S)) + random.randrange(200)


def _coil(random: Random) -> int:
    return random.choice((_Y, _M)) + random.randrange(200)
