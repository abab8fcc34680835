"""The common methods of frozen dataclasses: comparison, hash and text, written once.

``dataclass`` writes and compiles these anew for each class, which takes time at each start. What most
commands load inherits them instead: ``@dataclass(frozen=True, slots=True, eq=False, repr=False)``.
"""

from __future__ import annotations

from typing import ClassVar


class Value:
    """Equal to another of the same class with equal fields. Its fields are its slots."""

    __slots__: ClassVar[tuple[str, ...]] = ()

    def __eq__(self, other: object) -> bool:
        return self._fields() == other._fields() if type(other) is type(self) else NotImplemented

    def __hash__(self) -> int:
        return hash(self._fields())

    def __repr__(self) -> str:
        shown = (f"{name}={getattr(self, name)!r}" for name in self.__slots__)
        return f"{type(self).__qualname__}({', '.join(shown)})"

    def _fields(self) -> tuple[object, ...]:
        return tuple([getattr(self, name) for name in self.__slots__])
