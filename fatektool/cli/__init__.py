"""The command line: options, rendering, exit codes. The only place that prints.

One file a command; each is loaded when its command is used.
"""

from __future__ import annotations

import os
import signal
import sys
from typing import TYPE_CHECKING, NoReturn

import click

from fatektool.errors import FatektoolError, UsageError

if TYPE_CHECKING:
    from collections.abc import Sequence
    from types import FrameType

INTERRUPTED = 130
FAULT = 70


def main(arguments: Sequence[str] | None = None) -> NoReturn:
    """Run the command line and end the process with its exit code."""
    words = list(sys.argv[1:] if arguments is None else arguments)
    code = run(words)
    try:
        sys.stdout.flush()
    except OSError:  # whoever read our output is gone
        os.dup2(os.open(os.devnull, os.O_WRONLY), 1)
    sys.exit(code)


def run(words: list[str]) -> int:  # noqa: PLR0911  # a way out a class of error
    """Run one command line; give its exit code. What goes wrong is one line on stderr."""
    from fatektool.cli.app import app

    signal.signal(signal.SIGTERM, _terminate)
    as_json = "--json" in words
    try:
        result = app.main(args=words, prog_name="fatektool", standalone_mode=False)
    except FatektoolError as error:
        return report(error, as_json=as_json)
    except click.exceptions.NoArgsIsHelpError as error:
        click.echo(error.ctx.get_help())
        return UsageError.exit_code
    except click.ClickException as error:
        return report(_usage(error), as_json=as_json)
    except (click.Abort, KeyboardInterrupt):
        return report(Interrupted("interrupted"), as_json=as_json)
    except BrokenPipeError:
        os.dup2(os.open(os.devnull, os.O_WRONLY), sys.stdout.fileno())
        return UsageError.exit_code
    except Exception as error:  # the last door: no traceback for the user
        if os.environ.get("FATEKTOOL_TRACEBACK"):
            raise
        return report(_fault(error), as_json=as_json)
    return result if isinstance(result, int) else 0


class Interrupted(FatektoolError):
    """Ctrl-C or SIGTERM."""

    exit_code = INTERRUPTED


def report(error: FatektoolError, *, as_json: bool) -> int:
    """Say what went wrong: one line on stderr, and with ``--json`` a document on stdout."""
    if as_json:
        from fatektool.cli.documents import error_document
        from fatektool.cli.output import print_json

        print_json(error_document(error))
    line = " ".join(str(error).split())
    click.echo(f"fatektool: {line}", err=True)
    return error.exit_code


def _usage(error: click.ClickException) -> UsageError:
    context = getattr(error, "ctx", None)
    command = context.command_path if context is not None else "fatektool"
    return UsageError(error.format_message().rstrip("."), hint=f"see '{command} --help'")


def _fault(error: Exception) -> FatektoolError:
    return FatektoolError(
        f"a fault of fatektool itself: {type(error).__name__}: {error}",
        hint="please report it with the command line; FATEKTOOL_TRACEBACK=1 shows where it happened",
    )


def _terminate(_signal: int, _frame: FrameType | None) -> None:
    raise KeyboardInterrupt
