"""The differences between two snapshots."""

from __future__ import annotations

from dataclasses import dataclass
from fnmatch import fnmatchcase
from typing import TYPE_CHECKING

if TYPE_CHECKING:
    from collections.abc import Iterable, Mapping
    from typing import Any

    from fatektool.jobs.snapshots.snapshot import Snapshot
    from fatektool.protocol.values import Value


@dataclass(frozen=True, slots=True)
class ValueChange:
    """One value that differs. None is a value that could not be read, or a key that is not there.

    Attributes:
        key: which.
        a: in the first.
        b: in the second.
        absent: the one that has no such key, ``a`` or ``b``; None if both have it.
    """

    key: str
    a: Value | None
    b: Value | None
    absent: str | None = None


def compare_snapshots(
    a: Snapshot, b: Snapshot, *, ignore: Iterable[str] = (), tolerance: float = 0.0
) -> list[ValueChange]:
    """The differences, in the order of the first snapshot, then of the second.

    Args:
        a: the first.
        b: the second.
        ignore: globs of keys that are not compared.
        tolerance: the largest difference of two numbers that is ignored.
    """
    ignored = list(ignore)
    changes = []
    for key in dict.fromkeys([*a.values, *b.values]):
        if any(fnmatchcase(key, glob) for glob in ignored):
            continue
        one, other = a.values.get(key), b.values.get(key)
        absent = "a" if key not in a.values else "b" if key not in b.values else None
        if absent or not (
            _alike(one, other, tolerance) or _same_bits(a.elements.get(key), b.elements.get(key))
        ):
            changes.append(ValueChange(key, one, other, absent))
    return changes


def _same_bits(a: Mapping[str, Any] | None, b: Mapping[str, Any] | None) -> bool:
    """True for the same bits of one element that are only read as another type: 65535 as u16, -1 as i16."""
    if a is None or b is None or a.get("raw") is None or a.get("type") == b.get("type"):
        return False
    return _without_type(a) == _without_type(b)


def _without_type(part: Mapping[str, Any]) -> dict[str, Any]:
    return {name: value for name, value in part.items() if name not in {"type", "comment"}}


def _alike(a: Value | None, b: Value | None, tolerance: float) -> bool:
    numbers = isinstance(a, int | float) and isinstance(b, int | float)
    if numbers and not isinstance(a, bool) and not isinstance(b, bool):
        return abs(float(a) - float(b)) <= tolerance  # type: ignore[arg-type]  # numbers, as just seen
    return a == b and type(a) is type(b)
