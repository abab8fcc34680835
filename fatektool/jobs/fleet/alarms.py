"""The user's own command after a failure or change: it gets the event in its environment, not as arguments.

The command is started without a shell, so nothing in a PLC's name or in a message is taken for a command. It
may take half a minute; then it is ended, with all that it started.
"""

from __future__ import annotations

import os
import subprocess
from dataclasses import dataclass
from typing import TYPE_CHECKING, Final

from fatektool.errors import UsageError
from fatektool.system.process_group import ProcessGroup
from fatektool.system.shell import program_of, split_command

if TYPE_CHECKING:
    from collections.abc import Sequence

TIME_LIMIT_S: Final = 30.0
_ON_WINDOWS: Final[dict[int | None, str]] = {
    2: "there is no such program; for a command of a shell write cmd /c before it",
    193: "it is not a program; for a script name the program that runs it",
}
"""By the number of winerror.h: echo is a command of cmd.exe, and only .bat and .cmd start of all scripts."""


@dataclass(frozen=True, slots=True)
class Event:
    """What happened.

    Attributes:
        name: the PLC's.
        target: where it is.
        station: 1 to 254.
        job: the command: ``backup``, ``check``.
        event: ``change`` or ``failure``.
        exit_code: of the job.
        message: in words.
        file: that was written or compared with; empty if there is none.
        time: UTC, RFC 3339.
    """

    name: str
    target: str
    station: int
    job: str
    event: str
    exit_code: int
    message: str
    file: str
    time: str

    def environment(self) -> dict[str, str]:
        """``FATEK_NAME``, ``FATEK_EVENT``, …: texts on one line, which every system takes."""
        return {
            f"FATEK_{field.upper()}": " ".join(str(getattr(self, field)).replace("\0", " ").split())
            for field in self.__slots__
        }


def parse_command(text: str, option: str) -> str | tuple[str, ...]:
    r"""Split a command as the system's shell does, and nothing else of a shell.

    Args:
        text: ``mail-alarm --to 'the team'``, on Windows ``C:\tools\alarm.exe "the team"``.
        option: its option, for messages.

    Raises:
        UsageError: a quotation mark is missing, or there is no command.
    """
    try:
        command = split_command(text)
    except ValueError as error:
        raise UsageError(f"{option} {text!r}: {error}") from error
    if not program_of(command):
        raise UsageError(f"{option}: expected a command, got {text!r}")
    return command


def run_command(
    command: str | Sequence[str], event: Event, *, time_limit_s: float = TIME_LIMIT_S
) -> str | None:
    """Start a command and wait for its end.

    What it prints goes to standard error, as standard output is for data.

    Returns:
        What went wrong, in words; None if nothing did.
    """
    program = program_of(command)
    try:
        group = ProcessGroup(command, stdout=2, env=os.environ | event.environment())
    except (OSError, ValueError) as error:
        reason = (
            _ON_WINDOWS.get(getattr(error, "winerror", None)) or getattr(error, "strerror", None) or error
        )
        return f"cannot start {program}: {reason}"
    try:
        code = group.wait(time_limit_s)
    except subprocess.TimeoutExpired:
        group.kill()
        return f"{program} did not end within {time_limit_s:g} s, and was stopped"
    except BaseException:  # an interrupt
        group.kill()
        raise
    finally:
        group.close()
    return f"{program} ended with exit code {code}" if code else None
