"""Checks of the values in an inventory: the fields of a PLC's address, and the keys beside them."""

from __future__ import annotations

from pathlib import Path
from typing import Any, Final

from fatektool.address import CHECKS, PlcAddress
from fatektool.checks import Check, OneOf
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


_BESIDE: Final[dict[str, Check[Any]]] = {
    "tags": _Texts(),
    "spec": _FileName(),
    "reference": _FileName(),
    "project": _FileName(),
    "expect": OneOf(EXPECTATIONS),
}
KEYS: Final = tuple(CHECKS | _BESIDE)
KEYS_OF_ONE: Final = {"reference", "project"}
"""Keys that are not allowed in ``[defaults]``."""


def take(key: str, value: object, folder: Path) -> Any:
    """The value of a key, checked; a path in it is relative to ``folder``, that of the file.

    Raises:
        ValueError: wrong value; the message has what was expected.
        UsageError: wrong target.
    """
    taken = (CHECKS | _BESIDE)[key].take(value)
    if key == "target":
        return _target(taken, folder)
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
