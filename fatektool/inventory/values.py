"""Checks of the values in an inventory: the fields of a PLC's address, and the keys beside them."""

from __future__ import annotations

from pathlib import Path
from typing import Any, Final

from fatektool.address import CHECKS, PlcAddress
from fatektool.checks import Check, OneOf
from fatektool.errors import UsageError
from fatektool.transport.target import Target, TargetKind

EXPECTATIONS: Final = ("run", "stop", "any")
"""The values of ``expect``: the mode that ``check`` expects."""


class _Texts(Check[tuple[str, ...]]):
    """A list of strings, or one string."""

    expected = "a list of strings"

    def _taken(self, value: object) -> tuple[str, ...] | None:
        texts = [value] if isinstance(value, str) else value
        if not isinstance(texts, list) or not all(_is_text(text) for text in texts):
            return None
        return tuple(texts)


class _FileName(Check[Path]):
    """The name of a file; ``~`` is the home folder."""

    expected = "the name of a file"

    def _taken(self, value: object) -> Path | None:
        if not isinstance(value, str) or not _is_text(value):
            return None
        try:
            return Path(value).expanduser()
        except RuntimeError:  # ~name of an unknown user
            return None


class _MapName(Check[str]):
    """The text of a Modbus map, or the name of a file with one."""

    expected = "standard, custom, a map such as R2000-R2199=400101, or the name of a file"

    def _taken(self, value: object) -> str | None:
        if not isinstance(value, str) or not _is_text(value):
            return None
        if "=" in value:
            from fatektool.protocol.modbus.map import parse_map

            try:
                parse_map(value)
            except UsageError as error:
                raise ValueError(error.message) from None
        return value


_BESIDE: Final[dict[str, Check[Any]]] = {
    "tags": _Texts(),
    "spec": _FileName(),
    "reference": _FileName(),
    "project": _FileName(),
    "modbus_map": _MapName(),
    "expect": OneOf(EXPECTATIONS),
    "keep": _Texts(),
}
_OF_ALL: Final[dict[str, Check[Any]]] = {"backups": _FileName(), "history": _FileName()}
KEYS: Final = tuple(CHECKS | _BESIDE)
KEYS_OF_ONE: Final = {"project"}
"""Keys that are not allowed in ``[defaults]``."""
KEYS_OF_ALL: Final = tuple(_OF_ALL)
"""Keys that are allowed in ``[defaults]`` alone: where the commands for all PLCs keep their files."""
PLACEHOLDER: Final = "{name}"
"""The name of the PLC, in a ``reference`` of ``[defaults]``, which is the file of each."""
_OTHER_MAPS: Final = {"standard", "custom"}


def take(key: str, value: object, folder: Path) -> Any:
    """The value of a key, checked; a path in it is relative to ``folder``, that of the file.

    Raises:
        ValueError: wrong value; the message has what was expected.
        UsageError: wrong target.
    """
    taken = (CHECKS | _BESIDE | _OF_ALL)[key].take(value)
    if key == "target":
        return _target(taken, folder)
    if key == "modbus_map" and taken not in _OTHER_MAPS and "=" not in taken:
        return str(folder / taken)
    return folder / taken if isinstance(taken, Path) else taken


def address_of(values: dict[str, Any]) -> PlcAddress:
    """The address in the values of a PLC's keys; its keys are removed from ``values``.

    Raises:
        UsageError: no PLC can have this address.
    """
    address = PlcAddress(**{key: values.pop(key) for key in CHECKS if key in values})
    address.require_consistent()
    return address


def _is_text(value: object) -> bool:
    return isinstance(value, str) and bool(value) and value.isprintable()


def _target(text: str, folder: Path) -> str:
    """A target; a path in it is relative to the folder of the file."""
    if not _is_text(text):
        raise ValueError(f"expected {CHECKS['target'].expected}, got {text!r:.60}")
    target = Target.parse(text)
    if target.kind is TargetKind.SIM and target.path:
        return f"sim:{folder / target.path}"
    if target.kind is TargetKind.SERIAL and not target.is_url and "/" in target.path:
        return str(folder / target.path)
    return target.text
