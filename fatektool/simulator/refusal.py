"""The refusal of a simulated PLC: an error code, raised by the PLC and sent by the slave.

The codes are those of the FACON paper, section 3; the binary M-series protocol uses the same
numbers, and a Modbus slave can map them to its exceptions.
"""

from __future__ import annotations

from enum import IntEnum


class RefusalCode(IntEnum):
    """The reason of a refusal."""

    ILLEGAL_VALUE = 0x2
    WRITE_PROHIBITED = 0x3
    ILLEGAL_FORMAT = 0x4
    LADDER_CHECKSUM = 0x5
    ID_DIFFERS = 0x6
    SYNTAX = 0x7
    UNSUPPORTED_INSTRUCTION = 0x9
    ILLEGAL_ADDRESS = 0xA


class Refusal(Exception):
    """The PLC refuses a request; ``code`` is in its answer.

    Args:
        code: the error code, 1 to 15.
    """

    def __init__(self, code: int) -> None:
        super().__init__(f"refused with code {code:X}")
        self.code = code
