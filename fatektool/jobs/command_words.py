"""A command in words, as a request: ``46 R12 3``, ``write-registers R0:2=1,2``, in Modbus ``03 R12 3``.

::

    40, 53   (nothing)               of an answer: its bytes in hex
    41       run | stop
    42       disable | enable | set | reset  ELEMENT
    43 44    ELEMENT COUNT           or ELEMENT-ELEMENT, ELEMENT:COUNT
    46       the same, of registers  of an answer, as of 43 and 44, ELEMENT:COUNT=VALUE,VALUE...
    45 47    ELEMENT:COUNT=VALUE,VALUE...
    48       ELEMENT...              of an answer ELEMENT=VALUE...
    49       ELEMENT=VALUE...
    4E       TEXT
    4F       PAGE                    of an answer PAGE and its bytes in hex
    50       PAGE and its bytes in hex

A command is its code, or its name: ``read-registers`` is 46. Modbus functions (01 to 06, 0F, 10) take what 44
to 47 take. Elements and values are written as for ``read`` and ``write``.
"""

from __future__ import annotations

import re
from typing import Final, NamedTuple

from fatektool.errors import UsageError
from fatektool.jobs import command_operands as operands
from fatektool.protocol.commands import Command, ReadDisabled, ReadDiscretes, ReadRegisters


class _Form(NamedTuple):
    """How a command is written.

    Attributes:
        asks: what follows it, in words.
        answers: what follows it where the answer is wanted.
        parse: the operands, and whether the answer is wanted, as a request with its answer.
    """

    asks: str
    answers: str
    parse: operands.Reader


MODBUS_FUNCTIONS: Final = {
    0x01: Command.READ_DISCRETES,
    0x02: Command.READ_DISCRETES,
    0x03: Command.READ_REGISTERS,
    0x04: Command.READ_REGISTERS,
    0x05: Command.WRITE_DISCRETES,
    0x06: Command.WRITE_REGISTERS,
    0x0F: Command.WRITE_DISCRETES,
    0x10: Command.WRITE_REGISTERS,
}
"""Which command asks for the same as a Modbus function."""
NAMES: Final = {command.name.lower().replace("_", "-"): command for command in Command}
"""The commands by name."""


def parse_code(text: str) -> int:
    """A command's code as in a frame: two hex digits, or a command's name.

    Raises:
        UsageError: it is neither.
    """
    if text.lower() in NAMES:
        return NAMES[text.lower()]
    if re.fullmatch(r"(?:0[xX])?[0-9A-Fa-f]{1,2}[hH]?", text):
        return int(text.rstrip("hH"), 16)
    raise UsageError(
        f"command: expected a code in hex, such as 46, or one of {', '.join(NAMES)}; got {text!r:.60}"
    )


def parse_command(command: str, *words: str, answer: bool = False, m_series: bool = False) -> operands.Spoken:
    """Read a command in words: see the table above.

    Args:
        command: its code in hex, or its name; also a Modbus function.
        words: what follows it.
        answer: True to read the answer's values too.
        m_series: True for the status bytes of an M-series PLC.

    Raises:
        UsageError: there is no such command, or the operands are none of its.
    """
    code = parse_code(command)
    known = Command(code) if code in FORMS else MODBUS_FUNCTIONS.get(code)
    if known is None:
        raise UsageError(
            f"command: {code:02X} is not documented", hint="--data takes the data field of any command in hex"
        )
    form = FORMS[known]
    try:
        spoken = form.parse(words, answer=answer)
    except operands.WrongOperands:
        expected = form.answers if answer else form.asks
        of_what = "the answer to " if answer else ""
        got = " ".join(words)
        raise UsageError(
            f"{of_what}{code:02X} ({known.words}) takes {expected or 'nothing'}; got {got[:60] or 'nothing'}"
        ) from None
    if m_series and known is Command.BRIEF_STATUS and answer:
        return operands.Spoken(spoken.request, operands.brief(bytes(spoken.answer.to_bytes()), m_series=True))
    return spoken


_RUN: Final = "ELEMENT COUNT, such as R12 3 or R12-R14"
_BITS: Final = "ELEMENT COUNT, such as Y10 7 or Y10-Y16"
_BIT_VALUES: Final = "ELEMENT:COUNT=VALUE,VALUE..., such as Y0:4=1,0,0,1"
_WORD_VALUES: Final = "ELEMENT:COUNT=VALUE,VALUE..., such as R12:3=1,2,0xFF"
_MIXED: Final = "ELEMENT=VALUE..., such as R1=5 Y9=on"
_PAGE: Final = "PAGE and its 128 bytes in hex"

FORMS: Final = {
    Command.BRIEF_STATUS: _Form("", "3 bytes in hex", operands.brief_status),
    Command.RUN_STOP: _Form("run or stop", "run or stop", operands.run_stop),
    Command.CONTROL_DISCRETE: _Form(
        "disable, enable, set or reset and an element", "the same as the request", operands.control
    ),
    Command.READ_DISABLED: _Form(_BITS, _BIT_VALUES, operands.reads(ReadDisabled, of_bits=True)),
    Command.READ_DISCRETES: _Form(_BITS, _BIT_VALUES, operands.reads(ReadDiscretes, of_bits=True)),
    Command.WRITE_DISCRETES: _Form(_BIT_VALUES, _BIT_VALUES, operands.writes_discretes),
    Command.READ_REGISTERS: _Form(_RUN, _WORD_VALUES, operands.reads(ReadRegisters, of_bits=False)),
    Command.WRITE_REGISTERS: _Form(_WORD_VALUES, _WORD_VALUES, operands.writes_registers),
    Command.READ_MIXED: _Form("elements, such as R1 Y9 DWM0", _MIXED, operands.read_mixed),
    Command.WRITE_MIXED: _Form(_MIXED, _MIXED, operands.write_mixed),
    Command.LOOPBACK: _Form("one text", "one text", operands.loopback),
    Command.READ_PAGE: _Form("PAGE", _PAGE, operands.read_page),
    Command.WRITE_PAGE: _Form(_PAGE, _PAGE, operands.write_page),
    Command.DETAILED_STATUS: _Form("", "64 bytes in hex", operands.detailed_status),
}
"""How each command is written."""
