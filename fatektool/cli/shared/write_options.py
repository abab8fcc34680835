"""The options of a command whose write can be undone."""

from __future__ import annotations

from dataclasses import dataclass
from functools import wraps
from typing import TYPE_CHECKING, Any, TypeVar

import click

from fatektool.cli.shared.options import PATH, yes_option
from fatektool.cli.shared.pairs import apart

if TYPE_CHECKING:
    from collections.abc import Callable
    from pathlib import Path

F = TypeVar("F", bound="Callable[..., Any]")


@dataclass(frozen=True, slots=True)
class Terms:
    """What the options of such a command say.

    Attributes:
        yes: do not ask.
        dry_run: show what would be written, and write nothing.
        rollback: write back what was there if writing fails for good.
        safety_dir: where the safety copy goes; None for beside FILE.
        saves: False for no safety copy.
    """

    yes: bool
    dry_run: bool
    rollback: bool
    safety_dir: Path | None
    saves: bool


def write_options(copied: str, copy: str, place: str = "beside FILE") -> Callable[[F], F]:
    """The options of a write that can be undone; the command gets ``terms``.

    Args:
        copied: what the safety copy is of, ``program`` or ``values``.
        copy: what it is, ``backup`` or ``snapshot``.
        place: where it goes unless ``--safety-dir`` names a folder.
    """

    def decorate(function: F) -> F:
        @click.option("--dry-run", is_flag=True, help="Show what would be written, and write nothing.")
        @click.option(
            "--rollback", is_flag=True, help=f"Write the previous {copied} back if writing fails for good."
        )
        @click.option(
            "--safety-dir",
            type=PATH,
            metavar="DIR",
            help=f"Folder for the previous {copied}; by default {place}.",
        )
        @click.option(
            f"--no-safety-{copy}",
            "no_copy",
            is_flag=True,
            help=f"Do not save the previous {copied}: the write cannot be undone.",
        )
        @yes_option
        @wraps(function)
        def with_terms(
            *args: Any,
            dry_run: bool,
            rollback: bool,
            safety_dir: Path | None,
            no_copy: bool,
            yes: bool,
            **rest: Any,
        ) -> Any:
            apart("no_copy", "rollback", "safety_dir")
            return function(*args, terms=Terms(yes, dry_run, rollback, safety_dir, not no_copy), **rest)

        return with_terms  # type: ignore[return-value]  # click's decorators hand back what they get

    return decorate
