"""``--history DIR``, and NAME@REV."""

from __future__ import annotations

from functools import wraps
from typing import TYPE_CHECKING, Any, TypeVar

import click

from fatektool.cli.shared.options import PATH
from fatektool.errors import UsageError

if TYPE_CHECKING:
    from collections.abc import Callable
    from pathlib import Path

F = TypeVar("F", bound="Callable[..., Any]")


def history_option(function: F) -> F:
    """``--history DIR``; the command gets ``history``."""

    @click.option(
        "--history",
        "folder",
        type=PATH,
        metavar="DIR",
        envvar="FATEKTOOL_HISTORY",
        help="The git repository.  [default: 'history' of the inventory]  [env: FATEKTOOL_HISTORY]",
    )
    @wraps(function)
    def with_history(*args: Any, folder: Path | None, **rest: Any) -> Any:
        folder = folder or _of_inventory()
        if folder is None:
            raise UsageError(
                "no history is given",
                hint="give --history DIR, set FATEKTOOL_HISTORY, or name it in [defaults] of the inventory",
            )
        return function(*args, folder=folder, **rest)

    return with_history  # type: ignore[return-value]  # click's decorators hand back what they get


def _of_inventory() -> Path | None:
    """The history that the usual inventory names; None without one."""
    from fatektool.inventory.find import inventory_path, whole_inventory

    path = inventory_path(None)
    return None if path is None else whole_inventory(path).history


def name_and_revision(which: str) -> tuple[str, str]:
    """NAME and REV of ``NAME[@REV]``; without REV the newest.

    Raises:
        UsageError: there is an @ and no revision after it.
    """
    name, at, revision = which.partition("@")
    if at and not revision:
        raise UsageError(f"{which}: expected a revision after the @, such as {name}@~1 or {name}@2026-11-22")
    return name, revision or "HEAD"
