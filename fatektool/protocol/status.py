"""Status bytes as values: the brief status of 40 and the detailed status of 53.

::

    40   byte 1 flags · 2 model · 3 reserved
    53   byte 1 flags · 2 main unit type · 3 main unit points · 4 OS version, one digit each nibble
         5-6 ladder size in words · 7-8 discrete inputs · 9-10 discrete outputs
         11-12 analog inputs · 13-14 analog outputs · 15-16 M · 17-18 S · 19-20 L
         21-22 R · 23-24 D · 25-26 timers · 27-28 counters · 29-64 reserved

16-bit values have their high byte first (FACON paper, section 4.2, commands 40 and 53). A code that is in no
paper is shown as a code: real units have such.

The M-series paper (section 2.5.1) has the same byte 1 in 40, except bit 3: a memory card instead of a ROM
pack. Bytes 2 and 3 are reserved. It has 53 without a layout: an answer of 64 bytes is assumed to have
FACON's, any other is kept as bytes.
"""

from __future__ import annotations

import struct
from typing import Any, Final

from fatektool.errors import FrameError
from fatektool.value import Value, frozen

MODELS: Final = {
    0xFF: "FB, 8K steps",
    0x53: "FBE, 8K steps",
    0x54: "FBE, 13K steps",
    0x55: "FBN, 8K steps",
    0x56: "FBN, 13K steps",
}
UNIT_TYPES: Final = {0x00: "MA/MU", 0x01: "MC"}
POINTS_FB: Final = {0x01: 20, 0x02: 28, 0x03: 40}
POINTS_FBS: Final = {0x00: 10, 0x01: 14, 0x02: 20, 0x03: 24, 0x04: 32, 0x05: 40, 0x06: 60}
FBS_OS_MAJOR: Final = 4

BRIEF: Final = struct.Struct(">3B")
DETAILED: Final = struct.Struct(">4B12H36x")
"""The layouts of 40 and 53; the 36 bytes at the end are reserved."""


@frozen
class StatusFlags(Value):
    """Status byte 1, the same in 40 and 53, bit 0 first; ``rom_pack`` is an M-series PLC's memory card."""

    running: bool
    battery_low: bool
    ladder_checksum_error: bool
    rom_pack: bool
    watchdog_timeout: bool
    id_set: bool
    emergency_stop: bool

    @classmethod
    def parse(cls, byte: int) -> StatusFlags:
        """Parse the seven flags of one byte; bit 7 is reserved."""
        return cls(*(bool(byte >> bit & 1) for bit in range(7)))

    @property
    def byte(self) -> int:
        """The flags as one byte."""
        return sum(getattr(self, name) << bit for bit, name in enumerate(self.__slots__))

    def document(self) -> dict[str, bool]:
        """The flags for JSON."""
        return {name: getattr(self, name) for name in self.__slots__}


@frozen
class BriefStatus(Value):
    """The answer to 40.

    Attributes:
        flags: byte 1.
        status2: byte 2, a model's code.
        status3: byte 3, reserved.
        m_series: True if bit 3 of byte 1 is a memory card, and byte 2 is reserved too.
        bit7: bit 7 of byte 1, reserved.
    """

    flags: StatusFlags
    status2: int
    status3: int
    m_series: bool = False
    bit7: bool = False

    @property
    def status1(self) -> int:
        """Byte 1 as received."""
        return self.flags.byte | self.bit7 << 7

    @property
    def model(self) -> str | None:
        """The model in status byte 2; None for a code that the paper does not list."""
        return None if self.m_series else MODELS.get(self.status2)

    @classmethod
    def parse(cls, data: bytes, *, m_series: bool = False) -> BriefStatus:
        """Parse the three bytes of an answer to 40.

        Raises:
            FrameError: not three bytes.
        """
        if len(data) != BRIEF.size:
            raise FrameError(f"brief status: expected {BRIEF.size} bytes, got {len(data)}", raw=data)
        flags, status2, status3 = BRIEF.unpack(data)
        return cls(StatusFlags.parse(flags), status2, status3, m_series, bit7=flags > 0x7F)

    def to_bytes(self) -> bytes:
        """The three bytes."""
        return bytes([self.status1, self.status2, self.status3])


@frozen
class System(Value):
    """Model and sizes of a PLC, bytes 2 to 28 of 53: the part that does not change by itself."""

    unit_type: int
    main_unit_points: int
    os_version: str
    ladder_words: int
    discrete_inputs: int
    discrete_outputs: int
    analog_inputs: int
    analog_outputs: int
    m_relays: int
    s_relays: int
    l_relays: int
    r_registers: int
    d_registers: int
    timers: int
    counters: int

    @property
    def unit_type_name(self) -> str | None:
        """``MA/MU`` or ``MC``; None for a code that the paper does not list."""
        return UNIT_TYPES.get(self.unit_type)

    @property
    def points(self) -> int | None:
        """I/O points of the main unit; FBs units (OS 4 and later) have their own table."""
        major = self.os_version.partition(".")[0]
        newer = major.isdigit() and int(major) >= FBS_OS_MAJOR
        return (POINTS_FBS if newer else POINTS_FB).get(self.main_unit_points)

    def document(self) -> dict[str, Any]:
        """The system for JSON, each code with its name."""
        found: dict[str, Any] = {name: getattr(self, name) for name in self.__slots__}
        found["unit_type"] = {"code": self.unit_type, "name": self.unit_type_name}
        found["main_unit_points"] = {"code": self.main_unit_points, "points": self.points}
        return found


@frozen
class DetailedStatus(Value):
    """The answer to 53.

    Attributes:
        flags: byte 1.
        system: bytes 2 to 28.
        raw: all 64 bytes, the reserved ones too.
        assumed: True if no paper has this layout for this PLC.
    """

    flags: StatusFlags
    system: System
    raw: bytes
    assumed: bool = False

    @classmethod
    def parse(cls, data: bytes, *, assumed: bool = False) -> DetailedStatus:
        """Parse the 64 bytes of an answer to 53.

        Raises:
            FrameError: not 64 bytes.
        """
        if len(data) != DETAILED.size:
            raise FrameError(f"detailed status: expected {DETAILED.size} bytes, got {len(data)}", raw=data)
        flags, unit_type, points, version, *counts = DETAILED.unpack(data)
        system = System(unit_type, points, f"{version >> 4:X}.{version & 15:X}", *counts)
        return cls(StatusFlags.parse(flags), system, bytes(data), assumed)


@frozen
class RawStatus(Value):
    """An answer to 53 in a layout that no paper describes."""

    raw: bytes
