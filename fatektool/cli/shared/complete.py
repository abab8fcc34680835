"""Completion of values: baud rates, elements, names in an inventory or a history, documents, faults.

A function of click's form each. A shell shows no messages, so whatever cannot be read completes nothing.
"""

from __future__ import annotations

import os
from pathlib import Path
from typing import TYPE_CHECKING, Final

from click.shell_completion import CompletionItem

from fatektool.errors import FatektoolError

if TYPE_CHECKING:
    from collections.abc import Iterable

    import click

_KINDS: Final = {
    "X": "input",
    "Y": "output",
    "M": "relay",
    "S": "step relay",
    "T": "timer contact",
    "C": "counter contact",
    "R": "data register",
    "D": "data register",
    "F": "file register, M-series",
    "RT": "timer value",
    "RC": "counter value",
}


def complete_baud(_: click.Context, __: click.Parameter, incomplete: str) -> list[CompletionItem]:
    """The baud rates that FATEK PLCs have."""
    from fatektool.protocol.line_settings import BAUDS

    return _beginning(((str(baud), "bits per second") for baud in BAUDS), incomplete)


def complete_line(_: click.Context, __: click.Parameter, incomplete: str) -> list[CompletionItem]:
    """The usual formats of a line."""
    from fatektool.protocol.line_settings import FORMATS

    return _beginning(((each, "data bits, parity, stop bits") for each in FORMATS), incomplete.upper())


def complete_elements(_: click.Context, __: click.Parameter, incomplete: str) -> list[CompletionItem]:
    """The first element of each kind."""
    from fatektool.protocol.elements import KINDS

    return _beginning(((f"{symbol}0", _kind_words(symbol)) for symbol in KINDS), incomplete.upper())


def _kind_words(symbol: str) -> str:
    if symbol in _KINDS:
        return _KINDS[symbol]
    if symbol.startswith("DW"):
        return f"32 of {symbol[2]} as a number"
    return f"16 of {symbol[1]} as a number" if symbol[0] == "W" else f"two of {symbol[1:]}, 32 bits"


def complete_history(context: click.Context, _: click.Parameter, incomplete: str) -> list[CompletionItem]:
    """The names in a history."""
    from fatektool.history.history import History
    from fatektool.inventory.find import inventory_path, whole_inventory

    named = context.params.get("folder") or os.environ.get("FATEKTOOL_HISTORY")
    try:
        path = None if named else inventory_path(None)
        folder = whole_inventory(path).history if path is not None else named
        names = [] if folder is None else History(Path(folder)).names()
    except FatektoolError:
        return []
    return _beginning(((name, "a PLC of this history") for name in names), incomplete)


def complete_schema(_: click.Context, __: click.Parameter, incomplete: str) -> list[CompletionItem]:
    """The documents that have a schema."""
    from importlib.resources import files

    names = (entry.name for entry in (files("fatektool") / "schemas").iterdir())
    documents = sorted(name.removesuffix(".json") for name in names if name.endswith(".json"))
    return _beginning(((name, "JSON Schema of the document") for name in documents), incomplete)


def complete_fault(_: click.Context, __: click.Parameter, incomplete: str) -> list[CompletionItem]:
    """The faults of a simulated PLC."""
    from fatektool.simulator.faults import POWER_CUT, PROBABILITY_KINDS

    faults = [(f"{kind}=", "with this probability") for kind in PROBABILITY_KINDS]
    faults += [
        ("bit-errors=", "with this probability, for each byte"),
        (f"{POWER_CUT}=", "at this write of a page"),
    ]
    return _beginning(faults, incomplete)


def _beginning(values: Iterable[tuple[str, str]], incomplete: str) -> list[CompletionItem]:
    return [CompletionItem(value, help=words) for value, words in values if value.startswith(incomplete)]
