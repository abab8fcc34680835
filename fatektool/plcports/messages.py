"""Tables of MD1 and MD2: messages of a user-defined protocol, one byte in each word.

FBs link paper, section 13.1.2, MD1 (sender) and MD2 (receiver)::

    SR+0   mode, low byte        bit 0: MD1 receives after sending, MD2 replies after receiving
                                 bit 7: received bytes are accepted even with errors
    SR+1   start code | end code of received messages; 00 for none
    SR+2   length, 1 to 511      in MD2 0 until the program has written its reply
    SR+3…  the bytes, in the low byte of a word each

The 'OK' of the loop-back test in the paper: 0001 0203 0004 0002 004F 004B 0003.
"""

from __future__ import annotations

from dataclasses import dataclass
from typing import TYPE_CHECKING, Final

from fatektool.errors import UsageError
from fatektool.plcports.operands import require_range
from fatektool.plcports.results import Fault

if TYPE_CHECKING:
    from collections.abc import Sequence

MAX_MESSAGE: Final = 511
SENDER_MODES: Final = {
    0x00: "send only",
    0x01: "send, then receive without errors",
    0x81: "send, then receive even with errors",
}
RECEIVER_MODES: Final = {
    0x00: "receive without errors",
    0x01: "receive without errors, then reply",
    0x80: "receive even with errors",
    0x81: "receive even with errors, then reply",
}


@dataclass(frozen=True, slots=True)
class MessageTable:
    """MD1 or MD2.

    Attributes:
        receiver: True for MD2.
        mode: the low byte of SR+0.
        start_code: of received messages; 0 for none.
        end_code: of received messages; 0 for none.
        data: one word for each byte; the PLC uses the low byte.
        length: SR+2; None for that of ``data``. Another length is allowed only above 511.
        mode_high: the high byte of SR+0, which the PLC ignores.

    Raises:
        UsageError: a value does not fit its byte or word, or the length is not that of the data.
    """

    receiver: bool
    mode: int
    start_code: int
    end_code: int
    data: tuple[int, ...]
    length: int | None = None
    mode_high: int = 0

    def __post_init__(self) -> None:
        for name in ("mode", "start_code", "end_code", "mode_high"):
            require_range(name, getattr(self, name), 255)
        for word in self.data:
            require_range("data", word, 0xFFFF)
        require_range("length", self.message_length, 0xFFFF)
        if len(self.data) != min(self.message_length, MAX_MESSAGE):
            raise UsageError(
                f"length: expected {len(self.data)}, as the data has, got {self.message_length}"
                if len(self.data) <= MAX_MESSAGE
                else f"data: expected at most {MAX_MESSAGE} bytes, got {len(self.data)}"
            )

    @property
    def message_length(self) -> int:
        """SR+2."""
        return len(self.data) if self.length is None else self.length

    @property
    def message(self) -> bytes:
        """The bytes to send: the low bytes."""
        return bytes(word & 0xFF for word in self.data)

    @property
    def modes(self) -> dict[int, str]:
        """The valid modes, with their meaning."""
        return RECEIVER_MODES if self.receiver else SENDER_MODES

    def to_words(self) -> tuple[int, ...]:
        """The contents of the registers from SR on."""
        codes = self.start_code << 8 | self.end_code
        return self.mode_high << 8 | self.mode, codes, self.message_length, *self.data

    @classmethod
    def parse(cls, words: Sequence[int], *, receiver: bool) -> MessageTable:
        """Parse the words."""
        mode, codes, length, *data = words
        own = None if length == len(data) else length
        return cls(receiver, mode & 0xFF, codes >> 8, codes & 0xFF, tuple(data), own, mode >> 8)

    def faults(self) -> list[Fault]:
        """Everything that the paper does not allow."""
        found = []
        if self.mode not in self.modes:
            known = ", ".join(f"{code:02X}" for code in self.modes)
            found.append(Fault(None, None, f"mode: expected one of {known}, got {self.mode:02X}"))
        first = 0 if self.receiver else 1
        if not first <= self.message_length <= MAX_MESSAGE:
            found.append(
                Fault(None, 2, f"length: expected {first} to {MAX_MESSAGE}, got {self.message_length}")
            )
        return found
