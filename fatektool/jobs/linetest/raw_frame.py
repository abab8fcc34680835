"""The frame of the user's own ladder program: a text between an optional start code and end code.

It is what CLINK (FUN151) sends and receives in MD1 and MD2 (FBs link paper, chapter 13): SR+1 holds the start
code in its high byte and the end code in its low byte, 0 for none, and a frame has 1 to 511 bytes::

    R1=0203H     02 text 03     ends with 03
    R1=0200H     02 text        ends when the line is still
    R1=000DH     text 0D
    R1=0         text
"""

from __future__ import annotations

import re
from dataclasses import dataclass
from typing import Final

from fatektool.errors import UsageError

MAX_FRAME: Final = 511
_CODE: Final = re.compile(r"(?:0x)?([0-9A-Fa-f]{1,2})H?|none", re.ASCII | re.IGNORECASE)


@dataclass(frozen=True, slots=True)
class RawFrame:
    """The codes around a text.

    Attributes:
        start: code, 1 to 255; None for none.
        end: code, 1 to 255; None for none.
    """

    start: int | None
    end: int | None

    @classmethod
    def parse(cls, text: str) -> RawFrame:
        """Read ``START,END``: each a byte in hex, or ``none``; 00 is none, as in the PLC.

        Raises:
            UsageError: something else.
        """
        parts = text.split(",")
        codes = [_CODE.fullmatch(part.strip()) for part in parts]
        if len(codes) != 2 or None in codes:
            raise UsageError(
                f"raw frame {text[:40]!r}: expected START,END as bytes in hex, such as 02,03",
                hint="write none for a missing code: none,0D",
            )
        start, end = (int(code[1] or "0", 16) or None for code in codes if code is not None)
        return cls(start, end)

    def wrap(self, text: bytes) -> bytes:
        """The text in its frame."""
        return _code(self.start) + text + _code(self.end)

    @property
    def code_count(self) -> int:
        """0 to 2."""
        return len(self.wrap(b""))

    @property
    def least(self) -> int:
        """Characters of the shortest text: a frame has at least one byte."""
        return 0 if self.code_count else 1

    @property
    def most(self) -> int:
        """Characters of the longest text."""
        return MAX_FRAME - self.code_count

    def characters(self, data_bits: int) -> bytes:
        """The characters that a text may have, in rising order: all that the line carries but the codes.

        Args:
            data_bits: of the line, 5 to 8.
        """
        return bytes(byte for byte in range(1 << data_bits) if byte not in {self.start, self.end})

    def holds_frame(self, heard: bytes, size: int) -> bool:
        """True if there is a frame among these bytes: from code to code, or as long as expected.

        Args:
            heard: the bytes received.
            size: bytes of the frame that was expected, for one without an end code.
        """
        if self.start is not None:
            _, found, heard = heard.partition(_code(self.start))
            if not found:
                return False
            size -= 1
        return len(heard) >= size if self.end is None else self.end in heard

    def __str__(self) -> str:
        start, end = ("none" if code is None else f"{code:02X}" for code in (self.start, self.end))
        return f"{start},{end}"


def _code(code: int | None) -> bytes:
    return b"" if code is None else bytes([code])
