"""Values of elements for people, and warnings about some of them."""

from __future__ import annotations

from itertools import groupby
from typing import TYPE_CHECKING, Final

from fatektool.cli.shared.output import Voice, table, visible
from fatektool.protocol.values import decode, default_type

if TYPE_CHECKING:
    from collections.abc import Iterator, Mapping, Sequence

    from fatektool.protocol.elements import ElementKind
    from fatektool.protocol.values import Value

SELECTION: Final = (
    "ELEMENTS: R12, a range R0-R99, a count R0:100; optionally with a type: R12:u16, D4:f32, R0:8:bcd. "
    "Types: bool, i16, i32 (the default), u16, u32, f32, bcd, hex, str (text, the first character in the low "
    "byte), strh (in the high byte)."
)
"""For the help of each command that takes elements."""

_MOST_NAMED: Final = 10


def shown(value: Value | None, absent: str = "-") -> str:
    """A value for people; ``absent`` where there is none."""
    if value is None:
        return absent
    if isinstance(value, bool):
        return "on" if value else "off"
    if isinstance(value, str):
        return visible(value).replace("\n", "\\n")
    return f"{value:.7g}" if isinstance(value, float) else f"{value}"


def shown_raw(raw: int | None, kind: ElementKind, absent: str = "-") -> str:
    """A raw value for people, as ``read`` shows it."""
    return shown(None if raw is None else decode(raw, default_type(kind), kind.bits), absent)


def value_lines(values: Mapping[str, Value | None], comments: Mapping[str, str]) -> Iterator[str]:
    """Values by key, with the comments of those that have one."""
    texts = {key: shown(value) for key, value in values.items()}
    width = max((len(text) for text in texts.values()), default=0)
    return table(
        (key, f"{text:<{width}}  {comments[key]}" if key in comments else text) for key, text in texts.items()
    )


def warn_of(errors: Mapping[str, str], voice: Voice, not_asked: Sequence[str] = ()) -> None:
    """Warn of elements: the first few, and how many more.

    Args:
        errors: the warnings, by key.
        voice: prints.
        not_asked: those of them that the PLC was not asked for; a line for neighbours with the same reason.
    """
    left_out = set(not_asked)
    keys = [key for key in errors if key not in left_out]
    shown_keys = keys if len(keys) <= _MOST_NAMED else keys[: _MOST_NAMED // 2]
    for key in shown_keys:
        voice.warn(f"{key}: {errors[key]}")
    if len(shown_keys) < len(keys):
        voice.warn(
            f"and {len(keys) - len(shown_keys)} more, {keys[len(shown_keys)]} to {keys[-1]}; --json has all"
        )
    groups = [list(some) for _, some in groupby(not_asked, errors.__getitem__)]
    for group in groups[:_MOST_NAMED]:
        voice.warn(f"{_first_to_last(group)}: {errors[group[0]]}")
    rest = [key for group in groups[_MOST_NAMED:] for key in group]
    if rest:
        voice.warn(f"{_first_to_last(rest)}: not asked either; --json has the reasons")


def _first_to_last(keys: Sequence[str]) -> str:
    return keys[0] if len(keys) == 1 else f"{keys[0]} to {keys[-1]} ({len(keys)})"
