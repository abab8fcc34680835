"""The record of the PLC in a backup: ``status`` and ``system`` as in the status document, and their check.

::

    status   seven flags, true or false
    system   unit_type{code name} main_unit_points{code points} os_version, and twelve counts of 16 bits
"""

from __future__ import annotations

import re
from typing import TYPE_CHECKING, Any, Final, NamedTuple

if TYPE_CHECKING:
    from collections.abc import Callable, Mapping

_VERSION: Final = re.compile(r"[0-9A-F]\.[0-9A-F]", re.ASCII)


class _Value(NamedTuple):
    words: str
    holds: Callable[[Any], bool]


def _number(last: int) -> _Value:
    return _Value(f"a whole number of 0 to {last}", lambda value: type(value) is int and 0 <= value <= last)


_FLAG: Final = _Value("true or false", lambda value: isinstance(value, bool))
_COUNT: Final = _number(0xFFFF)
_CODE: Final = _number(0xFF)
_NAME: Final = _Value("a text or null", lambda value: value is None or isinstance(value, str))
_POINTS: Final = _Value("a whole number or null", lambda value: value is None or type(value) is int)
_OS: Final = _Value(
    "a version such as 3.1", lambda value: isinstance(value, str) and _VERSION.fullmatch(value) is not None
)

SHAPE: Final[dict[str, Any]] = {
    "status": {
        "running": _FLAG,
        "battery_low": _FLAG,
        "ladder_checksum_error": _FLAG,
        "rom_pack": _FLAG,
        "watchdog_timeout": _FLAG,
        "id_set": _FLAG,
        "emergency_stop": _FLAG,
    },
    "system": {
        "unit_type": {"code": _CODE, "name": _NAME},
        "main_unit_points": {"code": _CODE, "points": _POINTS},
        "os_version": _OS,
        "ladder_words": _COUNT,
        "discrete_inputs": _COUNT,
        "discrete_outputs": _COUNT,
        "analog_inputs": _COUNT,
        "analog_outputs": _COUNT,
        "m_relays": _COUNT,
        "s_relays": _COUNT,
        "l_relays": _COUNT,
        "r_registers": _COUNT,
        "d_registers": _COUNT,
        "timers": _COUNT,
        "counters": _COUNT,
    },
}


def model_words(system: Mapping[str, Any]) -> str:
    """The model in ``system``: ``MC, 28 points, OS 3.1``."""
    unit, points = system["unit_type"], system["main_unit_points"]
    name = unit["name"] or f"type {unit['code']:02X}"
    count = f"{points['points']} points" if points["points"] else f"points code {points['code']:02X}"
    return f"{name}, {count}, OS {system['os_version']}"


def fault_of(value: object, shape: Any = SHAPE, where: str = "plc") -> tuple[str, object] | None:
    """The first fault: where, what was expected, and the value; None if all is there and valid."""
    if isinstance(shape, _Value):
        return None if shape.holds(value) else (f"{where}: expected {shape.words}", value)
    if not isinstance(value, dict) or not shape.keys() <= value.keys():
        got = sorted(value) if isinstance(value, dict) else value
        return f"{where}: expected an object of {', '.join(shape)}", got
    for key, part in shape.items():
        fault = fault_of(value[key], part, f"{where}.{key}")
        if fault is not None:
            return fault
    return None


def known_keys(value: Any, shape: Any = SHAPE) -> Any:
    """A valid record without the keys that are not known."""
    return (
        {key: known_keys(value[key], part) for key, part in shape.items()}
        if isinstance(shape, dict)
        else value
    )
