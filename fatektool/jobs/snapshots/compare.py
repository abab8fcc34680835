"""Two snapshots: what changed, from what to what."""

from __future__ import annotations

from dataclasses import dataclass
from fnmatch import fnmatchcase
from typing import TYPE_CHECKING

if TYPE_CHECKING:
    from collections.abc import Iterable

    from fatektool.jobs.snapshots.snapshot import Snapshot
    from fatektool.protocol.values import Value


@dataclass(frozen=True, slots=True)
class ValueChange:
    """One value that differs. None stands for a value that could not be read, or a key that is not there.

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
    """What differs, in the order of the first, then of the second.

    Args:
        a: the first.
        b: the second.
        ignore: globs of keys that do not count.
        tolerance: how far apart two numbers may be.
    """
    ignored = list(ignore)
    changes = []
    for key in dict.fromkeys([*a.values, *b.values]):
        if any(fnmatchcase(key, glob) for glob in ignored):
            continue
        one, other = a.values.get(key), b.values.get(key)
        absent = "a" if key not in a.values else "b" if key not in b.values else None
        if absent or not _alike(one, other, tolerance):
            changes.append(ValueChange(key, one, other, absent))
    return changes


def _alike(a: Value | None, b: Value | None, tolerance: float) -> bool:
    numbers = isinstance(a, int | float) and isinstance(b, int | float)
    if numbers and not isinstance(a, bool) and not isinstance(b, bool):
        return abs(float(a) - float(b)) <= tolerance  # type: ignore[arg-type]  # numbers, as just seen
    return a == b and type(a) is type(b)
