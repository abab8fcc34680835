"""Which elements are read: named on the command line, or in a specification file."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any, TypeVar

import click

from fatektool.cli.shared.options import PATH
from fatektool.errors import UsageError
from fatektool.jobs.elements.selection import parse_items
from fatektool.jobs.snapshots.spec import Spec, items_of, load_spec

if TYPE_CHECKING:
    from collections.abc import Callable
    from pathlib import Path

F = TypeVar("F", bound="Callable[..., Any]")


def spec_options(function: F) -> F:
    """``--spec`` and ``--group``; the command gets ``spec`` and ``groups``."""
    function = click.option(
        "--group",
        "groups",
        multiple=True,
        metavar="GROUP",
        help="Only items of this group of --spec; repeat for more.",
    )(function)
    return click.option(
        "--spec", type=PATH, metavar="FILE.toml", help="What to read, with names, scales and units."
    )(function)


def selected(
    elements: tuple[str, ...], spec: Path | None, groups: tuple[str, ...], *, whole: bool | None = None
) -> Spec:
    """The items that the options name; for ``--all`` none yet, as the PLC must be asked.

    Args:
        elements: ELEMENTS.
        spec: ``--spec``.
        groups: ``--group``.
        whole: ``--all``; None for a command that has no such option.

    Raises:
        UsageError: not exactly one of ELEMENTS, ``--spec`` and ``--all``, or ``--group`` without ``--spec``.
        DataError: the specification is invalid.
    """
    if sum((bool(elements), spec is not None, bool(whole))) != 1:
        ways = ["ELEMENTS", "--spec FILE.toml", *([] if whole is None else ["--all"])]
        raise UsageError(f"expected one of: {', '.join(ways)}")
    if groups and spec is None:
        raise UsageError("--group goes with --spec")
    if spec is not None:
        return load_spec(spec, groups)
    return Spec(items_of(parse_items(elements)))
