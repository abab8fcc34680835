"""The inputs and outputs of functions: their number and the vendor's names.

For a function that is not here, the code shows the number of its input lines, and FO n the outputs in use.
The names are from:

    print    a ladder printed by the vendor's software
    manual   the FBs and FB manuals, The Format of Function Instructions, and chapter 13
    field    published notes of programs in which only one thing was changed
"""

from __future__ import annotations

from dataclasses import dataclass
from typing import TYPE_CHECKING, Final

if TYPE_CHECKING:
    from fatektool.ladder.forms import Form


@dataclass(frozen=True, slots=True)
class Pins:
    """The names of a function's inputs, from the first line on, and of its outputs from FO 0 on."""

    inputs: tuple[str, ...]
    outputs: tuple[str, ...]


_TIMER: Final = Pins(("EN",), ("TUP",))  # print
_LINK: Final = Pins(("EN", "PAU", "ABT"), ("ACT", "ERR", "DN"))

_PINS: Final = {
    0x80F0: _TIMER,
    0x81F0: _TIMER,
    0xBEF0: _TIMER,
    0x40F0: Pins(("CK", "CLR"), ("CUP",)),  # field: two lines, the second clears, the output CUP
    0x00F0: Pins(("CK", "U/D", "CLR"), ("CUP",)),  # manual
    0xACF0: Pins(("EN",), ()),  # print: MOV; a coil after it is on the same line
    0xADF0: Pins(("EN",), ()),
    0x96F0: Pins(("EN",), ("CY",)),  # manual
    0x1AF0: _LINK,  # print: HSPSO
    0xD0F0: Pins(("EN",), ("ERR",)),  # print: MPARA
    0x1CF0: _LINK,  # manual, chapter 13: CLINK
}


def pins_of(form: Form) -> Pins | None:
    """A function's inputs and outputs; None if not known."""
    return _PINS.get(form.fixed[0]) if form.fixed else None
