"""Frozen dataclasses whose methods are written once, for what is loaded at each start.

``dataclass(frozen=True)`` writes and compiles comparison, text and the refusal to change anew for each class:
half a millisecond, thirty times before the first byte is sent. Here a class has fields by ``dataclass`` and
inherits the rest; only ``__init__`` is compiled for it.
"""

from __future__ import annotations

from dataclasses import MISSING, FrozenInstanceError, dataclass, fields
from typing import ClassVar, NoReturn, TypeVar, dataclass_transform

C = TypeVar("C")


class Value:
    """Equal to another of the same class with equal fields. Its fields are its slots, and do not change."""

    __slots__: ClassVar[tuple[str, ...]] = ()

    def __eq__(self, other: object) -> bool:
        return self._fields() == other._fields() if type(other) is type(self) else NotImplemented

    def __hash__(self) -> int:
        return hash(self._fields())

    def __repr__(self) -> str:
        shown = (f"{name}={getattr(self, name)!r}" for name in self.__slots__)
        return f"{type(self).__qualname__}({', '.join(shown)})"

    def __setattr__(self, name: str, _: object) -> NoReturn:
        raise FrozenInstanceError(f"cannot assign to field {name!r}")

    def __delattr__(self, name: str) -> NoReturn:
        raise FrozenInstanceError(f"cannot delete field {name!r}")

    def __reduce__(self) -> tuple[type, tuple[object, ...]]:
        """For ``copy`` and ``pickle``."""
        return type(self), self._fields()

    def _fields(self) -> tuple[object, ...]:
        return tuple([getattr(self, name) for name in self.__slots__])


@dataclass_transform(frozen_default=True)
def frozen(cls: type[C]) -> type[C]:
    """Make a class that inherits ``Value`` a frozen dataclass with slots.

    A field may have a default, but no ``default_factory``.
    """
    made = dataclass(init=False, repr=False, eq=False, slots=True)(cls)
    words, lines, names = ["self"], [], {}
    types: dict[str, object] = {"return": None}
    for field in fields(made):  # type: ignore[arg-type]  # mypy does not see that it is a dataclass now
        names[f"set_{field.name}"] = getattr(made, field.name).__set__
        words.append(field.name)
        types[field.name] = field.type
        if field.default is not MISSING:
            names[f"default_{field.name}"] = field.default
            words[-1] += f"=default_{field.name}"
        lines.append(f" set_{field.name}(self, {field.name})")
    if hasattr(made, "__post_init__"):
        lines.append(" self.__post_init__()")
    text = "\n".join([f"def __init__({', '.join(words)}):", *(lines or [" pass"])])
    exec(text, names)  # noqa: S102  # as dataclass does, with names of fields alone
    made.__init__ = names["__init__"]  # type: ignore[method-assign]
    made.__init__.__annotations__ = types  # for help() and editors
    return made
