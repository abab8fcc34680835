"""The options of a call, after the question mark of ``modem:/dev/ttyUSB0?number=0228082192&init=AT%26F``.

::

    number   digits, a comma for a pause, * # W (wait for another dial tone)    required
    init     a command for the modem before the call; repeat for more           none
    dial     tone or pulse                                                      tone
    wait     seconds to wait for CONNECT, for each call                         60
    tries    maximum number of calls                                            3
    pause    seconds between two calls                                          11
    guard    seconds of silence before and after the escape sequence +++        1

The defaults of wait and tries are those of a PLC that calls (FBs link paper, chapter 13, modem, note 2); the
pause is what note 3 there asks of a ladder program. Options are percent-encoded: ``&`` is ``%26``.

A dial command contains only characters of a number: no separator and no line end.
"""

from __future__ import annotations

import re
from dataclasses import dataclass
from typing import TYPE_CHECKING, Final
from urllib.parse import unquote

from fatektool.errors import UsageError

if TYPE_CHECKING:
    from collections.abc import Callable

LONGEST_NUMBER: Final = 40
"""Characters; a modem accepts a command line of at least 40 (V.250)."""

_NUMBER: Final = re.compile(rf"[0-9,*#W]{{1,{LONGEST_NUMBER}}}", re.ASCII)
_COMMAND: Final = re.compile(r"AT[\x20-\x7E]{0,76}", re.ASCII | re.IGNORECASE)
_SECONDS: Final = re.compile(r"[0-9]{1,4}(\.[0-9]{1,6})?", re.ASCII)
_HINT: Final = "such as modem:/dev/ttyUSB0?number=0228082192&init=AT%26F&dial=tone"


@dataclass(frozen=True, slots=True)
class Call:
    """The number to call, and how.

    Attributes:
        number: digits, ``,`` ``*`` ``#`` ``W``.
        init: commands before the call, each beginning with AT.
        pulse: True for pulse dialling.
        wait_s: 1 to 255 seconds to wait for a connection, for each call.
        tries: 1 to 20 calls.
        pause_s: 0 to 600 seconds between two calls.
        guard_s: 0.02 to 5.1 seconds of silence before and after ``+++``: one byte in units of 1/50 s.
    """

    number: str
    init: tuple[str, ...] = ()
    pulse: bool = False
    wait_s: float = 60.0
    tries: int = 3
    pause_s: float = 11.0
    guard_s: float = 1.0

    @classmethod
    def parse(cls, query: str) -> Call:
        """Parse the options of a target.

        Args:
            query: the text after the question mark.

        Raises:
            UsageError: an unknown, repeated or invalid option, or no number.
        """
        named: dict[str, object] = {}
        init: list[str] = []
        for part in query.split("&"):
            name, _, encoded = part.partition("=")
            value = unquote(encoded, errors="replace")
            if name == "init":
                init.append(_command(value))
                continue
            read = _OPTIONS.get(name)
            if read is None:
                raise UsageError(
                    f"modem target: unknown option {name[:40]!r}: expected {', '.join(['init', *_OPTIONS])}",
                    hint=f"{_HINT}; write '&' in a value as %26",
                )
            field, convert = read
            if field in named:
                raise UsageError(f"modem target: {name} is given twice", hint=_HINT)
            named[field] = convert(value)
        if "number" not in named:
            raise UsageError("modem target: expected number=…, the number to call", hint=_HINT)
        return cls(init=tuple(init), **named)  # type: ignore[arg-type]  # each was made by its converter

    @property
    def command(self) -> str:
        """The dial command."""
        return f"ATD{'P' if self.pulse else 'T'}{self.number}"


def _number(value: str) -> str:
    if not _NUMBER.fullmatch(value.upper()):
        raise UsageError(
            f"modem target: number: expected 1 to {LONGEST_NUMBER} of the digits, ',' (pause), '*', '#' "
            f"and W, got {value[:60]!r}",
            hint=_HINT,
        )
    return value.upper()


def _command(value: str) -> str:
    if not _COMMAND.fullmatch(value):
        raise UsageError(
            f"modem target: init: expected a command that begins with AT, got {value[:60]!r}", hint=_HINT
        )
    return value


def _dial(value: str) -> bool:
    if value not in {"tone", "pulse"}:
        raise UsageError(f"modem target: dial: expected tone or pulse, got {value[:40]!r}", hint=_HINT)
    return value == "pulse"


def _seconds(name: str, least: float, most: float) -> Callable[[str], float]:
    def convert(value: str) -> float:
        if not _SECONDS.fullmatch(value) or not least <= float(value) <= most:
            raise UsageError(
                f"modem target: {name}: expected {least:g} to {most:g} seconds, got {value[:40]!r}"
            )
        return float(value)

    return convert


def _tries(value: str) -> int:
    if not re.fullmatch(r"[0-9]{1,2}", value, re.ASCII) or not 1 <= int(value) <= 20:
        raise UsageError(f"modem target: tries: expected 1 to 20, got {value[:40]!r}")
    return int(value)


_OPTIONS: Final[dict[str, tuple[str, Callable[[str], object]]]] = {
    "number": ("number", _number),
    "dial": ("pulse", _dial),
    "wait": ("wait_s", _seconds("wait", 1, 255)),
    "tries": ("tries", _tries),
    "pause": ("pause_s", _seconds("pause", 0, 600)),
    "guard": ("guard_s", _seconds("guard", 0.02, 5.1)),
}
