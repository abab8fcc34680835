"""Elements in ranges, for messages and files."""

from __future__ import annotations

from typing import TYPE_CHECKING

if TYPE_CHECKING:
    from collections.abc import Iterable

    from fatektool.protocol.elements import Element


def spans_of(elements: Iterable[Element]) -> list[str]:
    """Elements in ranges, such as ``R0-R63``."""
    spans: list[list[Element]] = []
    for element in sorted(elements):
        last = spans[-1][-1] if spans else None
        if last is not None and (last.symbol, last.address + last.kind.stride) == (
            element.symbol,
            element.address,
        ):
            spans[-1].append(element)
        else:
            spans.append([element])
    return [f"{span[0]}" if len(span) == 1 else f"{span[0]}-{span[-1]}" for span in spans]
