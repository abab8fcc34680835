"""``read``: elements of any kind."""

from __future__ import annotations

from itertools import groupby
from typing import TYPE_CHECKING, Any

import click

from fatektool.cli.programs.program_files import comments_for, comments_options
from fatektool.cli.shared.documents import where
from fatektool.cli.shared.modbus_map import modbus_map_option
from fatektool.cli.shared.options import Connection, connection_options
from fatektool.cli.shared.output import Voice, table
from fatektool.errors import DataError, PlcError
from fatektool.jobs.elements.reads import read_elements
from fatektool.jobs.elements.selection import parse_items
from fatektool.protocol.values import Value, decode

if TYPE_CHECKING:
    from collections.abc import Iterator, Mapping, Sequence
    from pathlib import Path

    from fatektool.jobs.elements.reads import Reading
    from fatektool.jobs.elements.selection import Item

_MOST_NAMED = 10
SELECTION = (
    "ELEMENTS are R12, a range R0-R99, a count R0:100, each with a type if need be: R12:i16, D4:f32, "
    "R0:8:bcd. "
    "Types: bool, u16, i16, u32, i32, f32, bcd, hex."
)


@click.command(
    "read", epilog="Example: fatektool read R12:3 WM8 DR2 Y0-Y7 X16 D4:f32 -p /dev/ttyUSB0", help=(
        f"Read elements of any kind, in the fewest bytes.\n\n{SELECTION}"
    ),
)  # fmt: skip
@click.argument("elements", nargs=-1, required=True)
@comments_options
@connection_options
@modbus_map_option
def read_command(
    elements: tuple[str, ...],
    connection: Connection,
    voice: Voice,
    *,
    comments: Path | None,
    encoding: str | None,
) -> int:
    """Read elements of any kind."""
    items = parse_items(elements)
    texts = commented(items, comments_for(connection, comments, voice, encoding))
    with connection.open(voice) as plc:
        reading = read_elements(plc, [item.element for item in items])
        values, errors = typed(items, reading)
        not_asked = [item.key for item in items if item.element in reading.not_asked]
        document = {
            "schema": "fatektool.read/1",
            **where(plc),
            "requests": reading.requests,
            "values": values,
            "elements": with_comments(raw_values(items, reading), texts),
            "errors": errors,
            "not_asked": not_asked,
        }
    voice.show(document, value_lines(values, texts))
    warn_of(errors, voice, not_asked)
    return PlcError.exit_code if errors else 0


def commented(items: Sequence[Item], comments: Mapping[str, str]) -> dict[str, str]:
    """The comments of items by key, of those that have one."""
    if not comments:
        return {}
    from fatektool.project.comments import comment_of

    found = ((item.key, comment_of(str(item.element), comments)) for item in items)
    return {key: comment for key, comment in found if comment is not None}


def with_comments(
    elements: dict[str, dict[str, Any]], comments: Mapping[str, str]
) -> dict[str, dict[str, Any]]:
    """What is said of elements by key, with their comments."""
    return {
        key: part | ({"comment": comments[key]} if key in comments else {}) for key, part in elements.items()
    }


def value_lines(values: Mapping[str, Value | None], comments: Mapping[str, str]) -> Iterator[str]:
    """Values by key for people, the comments behind them."""
    texts = {key: shown(value, None) for key, value in values.items()}
    width = max((len(text) for text in texts.values()), default=0)
    return table(
        (key, f"{text:<{width}}  {comments[key]}" if key in comments else text) for key, text in texts.items()
    )


def warn_of(errors: Mapping[str, str], voice: Voice, not_asked: Sequence[str] = ()) -> None:
    """Say what is wrong with which elements: the first few, and how many more.

    Args:
        errors: what is wrong, by key.
        voice: says it.
        not_asked: those of them that were not asked; a line for neighbours with the same reason.
    """
    left_out = set(not_asked)
    keys = [key for key in errors if key not in left_out]
    told = keys if len(keys) <= _MOST_NAMED else keys[: _MOST_NAMED // 2]
    for key in told:
        voice.warn(f"{key}: {errors[key]}")
    if len(told) < len(keys):
        voice.warn(f"and {len(keys) - len(told)} more, {keys[len(told)]} to {keys[-1]}; --json tells of each")
    groups = [list(some) for _, some in groupby(not_asked, errors.__getitem__)]
    for group in groups[:_MOST_NAMED]:
        voice.warn(f"{_first_to_last(group)}: {errors[group[0]]}")
    rest = [key for group in groups[_MOST_NAMED:] for key in group]
    if rest:
        voice.warn(f"{_first_to_last(rest)}: not asked either: --json tells of each why")


def _first_to_last(keys: Sequence[str]) -> str:
    return keys[0] if len(keys) == 1 else f"{keys[0]} to {keys[-1]} ({len(keys)})"


def typed(items: list[Item], reading: Reading) -> tuple[dict[str, Value | None], dict[str, str]]:
    """Values by key, null where there is none, and why there is none."""
    values: dict[str, Value | None] = {}
    errors: dict[str, str] = {}
    for item in items:
        values[item.key] = None
        if item.element in reading.errors:
            errors[item.key] = reading.errors[item.element]
            continue
        try:
            values[item.key] = decode(reading.values[item.element], item.type, item.element.kind.bits)
        except DataError as error:
            errors[item.key] = error.message
    return values, errors


def raw_values(items: list[Item], reading: Reading) -> dict[str, dict[str, Any]]:
    """Element, type and raw bits by key."""
    return {
        item.key: {
            "element": str(item.element),
            "type": item.type.value,
            "raw": raw_text(reading.values, item),
        }
        for item in items
    }


def raw_text(values: Mapping[Any, int], item: Item) -> str | None:
    """Raw bits in hex, a digit for a discrete; None if it was not read."""
    raw = values.get(item.element)
    return None if raw is None else f"{raw:0{max(1, item.element.kind.bits // 4)}X}"


def shown(value: Value | None, error: str | None) -> str:
    """A value for people."""
    if value is None:
        return f"- ({error})" if error else "-"
    if isinstance(value, bool):
        return "on" if value else "off"
    return f"{value:.7g}" if isinstance(value, float) else f"{value}"
