"""Options that depend on each other: what would have no effect is refused, never dropped.

Only what is given on the command line counts. A default, an environment variable or the inventory holds for
many commands, and may be without effect in one.
"""

from __future__ import annotations

import click
from click.core import ParameterSource

from fatektool.errors import UsageError


def given(name: str) -> str | None:
    """The option as it is written, such as ``--format``, if it is on the command line; else None."""
    context = click.get_current_context()
    if context.get_parameter_source(name) is not ParameterSource.COMMANDLINE:
        return None
    found = next(parameter for parameter in context.command.params if parameter.name == name)
    return max(found.opts, key=len)


def apart(one: str, *others: str, why: str | None = None) -> None:
    """Refuse an option beside others that leave it without effect.

    Args:
        one: an option's parameter.
        others: those of the others.
        why: the next step for the user.

    Raises:
        UsageError: both are given.
    """
    first = given(one)
    if first is None:
        return
    for other in others:
        second = given(other)
        if second is not None:
            raise UsageError(f"{first} does not go with {second}", hint=why)


def together(one: str, *, holds: bool, needs: str) -> None:
    """Refuse an option without what gives it an effect.

    Args:
        one: an option's parameter.
        holds: True if it has its effect.
        needs: what it needs, in words.

    Raises:
        UsageError: it is given, and has none.
    """
    first = given(one)
    if first is not None and not holds:
        raise UsageError(f"{first} has no effect here: it goes with {needs}")
