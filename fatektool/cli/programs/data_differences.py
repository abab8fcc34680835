"""What differs between the data of two backups, or of a backup and a PLC, in words and in JSON."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any, Final

import click

from fatektool.cli.elements.values import shown_raw
from fatektool.counts import counted
from fatektool.jobs.elements.reads import named
from fatektool.jobs.elements.spans import spans_of
from fatektool.program.data.uses import Use, use_of
from fatektool.protocol.values import raw_text

if TYPE_CHECKING:
    from collections.abc import Iterator

    from fatektool.program.data.compare import DataComparison, ValueDifference

_MOST_SHOWN: Final = 40

ignore_option = click.option(
    "--ignore",
    multiple=True,
    metavar="GLOB",
    help='Data that are not compared: D100, "D1??". Can be given several times.',
)


def comparison_lines(found: DataComparison, sides: tuple[str, str]) -> Iterator[str]:
    """What differs between two parts ``data``.

    Args:
        found: the comparison.
        sides: what the first and the second are called.
    """
    if found.same:
        yield "data same: kept values, settings and disabled discretes"
    else:
        counts = {"value": len(found.constant), "disabled discrete": len(found.disabled)}
        texts = [counted(count, noun) for noun, count in counts.items() if count]
        yield f"data differ: {' and '.join(texts)} ({sides[0]} -> {sides[1]})"
    for each in found.constant[:_MOST_SHOWN]:
        yield f"  {each.element}  {_text(each, each.a)} -> {_text(each, each.b)}"
    if len(found.constant) > _MOST_SHOWN:
        spans = spans_of(each.element for each in found.constant[_MOST_SHOWN:])
        yield f"  {len(found.constant) - _MOST_SHOWN} more: {named(spans)}"
    for name, states in found.disabled.items():
        yield f"  {name}  {' -> '.join(map(_state, states))}"
    if found.running:
        running = f"{counted(len(found.running), 'value')}, {named(spans_of(found.running))}"
        yield f"not compared, as they change by themselves: {running}"


def comparison_document(found: DataComparison) -> dict[str, Any]:
    """The same for JSON."""
    return {
        "same": found.same,
        "constant": [
            {"element": str(each.element), "a": _raw(each, each.a), "b": _raw(each, each.b)}
            for each in found.constant
        ],
        "disabled": [{"element": name, "a": a, "b": b} for name, (a, b) in found.disabled.items()],
        "running": spans_of(found.running),
    }


def _raw(each: ValueDifference, value: int | None) -> str | None:
    return None if value is None else raw_text(value, each.element.kind.bits)


def _text(each: ValueDifference, value: int | None) -> str:
    if value is not None and use_of(each.element.symbol, each.element.address) is Use.SETTING:
        return raw_text(value, each.element.kind.bits)  # the parts of a setting are its digits
    return shown_raw(value, each.element.kind, "no value")


def _state(on: bool | None) -> str:  # a state, not a switch
    return "enabled" if on is None else f"disabled {'on' if on else 'off'}"
