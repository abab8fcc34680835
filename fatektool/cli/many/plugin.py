"""The output of a monitoring plugin: one line, ``FATEK STATE - words | figures``, and exit codes of its own.

0 OK, 1 WARNING, 2 CRITICAL, 3 UNKNOWN, and no others: the monitoring would take a 2 of the other commands
(usage) for CRITICAL and a 5 (data) for an error of the plugin. So every error is UNKNOWN here.
"""

from __future__ import annotations

import sys
from typing import TYPE_CHECKING, Any

import click

from fatektool.cli.many.documents import check_document
from fatektool.cli.shared.output import print_json, print_stderr, with_prefix
from fatektool.cli.shared.streams import is_closed_pipe, lost_output, output_loss
from fatektool.errors import FatektoolError
from fatektool.jobs.check.result import State

if TYPE_CHECKING:
    from collections.abc import Mapping


class PluginCommand(click.Command):
    """A command that ends with 0 to 3, whatever happens."""

    def make_context(
        self, info_name: str | None, args: list[str], parent: click.Context | None = None, **extra: Any
    ) -> click.Context:
        """Read the command line; a wrong one is UNKNOWN."""
        as_json = "--json" in args
        try:
            return super().make_context(info_name, args, parent, **extra)
        except click.ClickException as error:
            raise click.exceptions.Exit(unknown(error.format_message(), as_json=as_json)) from error

    def invoke(self, ctx: click.Context) -> Any:
        """Run it; every error is UNKNOWN."""
        state = self._state(ctx, as_json=bool(ctx.params.get("as_json")))
        sys.stdout.flush()
        loss = output_loss()
        if loss is None:
            return state
        if not is_closed_pipe(loss):
            print_stderr(with_prefix("fatektool:", str(lost_output(loss)), bad=True))
        return state if state == State.CRITICAL else int(State.UNKNOWN)

    def _state(self, ctx: click.Context, *, as_json: bool) -> int:
        try:
            return int(super().invoke(ctx))
        except click.exceptions.Exit:
            raise
        except FatektoolError as error:
            return unknown(str(error), as_json=as_json)
        except click.ClickException as error:
            return unknown(error.format_message(), as_json=as_json)
        except (click.Abort, KeyboardInterrupt):
            return unknown("interrupted", as_json=as_json)
        except Exception as error:  # noqa: BLE001  # no traceback, as in the other commands
            words = f"a fault of fatektool itself: {type(error).__name__}: {error}"
            return unknown(words, as_json=as_json)


def plugin_line(state: State, words: str, figures: Mapping[str, str]) -> str:
    """``FATEK OK - words | label=value …``: a bar in the words would end them."""
    told = " ".join(words.replace("|", "/").split())
    data = " ".join(f"{label}={value}" for label, value in figures.items())
    return f"FATEK {state.name} - {told}" + (f" | {data}" if data else "")


def unknown(words: str, *, as_json: bool) -> int:
    """Print UNKNOWN with its reason; give the exit code."""
    if as_json:
        print_json(check_document(State.UNKNOWN, words, None))
    else:
        click.echo(plugin_line(State.UNKNOWN, words, {}))
    return int(State.UNKNOWN)
