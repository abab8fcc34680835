"""The Modbus map of the slave: the elements of its addresses.

::

    coils (01 05 15)         0 Y0..Y255     1000 X0..X255    2000 M0..M2001
                             6000 S0..S999  9000 T0..T255    9500 C0..C255
    registers (03 06 16)     0 R0..R4167    5000 R5000..R5998  6000 D0..D2998
                             9000 RT0..RT255  9500 RC0..RC199  9700 C200..C255, two registers each

Addresses are as on the wire: 0 is 000001 or 400001. While R3968 is A55AH, coils and registers are what
R3969..R3971 and R3978..R3980 define (first address, first M or R, count), and nothing else. Discrete inputs
(02) and input registers (04) are what R3972..R3974 and R3975..R3977 say, whatever R3968 is; with a count of 0
there are none (FBs link paper, section 13.3).
"""

from __future__ import annotations

from typing import TYPE_CHECKING, NamedTuple

from fatektool.simulator.refusal import Refusal, RefusalCode

if TYPE_CHECKING:
    from collections.abc import Iterator

    from fatektool.simulator.plc import SimulatedPlc

LONG_COUNTER = "C200.."
_OWN = 0xA55A
_SETTINGS = 3968
_SETTING_COUNT = 13


class MapSpan(NamedTuple):
    """Addresses ``start`` to ``start + length - 1`` are elements from ``first`` on."""

    start: int
    symbol: str
    first: int
    length: int


class Piece(NamedTuple):
    """Consecutive elements of one symbol."""

    symbol: str
    first: int
    length: int


_COILS = (
    MapSpan(0, "Y", 0, 256),
    MapSpan(1000, "X", 0, 256),
    MapSpan(2000, "M", 0, 2002),
    MapSpan(6000, "S", 0, 1000),
    MapSpan(9000, "T", 0, 256),
    MapSpan(9500, "C", 0, 256),
)
_REGISTERS = (
    MapSpan(0, "R", 0, 4168),
    MapSpan(5000, "R", 5000, 999),
    MapSpan(6000, "D", 0, 2999),
    MapSpan(9000, "RT", 0, 256),
    MapSpan(9500, "RC", 0, 200),
    MapSpan(9700, LONG_COUNTER, 0, 112),
)
_M_LAST, _M_MOST = 2001, 2001
_R_LAST, _R_MOST = 3839, 3840


def pieces(plc: SimulatedPlc, function: int, address: int, count: int) -> list[Piece]:
    """The elements of a function's addresses; refuses addresses outside the present map."""
    spans = _spans(plc, function)
    return list(_cut(spans, address, count))


def _cut(spans: tuple[MapSpan, ...], address: int, count: int) -> Iterator[Piece]:
    while count:
        for span in spans:
            within = address - span.start
            if 0 <= within < span.length:
                size = min(count, span.length - within)
                yield Piece(span.symbol, span.first + within, size)
                address += size
                count -= size
                break
        else:
            raise Refusal(RefusalCode.ILLEGAL_ADDRESS)


def _spans(plc: SimulatedPlc, function: int) -> tuple[MapSpan, ...]:
    settings = plc.read_words("R", _SETTINGS, _SETTING_COUNT)
    own = settings[0] == _OWN
    if function == 2:
        return _laid(settings[4:7], "M", _M_LAST, _M_MOST)
    if function == 4:
        return _laid(settings[7:10], "R", _R_LAST, _R_MOST)
    if function in {1, 5, 15}:
        return _laid(settings[1:4], "M", _M_LAST, _M_MOST) if own else _COILS
    return _laid(settings[10:13], "R", _R_LAST, _R_MOST) if own else _REGISTERS


def _laid(group: list[int], symbol: str, last: int, most: int) -> tuple[MapSpan, ...]:
    start, first, count = group
    if first > last or not 1 <= count <= most:
        return ()
    return (MapSpan(start, symbol, first, count),)
