"""Logic of three values: on, off, and not known. What is not known makes no claim."""

from __future__ import annotations

from typing import TYPE_CHECKING, TypeAlias

if TYPE_CHECKING:
    from collections.abc import Iterable

State: TypeAlias = bool | None
"""True for on or conducting, False for off or open, None where it is not known."""


def both(one: State, other: State) -> State:
    """In series: open where one is, whatever the other may be."""
    if one is False or other is False:
        return False
    return None if one is None or other is None else True


def either(states: Iterable[State]) -> State:
    """In parallel: conducting where one is, whatever the others may be."""
    found = list(states)
    if True in found:
        return True
    return None if None in found else False


def opposite(state: State) -> State:
    """Turned round."""
    return None if state is None else not state
