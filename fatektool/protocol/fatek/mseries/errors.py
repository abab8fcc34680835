"""The meanings of the error byte of an M-series answer, as in its paper.

M-series paper, section 2.3. It does not have FACON's 3, and another text for 9.
"""

from __future__ import annotations

from typing import Final

from fatektool.errors import PlcRefused

MEANINGS: Final = {
    0x02: "illegal value",
    0x04: "illegal format, or a command that cannot be executed",
    0x05: "cannot run, ladder checksum error",
    0x06: "cannot run, the PLC's ID differs from the ladder's ID",
    0x07: "cannot run, syntax error in the program",
    0x09: "cannot run, function not supported",
    0x0A: "illegal address",
}
_NEXT: Final = {
    0x05: "the program in the PLC is damaged: load it again with the vendor's software",
    0x06: "the program was locked to a PLC with another ID: load one made for this PLC, or set the ID",
    0x07: "load a program that ran on this PLC, with the vendor's software",
    0x09: "the program needs a function that this PLC does not have: 'fatektool status' shows the model",
    0x0A: "this PLC has no such element",
}
"""This project's advice: [E:error-advice]. There are no program commands, so nothing can be restored."""


def meaning_of(code: int) -> str:
    """The meaning of an error code."""
    return MEANINGS.get(code, "a code that the M-series paper does not list")


def refusal(code: int, command: int, asked: str) -> PlcRefused:
    """The exception for an error code.

    Args:
        code: 1 to 255.
        command: the command's code.
        asked: the request as text: ``read registers R12``.
    """
    return PlcRefused(
        f"the PLC refused to {asked} ({command:02X}): error {code:X}, {meaning_of(code)}",
        code=code,
        command=command,
        hint=_NEXT.get(code),
    )
