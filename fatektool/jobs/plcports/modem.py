"""The modem of port 1, as the PLC's registers set it: read, and set anew.

In a register with two settings the other half is not changed.

FBs link paper, chapter 13, modem::

    R4140 to R4145  phone number
    R4149  high     55H: a modem is on port 1
    R4163  high     rings before it answers
           low      b7 to b4: settings; b3 to b0: dial control
    M1959           dials by pulses, else by tones
"""

from __future__ import annotations

from dataclasses import dataclass
from typing import TYPE_CHECKING, Final

from fatektool.errors import PlcError, UsageError
from fatektool.jobs.elements.planned import RegisterChange
from fatektool.jobs.elements.reads import named, read_elements
from fatektool.jobs.elements.selection import Item
from fatektool.jobs.snapshots.snapshot import raw_of, snapshot_and_status
from fatektool.jobs.snapshots.spec import SpecItem
from fatektool.jobs.snapshots.write_values import ValuesPlan
from fatektool.plcports.phone_number import phone_number_words
from fatektool.plcports.settings import PHONE_REGISTERS, Modem, decode_modem
from fatektool.protocol.elements import Element
from fatektool.protocol.values import ValueType

if TYPE_CHECKING:
    from fatektool.client import Plc

FUNCTION, CONTROL, PULSE = "R4149", "R4163", "M1959"
ELEMENTS: Final = (*PHONE_REGISTERS, FUNCTION, CONTROL, PULSE, "M1964", "M1965", "M1966")
_ON: Final = 0x55


@dataclass(frozen=True, slots=True)
class ModemReport:
    """What the registers say.

    Attributes:
        modem: in words.
        raw: values by element, unsigned.
        errors: what the PLC said of the elements that it refused.
    """

    modem: Modem
    raw: dict[str, int]
    errors: dict[str, str]


@dataclass(frozen=True, slots=True)
class ModemSettings:
    """What shall be set; None leaves it as it is.

    Attributes:
        number: to call, as people write it.
        on: True for a modem on port 1.
        pulse: True for pulse dialling, False for tones.
        rings: before it answers, 0 to 255.
        dial_control: 1 to 4.
        profile: 0 factory settings (AT&F), 1 user profile (AT&Y).
    """

    number: str | None = None
    on: bool | None = None
    pulse: bool | None = None
    rings: int | None = None
    dial_control: int | None = None
    profile: int | None = None

    @property
    def elements(self) -> tuple[str, ...]:
        """The elements that hold what shall be set."""
        control = (self.rings, self.dial_control, self.profile) != (None, None, None)
        return (
            *(PHONE_REGISTERS if self.number is not None else ()),
            *((FUNCTION,) if self.on is not None else ()),
            *((CONTROL,) if control else ()),
            *((PULSE,) if self.pulse is not None else ()),
        )

    def apply(self, values: dict[str, int]) -> dict[str, int]:
        """What the elements shall hold.

        Args:
            values: what they hold, raw, by element.

        Raises:
            UsageError: no phone number.
        """
        wanted = dict(values)
        if self.number is not None:
            wanted |= zip(PHONE_REGISTERS, phone_number_words(self.number), strict=True)
        if self.on is not None and self.on != (values[FUNCTION] >> 8 == _ON):
            wanted[FUNCTION] = values[FUNCTION] & 0xFF | (_ON << 8 if self.on else 0)
        for value, shift, mask in (
            (self.rings, 8, 0xFF),
            (self.profile, 4, 0xF),
            (self.dial_control, 0, 0xF),
        ):
            if value is not None:
                wanted[CONTROL] = wanted[CONTROL] & ~(mask << shift) | value << shift
        if self.pulse is not None:
            wanted[PULSE] = int(self.pulse)
        return wanted


def read_modem(plc: Plc) -> ModemReport:
    """Read the modem's registers; what the PLC refuses is missing and named.

    Raises:
        LineError: no answer.
    """
    reading = read_elements(plc, map(Element.parse, ELEMENTS))
    values = {str(element): value for element, value in reading.values.items()}
    errors = {str(element): error for element, error in reading.errors.items()}
    return ModemReport(decode_modem(values), values, errors)


def plan_modem(plc: Plc, settings: ModemSettings) -> ValuesPlan:
    """Read what is there now and find what differs. Changes nothing.

    Raises:
        UsageError: nothing shall be set, or a number that is none.
        PlcError: the PLC has not all of these registers.
        LineError: no answer.
    """
    if not settings.elements:
        raise UsageError("nothing to set", hint="name a setting, such as --number 02-28082192")
    if settings.number is not None:
        phone_number_words(settings.number)  # before anything is asked of the PLC
    elements = [Element.parse(name) for name in settings.elements]
    present, status = snapshot_and_status(
        plc, [SpecItem(Item(str(each), each, _type(each))) for each in elements]
    )
    if present.errors:
        said = next(iter(present.errors.values()))
        raise PlcError(
            f"the PLC refused {named(present.errors)}: {said}",
            hint="this model has no modem port, or not all of it",
        )
    now = {key: raw for key, (_, raw) in raw_of(present).items() if raw is not None}
    wanted = settings.apply(now)
    changes = tuple(
        RegisterChange(element, now[str(element)], wanted[str(element)])
        for element in elements
        if now[str(element)] != wanted[str(element)]
    )
    return ValuesPlan(
        "the modem was not set completely", present, status, changes, len(elements) - len(changes)
    )


def _type(element: Element) -> ValueType:
    return ValueType.BOOL if element.kind.bits == 1 else ValueType.HEX
