"""Questions to the user: asked on a terminal, or answered by an option; else a refusal."""

from __future__ import annotations

import contextlib
import sys
from typing import Final

import click

from fatektool.cli.shared.output import print_stderr, visible
from fatektool.errors import UsageError

_LOOK_S: Final = 0.2


def confirm(question: str, *, yes: bool, option: str = "--yes") -> bool:
    """Ask, unless the option answers; a question that cannot be put is a refusal.

    Raises:
        UsageError: there is no terminal to ask on.
    """
    require_answer(yes=yes, option=option)
    if yes:
        return True
    while True:
        click.echo(f"{visible(question)} [y/N]: ", nl=False, err=True)
        _wait_for_line()
        answer = sys.stdin.readline()
        if not answer:  # ^D, or the terminal is gone
            print_stderr("")
        word = answer.strip().lower()
        if word in {"y", "yes"}:
            return True
        if word in {"", "n", "no"}:
            return False
        print_stderr("please answer y or n")


def require_answer(*, yes: bool, option: str = "--yes", unchanged: str = "nothing was done") -> None:
    """Refuse to go on without an answer: neither the option nor anybody to ask.

    Raises:
        UsageError: there is no terminal to ask on.
    """
    if not yes and not can_ask():
        raise UsageError(
            f"this needs a confirmation, and there is no terminal to ask on: {unchanged}",
            hint=f"add {option}",
        )


def can_ask() -> bool:
    """True if a user can answer a question."""
    return sys.stdin.isatty() and sys.stderr.isatty()


def _wait_for_line() -> None:
    """Wait for an answer at the terminal, and let Ctrl-C end that.

    A signal that comes just before a read does not interrupt it: so the read begins when there is a line.
    """
    if sys.platform == "win32":
        return
    from select import select

    with contextlib.suppress(OSError, ValueError):  # it is no file of the system
        while not select([sys.stdin], [], [], _LOOK_S)[0]:
            pass
