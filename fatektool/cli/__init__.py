"""The command line: options, rendering, exit codes. The only place that prints.

One file a command; each is loaded when its command is used.
"""

from __future__ import annotations

import os
import sys
import warnings
from typing import TYPE_CHECKING, NoReturn, TextIO

import click

from fatektool.cli.shared.output import print_json, print_stderr, with_prefix
from fatektool.cli.shared.stops import end_cleanly
from fatektool.cli.shared.streams import is_closed_pipe, lost_output, mend_streams, output_loss
from fatektool.errors import FatektoolError, FileWarning, UsageError

if TYPE_CHECKING:
    from collections.abc import Sequence

INTERRUPTED = 130
CUT_SHORT = 141
"""The exit code of a program that wrote to a closed pipe, as shells report it."""


def main(arguments: Sequence[str] | None = None) -> NoReturn:
    """Run the command line and end the process with its exit code."""
    words = list(sys.argv[1:] if arguments is None else arguments)
    mend_streams()
    code = run(words)
    import gc

    gc.freeze()  # the end of the process need not search all that was loaded for cycles
    sys.exit(code)


def run(words: list[str]) -> int:
    """Run one command line; give its exit code. What goes wrong is one line on stderr, a warning too."""
    with warnings.catch_warnings():
        warnings.simplefilter("default", FileWarning)
        warnings.showwarning = _show_warning
        return _after_loss(_run(words), as_json="--json" in words)


def _after_loss(code: int, *, as_json: bool) -> int:
    """The exit code, which is no success if what was printed is lost."""
    sys.stdout.flush()
    loss = output_loss()
    if loss is None or code > 1:
        return code
    if is_closed_pipe(loss):
        return code or CUT_SHORT
    return failed(lost_output(loss), as_json=as_json)


def _show_warning(  # noqa: PLR0917  # the signature of warnings.showwarning
    message: Warning | str,
    category: type[Warning],
    filename: str,
    lineno: int,
    file: TextIO | None = None,  # noqa: ARG001
    line: str | None = None,
) -> None:
    """What a user is to know in one line; a developer's warnings as Python shows them."""
    if issubclass(category, FileWarning):
        print_stderr(with_prefix("warning:", str(message)))
    else:
        print_stderr(warnings.formatwarning(message, category, filename, lineno, line))


def _run(words: list[str]) -> int:
    end_cleanly()
    as_json = "--json" in words
    try:
        return _invoke(words)
    except FatektoolError as error:
        return failed(error, as_json=as_json)
    except click.ClickException as error:
        return failed(_usage(error), as_json=as_json)
    except (click.Abort, KeyboardInterrupt) as stop:
        if sys.stderr.isatty():
            print_stderr("")  # the terminal shows ^C, and no new line
        return failed(Interrupted(": ".join(["interrupted", *map(str, stop.args)])), as_json=as_json)
    except Exception as error:  # whatever it is: no traceback for the user
        if os.environ.get("FATEKTOOL_TRACEBACK"):
            raise
        return failed(_fault(error), as_json=as_json)


def _invoke(words: list[str]) -> int:
    """Run one command line; click's own ``main`` would end with exit codes of its own."""
    from fatektool.cli.app import app

    completing = os.environ.get("_FATEKTOOL_COMPLETE")
    if completing:
        from click.shell_completion import shell_complete

        from fatektool.cli.shared.shells import add_shells

        add_shells()
        return shell_complete(app, {}, "fatektool", "_FATEKTOOL_COMPLETE", completing)
    try:
        with app.make_context("fatektool", list(words or ["--help"]), obj=tuple(words)) as context:
            result = app.invoke(context)
    except click.exceptions.Exit as end:  # --help, --version
        return end.exit_code if words else UsageError.exit_code
    return result if isinstance(result, int) else 0


class Interrupted(FatektoolError):
    """Ctrl-C or SIGTERM."""

    exit_code = INTERRUPTED


def failed(error: FatektoolError, *, as_json: bool) -> int:
    """Say what went wrong on stderr, on one line but for ``lines``; with ``--json`` in a document too."""
    if as_json:
        from fatektool.cli.shared.documents import error_document

        print_json(error_document(error))
    for number, line in enumerate(error.lines or [" ".join(str(error).split())]):
        print_stderr(line if number else with_prefix("fatektool:", line, bad=True))
    return error.exit_code


def _usage(error: click.ClickException) -> UsageError:
    context = getattr(error, "ctx", None)
    command = context.command_path if context is not None else "fatektool"
    if type(error).__name__ == "NoArgsIsHelpError" and isinstance(context, click.Context):
        group = context.command
        names = group.list_commands(context) if isinstance(group, click.Group) else []
        return UsageError(f"{command}: expected one of {', '.join(names)}", hint=f"see '{command} --help'")
    return UsageError(error.format_message().rstrip("."), hint=f"see '{command} --help'")


def _fault(error: Exception) -> FatektoolError:
    return FatektoolError(
        f"a fault of fatektool itself: {type(error).__name__}: {error}",
        hint="please report it with the command line; FATEKTOOL_TRACEBACK=1 shows where it happened",
    )
