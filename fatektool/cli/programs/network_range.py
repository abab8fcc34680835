"""Networks that a user asks for: ``12``, ``10-19``, ``N0012``."""

from __future__ import annotations

from dataclasses import dataclass
from typing import TYPE_CHECKING

from fatektool.errors import UsageError

if TYPE_CHECKING:
    from collections.abc import Sequence

    from fatektool.ladder.networks import Network


@dataclass(frozen=True)
class NetworkRange:
    """From one network to another."""

    first: int
    last: int

    @classmethod
    def parse(cls, text: str) -> NetworkRange:
        """Read one.

        Raises:
            UsageError: it is none.
        """
        first, dash, last = (part.strip().upper().removeprefix("N") for part in text.partition("-"))
        last = last if dash else first
        if not (
            first.isdecimal() and last.isdecimal() and len(first + last) <= 12 and int(first) <= int(last)
        ):
            raise UsageError(f"network {text!r}: expected a number or a range, such as 12 or 10-19")
        return cls(int(first), int(last))


def chosen(networks: Sequence[Network], texts: Sequence[str]) -> list[Network]:
    """The networks that were asked for, in the program's order; all of them if none were.

    Raises:
        UsageError: a text is no range, or there is no such network.
    """
    ranges = [NetworkRange.parse(text) for text in texts]
    for each in ranges:
        if each.first >= len(networks):
            has = f"it has N0000 to {networks[-1].name}" if networks else "it has none"
            raise UsageError(f"no network {each.first} in the program: {has}")
    if not ranges:
        return list(networks)
    return [
        network for network in networks if any(each.first <= network.number <= each.last for each in ranges)
    ]
