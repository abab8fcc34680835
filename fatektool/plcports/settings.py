"""Other communication settings: message detection, the high-speed link of port 2, the modem of port 1.

FBs link paper, section 13.1.2, MD1 to MD3 and modem::

    M1956           R4148's high byte is the time that ends a message without an end code
    R4148  high     that time, 1 ms; 12 by default
    M1958           this PLC is a slave of the high-speed link
    M1967           one cycle of the high-speed link, then stop; else continuous
    R4054 = 55xxH   station xx is the master; else station 1 is
    R4055           = 55xxH sets this PLC's station; else its low byte shows it
    R4058           a slave that is abnormal, 0 for none
    R4059           abnormal code | count of abnormal answers
    R4160 = 56xxH   the time-out set by hand; else by R4161, the communication parameters
    R4149 = 55xxH   a modem is on port 1
    R4140 to R4145  the phone number
    M1959           dials by pulses, else by tones
    M1964 M1965 M1966    dial (off: hang up), connected, failed
    R4163  high     rings before it answers
           low      b7 to b4: 0 the modem's factory settings (AT&F), 1 its own profile (AT&Y)
                   b3 to b0: dial control
"""

from __future__ import annotations

from dataclasses import dataclass
from typing import TYPE_CHECKING, Final

from fatektool.errors import DataError
from fatektool.plcports.phone_number import parse_phone_number
from fatektool.plcports.ports import flag

if TYPE_CHECKING:
    from collections.abc import Mapping

PHONE_REGISTERS: Final = tuple(f"R{address}" for address in range(4140, 4146))
SETTING_ELEMENTS: Final = (
    *("M1958", "M1967", "R4054", "R4055", "R4058", "R4059", "R4160", "R4161"),
    *("R4149", "R4163", "M1959", "M1964", "M1965", "M1966"),
    *PHONE_REGISTERS,
)
ABNORMAL: Final = {
    0x0A: "no answer from the slave",
    0x0B: "damaged data",
    0x01: "framing error",
    0x02: "overrun error",
    0x04: "parity error",
    0x08: "CRC error",
}
ABNORMAL_STEP: Final = (
    "repair the station, then clear both with 'fatektool write R4058=0 R4059=0', again until they stay 0: "
    "R4058 shows one abnormal station even if there are more"
)
"""The paper's procedure for R4058 and R4059 (section 13.1.2, MD3)."""
UNWATCHED: Final = "the master checks only stations that send in its table, not those that only receive"
"""The limit of R4058 and R4059 (the same section)."""
DIALLING: Final = {
    1: "does not wait for dial tone or busy tone",
    2: "waits for the dial tone, not for the busy tone",
    3: "dials without dial tone, then waits for the busy tone",
    4: "waits for dial tone and busy tone",
}
PROFILES: Final = {0: "factory settings (AT&F)", 1: "user profile (AT&Y)"}


@dataclass(frozen=True, slots=True)
class MessageDetection:
    """How the end of a message without an end code is detected.

    Attributes:
        by_time: M1956.
        interval_ms: the high byte of R4148, in milliseconds.
    """

    by_time: bool | None
    interval_ms: int | None


@dataclass(frozen=True, slots=True)
class HighSpeedLink:
    """The high-speed link of port 2. Values that the PLC does not have are None.

    Attributes:
        slave: M1958.
        one_cycle: M1967.
        master_station: by R4054; 1 by default.
        station: this PLC's, by R4055.
        station_set: True if R4055 sets it, False if it shows it.
        abnormal_station: 0 for none.
        abnormal_code: of the last abnormal answer.
        abnormal_count: the number of abnormal answers.
        timeout: R4160's low byte if it is set by hand; None if it follows from the parameters.
        parameters: R4161 as a number.
    """

    slave: bool | None
    one_cycle: bool | None
    master_station: int | None
    station: int | None
    station_set: bool | None
    abnormal_station: int | None
    abnormal_code: int | None
    abnormal_count: int | None
    timeout: int | None
    parameters: int | None

    @property
    def good(self) -> bool:
        """No slave is abnormal, and no abnormal answer was counted since R4059 was cleared."""
        return not self.abnormal_station and not self.abnormal_code and not self.abnormal_count

    @property
    def abnormal(self) -> str | None:
        """The meaning of the abnormal code; None if there is none."""
        if not self.abnormal_code:
            return None
        known = ABNORMAL.get(self.abnormal_code)
        if known is not None:
            return known
        bits = [text for bit, text in ABNORMAL.items() if bit.bit_count() == 1 and self.abnormal_code & bit]
        if self.abnormal_code >= 0x10:
            return "a code that the paper does not list"
        return f"{' and '.join(bits)} (our reading: the paper lists single codes)"


@dataclass(frozen=True, slots=True)
class Modem:
    """The modem of port 1. Values that the PLC does not have are None.

    Attributes:
        on: the high byte of R4149 is 55H.
        phone_number: digits, ``,`` pause, ``#``, ``*``; None if the registers have none.
        pulse_dialling: M1959; False for tones.
        dial: M1964.
        connected: M1965.
        failed: M1966.
        dial_control: 1 to 4; any other number works as 4.
        profile: 0 factory settings, 1 user profile.
        rings: before it answers.
    """

    on: bool | None
    phone_number: str | None
    pulse_dialling: bool | None
    dial: bool | None
    connected: bool | None
    failed: bool | None
    dial_control: int | None
    profile: int | None
    rings: int | None


def decode_detection(values: Mapping[str, int]) -> MessageDetection:
    """How the end of a message is detected; ``values`` are raw, by element."""
    interval = values.get("R4148")
    return MessageDetection(flag(values, "M1956"), None if interval is None else interval >> 8)


def decode_high_speed(values: Mapping[str, int]) -> HighSpeedLink:
    """The high-speed link; ``values`` are raw, by element."""
    names = ("R4054", "R4055", "R4058", "R4059", "R4160")
    master, station, abnormal, log, timeout = map(values.get, names)
    return HighSpeedLink(
        flag(values, "M1958"),
        flag(values, "M1967"),
        None if master is None else master & 0xFF if master >> 8 == 0x55 else 1,
        None if station is None else station & 0xFF,
        None if station is None else station >> 8 == 0x55,
        abnormal,
        None if log is None else log >> 8,
        None if log is None else log & 0xFF,
        None if timeout is None or timeout >> 8 != 0x56 else timeout & 0xFF,
        values.get("R4161"),
    )


def decode_modem(values: Mapping[str, int]) -> Modem:
    """The modem; ``values`` are raw, by element."""
    function, control = values.get("R4149"), values.get("R4163")
    words = [values[name] for name in PHONE_REGISTERS if name in values]
    number: str | None = None
    if len(words) == len(PHONE_REGISTERS):
        try:
            number = parse_phone_number(words)
        except DataError:  # registers that were never set: this is not a fault
            number = None
    return Modem(
        None if function is None else function >> 8 == 0x55,
        number,
        flag(values, "M1959"),
        flag(values, "M1964"),
        flag(values, "M1965"),
        flag(values, "M1966"),
        None if control is None else control & 0xF,
        None if control is None else control >> 4 & 0xF,
        None if control is None else control >> 8,
    )
