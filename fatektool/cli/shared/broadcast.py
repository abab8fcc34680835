"""``-s 0 --broadcast``: a write to every PLC on the line. PLCs do not reply to it."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any, TypeVar

import click

from fatektool.cli.shared.documents import broadcast_document
from fatektool.cli.shared.questions import confirm
from fatektool.counts import counted
from fatektool.errors import UsageError

if TYPE_CHECKING:
    from collections.abc import Callable, Sequence

    from fatektool.cli.shared.connection import Connection
    from fatektool.cli.shared.output import Voice
    from fatektool.protocol.commands import Request

F = TypeVar("F", bound="Callable[..., Any]")


def broadcast_option(function: F) -> F:
    """``--broadcast``, for a command that needs no answer; the command gets ``broadcast``."""
    return click.option(
        "--broadcast",
        is_flag=True,
        help="With -s 0: to every PLC on the line. They do not reply, so success cannot be checked.",
    )(function)


def means_all(connection: Connection, *, broadcast: bool) -> bool:
    """True if every PLC on the line is meant. It takes both, station 0 and the option.

    Raises:
        UsageError: the option without the station.
    """
    if broadcast and connection.address.station != 0:
        raise UsageError(
            f"--broadcast is for every PLC on the line: expected station 0, got {connection.address.station}",
            hint="add -s 0, or leave out --broadcast",
        )
    return broadcast


def send_to_all(
    connection: Connection, voice: Voice, command: str, requests: Sequence[Request[None]], *, yes: bool
) -> None:
    """Ask, send, and say that success cannot be checked.

    Args:
        connection: the line.
        voice: asks and reports.
        command: what is sent, in a word or two.
        requests: writes.
        yes: do not ask.

    Raises:
        UsageError: the user does not agree, or the line is read-only; nothing was sent.
        LineError: the line is not there or failed; some of them may be sent.
    """
    any_station = connection.address.changed(station=1)  # a line is opened with one; which does not matter
    with connection._replace(address=any_station).open(voice, writes=True) as plc:
        question = f"Send '{command}' to every PLC on {connection.address.target}?"
        if not confirm(question, yes=yes):
            raise UsageError("Aborted. Nothing was sent.")
        for request in requests:
            plc.broadcast(request)
        document = broadcast_document(plc, command, len(requests))
    count = counted(len(requests), "request")
    sent = f"'{command}': {count} sent to every PLC on the line"
    voice.show(document, [sent, "PLCs do not reply to broadcasts, so success cannot be checked"])
