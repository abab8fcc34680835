"""The error codes of a PLC's answer, with their meaning and the next step.

FACON paper, section 3. The M-series paper has its own texts: ``mseries/errors``.
"""

from __future__ import annotations

from typing import TYPE_CHECKING, Final, TypeVar

from fatektool.errors import PlcRefused
from fatektool.protocol.commands import PROGRAM_COMMANDS, RunStop

if TYPE_CHECKING:
    from fatektool.protocol.commands import Request

A = TypeVar("A")

MEANINGS: Final = {
    0x2: "illegal value",
    0x3: "write prohibited, a ROM pack is fitted",
    0x4: "illegal format or command, or the command cannot be executed now",
    0x5: "cannot run, ladder checksum error",
    0x6: "cannot run, the PLC's ID differs from the ladder's ID",
    0x7: "cannot run, syntax error in the program",
    0x9: "cannot run, an instruction of the program is not supported by this PLC",
    0xA: "illegal address, above the range of this PLC",
}

# What to do next is this project's advice, the meanings are the paper's: [E:error-advice].
_NEXT: Final = {
    0x3: "remove the ROM pack, or write the ROM pack itself",
    0x5: "restore a good backup: the program in the PLC is damaged",
    0x6: "the program was locked to a PLC with another ID: load one made for this PLC, or set the ID",
    0x7: "restore a backup that ran on this PLC",
    0x9: "the program was made for a newer or larger model: check the model with 'fatektool status'",
    0xA: "'fatektool status' shows how many of each element this PLC has",
}

PROGRAM_REFUSED: Final = (
    "this PLC may not give its program over the line: the FBs papers have neither 4F nor 50, and a password "
    "may be set; use the engineer's project file (.pdw), which 'fatektool listing' reads"
)


def meaning_of(code: int) -> str:
    """The meaning of an error code."""
    return MEANINGS.get(code, "a code that no paper lists")


def refusal(code: int, command: int, asked: str) -> PlcRefused:
    """The exception for an error code.

    Args:
        code: 1 to 15.
        command: the command's code.
        asked: the request as text: ``read program page 5``.
    """
    hint = _NEXT.get(code)
    if code in {0x2, 0x4, 0xA} and command in PROGRAM_COMMANDS:
        hint = PROGRAM_REFUSED
    return PlcRefused(
        f"the PLC refused to {asked} ({command:02X}): error {code:X}, {meaning_of(code)}",
        code=code,
        command=command,
        hint=hint,
    )


def asked(request: Request[A]) -> str:
    """A request as text: ``read program page 5``, ``read registers R12``."""
    if isinstance(request, RunStop):
        return "RUN" if request.run else "STOP"
    words = request.command.words
    for name in ("page", "first", "element"):
        subject = getattr(request, name, None)
        if subject is not None:
            return f"{words} {subject}"
    return words
