"""Checks of the values in an inventory: from the value in TOML to the value of a PLC."""

from __future__ import annotations

from collections.abc import Callable
from pathlib import Path
from typing import Any, Final, TypeAlias

from fatektool.protocols import PROTOCOLS
from fatektool.transport.base import LineSettings
from fatektool.transport.target import Target, TargetKind

Take: TypeAlias = Callable[[object, Path], Any]
"""TOML's value and the file's folder -> a PLC's value. Raises ValueError, TypeError or UsageError."""

EXPECTATIONS: Final = ("run", "stop", "any")
"""The values of ``expect``: the mode that ``check`` expects."""


def _text(value: object, _: Path) -> str:
    if not isinstance(value, str) or not value or not value.isprintable():
        raise ValueError
    return value


def _target(value: object, folder: Path) -> str:
    """A target; a path in it is relative to the folder of the file."""
    target = Target.parse(_text(value, folder))
    if target.kind is TargetKind.SIM and target.path:
        return f"sim:{folder / target.path}"
    if target.kind is TargetKind.SERIAL and not target.is_url and "/" in target.path:
        return str(folder / target.path)
    return target.text


def _path(value: object, folder: Path) -> Path:
    try:
        return folder / Path(_text(value, folder)).expanduser()
    except RuntimeError as error:  # ~name of an unknown user
        raise ValueError from error


def _tags(value: object, folder: Path) -> tuple[str, ...]:
    return tuple(_text(tag, folder) for tag in ([value] if isinstance(value, str) else _list(value)))


def _list(value: object) -> list[object]:
    if not isinstance(value, list):
        raise TypeError
    return value


def _whole(first: int, last: int) -> Callable[[object, Path], int]:
    def take(value: object, _: Path) -> int:
        if type(value) is not int or not first <= value <= last:
            raise ValueError
        return value

    return take


def _seconds(first: float, last: float) -> Callable[[object, Path], float]:
    def take(value: object, _: Path) -> float:
        number = isinstance(value, int | float) and not isinstance(value, bool)
        if not number or not first <= value <= last:  # type: ignore[operator]  # it is a number
            raise ValueError
        return float(value)  # type: ignore[arg-type]  # the same

    return take


def _one_of(words: tuple[str, ...]) -> Callable[[object, Path], str]:
    def take(value: object, _: Path) -> str:
        if value not in words:
            raise ValueError
        return str(value)

    return take


def _flag(value: object, _: Path) -> bool:
    if not isinstance(value, bool):
        raise TypeError
    return value


def _format(value: object, folder: Path) -> str:
    return LineSettings(format=_text(value, folder).upper()).format


CHECKS: Final[dict[str, tuple[str, Take]]] = {
    "target": ("a string such as tcp://192.168.2.3 or /dev/ttyUSB0", _target),
    "station": ("a whole number of 1 to 254, with modbus-tcp 0 or 255 too", _whole(0, 255)),
    "protocol": (f"one of {', '.join(PROTOCOLS)}", _one_of(tuple(PROTOCOLS))),
    "baud": ("a whole number of 50 to 4000000", _whole(50, 4_000_000)),
    "format": ("a string such as 7E1", _format),
    "timeout_s": ("seconds, 0.001 to 3600", _seconds(0.001, 3600)),
    "retries": ("a whole number of 0 to 1000", _whole(0, 1000)),
    "lock_wait_s": ("seconds, 0 to 86400", _seconds(0, 86400)),
    "tags": ("a list of strings", _tags),
    "spec": ("the name of a file", _path),
    "reference": ("the name of a file", _path),
    "project": ("the name of a file", _path),
    "read_only": ("true or false", _flag),
    "expect": (f"one of {', '.join(EXPECTATIONS)}", _one_of(EXPECTATIONS)),
}
"""The keys of a PLC: the expected value in words, and its check."""
