"""The part ``data`` of a backup file: values of registers, relays, timers and counters, and what is disabled.

::

    "data": {
     "time": "2026-11-22T03:15:40Z", "running": false,
     "counts": {"R": 8072, "D": 4096, "F": 0, "RT": 256, "RC": 256, "M": 2002, "S": 1000},
     "sha256": "…",                                    of the lines of values and disabled, see ``sha256``
     "moving": ["R100", "R4128-R4129"],                two readings differed
     "errors": {"R8000-R8071": "…"},                   the PLC refused these, or they were not asked for
     "values": {"R0": "0000 0001 …",                   16 registers in hex, one line
                "M0": "0101…", …},                     64 relays, one line
     "disabled": {"X3": true, "M7": false}             disabled discretes: on or off
    }

``----`` is a register without a value, ``-`` a relay.
"""

from __future__ import annotations

from dataclasses import dataclass
from hashlib import sha256
from typing import TYPE_CHECKING, Any, Final

from fatektool.program.data.uses import SYMBOLS

if TYPE_CHECKING:
    from collections.abc import Iterator, Mapping, Sequence

RELAYS: Final = frozenset({"M", "S"})
NO_REGISTER: Final = "----"
NO_RELAY: Final = "-"
Values = tuple[int | None, ...]


@dataclass(frozen=True, slots=True)
class DataPart:
    """The data of a PLC at one time.

    Attributes:
        time: when the reading began, UTC, RFC 3339.
        running: True if the PLC was in RUN.
        values: by kind, from address 0 on, raw; None for an element without a value.
        disabled: the disabled discretes by name, True for on.
        moving: elements whose two readings differed, in spans such as ``R4128-R4130``.
        errors: why elements have no value, by spans.
    """

    time: str
    running: bool
    values: Mapping[str, Values]
    disabled: Mapping[str, bool]
    moving: tuple[str, ...]
    errors: Mapping[str, str]

    @property
    def counts(self) -> dict[str, int]:
        """How many of each kind there are."""
        return {symbol: len(self.values[symbol]) for symbol in SYMBOLS}

    @property
    def sha256(self) -> str:
        """Of lines that end in LF: ``NAME VALUES`` of values, then ``NAME on`` or ``off`` of disabled."""
        lines = [f"{name} {row}\n" for name, row in self.rows()]
        lines += [f"{name} {'on' if on else 'off'}\n" for name, on in self.disabled.items()]
        return sha256("".join(lines).encode()).hexdigest()

    def rows(self) -> Iterator[tuple[str, str]]:
        """The lines of ``values``: the first element's name, and the values."""
        for symbol in SYMBOLS:
            values = self.values[symbol]
            for first in range(0, len(values), row_length(symbol)):
                yield f"{symbol}{first}", _row(symbol, values[first : first + row_length(symbol)])

    def document(self) -> dict[str, Any]:
        """The part as a backup file has it."""
        return {**self.summary(), "values": dict(self.rows()), "disabled": dict(self.disabled)}

    def summary(self) -> dict[str, Any]:
        """The same without the values."""
        return {
            "time": self.time,
            "running": self.running,
            "counts": self.counts,
            "sha256": self.sha256,
            "moving": list(self.moving),
            "errors": dict(self.errors),
        }


def row_length(symbol: str) -> int:
    """How many values one line has."""
    return 64 if symbol in RELAYS else 16


def _row(symbol: str, values: Sequence[int | None]) -> str:
    if symbol in RELAYS:
        return "".join(NO_RELAY if value is None else str(value) for value in values)
    return " ".join(NO_REGISTER if value is None else f"{value:04X}" for value in values)
