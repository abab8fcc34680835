"""The PLC that the options or the inventory name, and the line to it, with its messages on the terminal."""

from __future__ import annotations

from typing import TYPE_CHECKING, NamedTuple

import click

from fatektool.cli.shared.unfinished import warn_of_unfinished
from fatektool.errors import LineReadOnly

if TYPE_CHECKING:
    from contextlib import ExitStack

    from fatektool.address import PlcAddress
    from fatektool.cli.shared.output import Voice
    from fatektool.client import Plc
    from fatektool.inventory.entries import PlcEntry
    from fatektool.protocol.commands import Command
    from fatektool.transport.base import Transport
    from fatektool.transport.limit import Limit
    from fatektool.transport.shared_line import SharedLine


class Connection(NamedTuple):
    """One PLC, as the command line names it.

    Attributes:
        address: where it is and how it is asked.
        entry: its entry in the inventory; None if it was not named by one.
    """

    address: PlcAddress
    entry: PlcEntry | None = None

    def open(
        self,
        voice: Voice,
        *,
        needs: tuple[Command, ...] = (),
        writes: bool = False,
        limit: Limit | None = None,
        lend: bool = False,
        shared: SharedLine | None = None,
        finishes: bool = False,
    ) -> Plc:
        """Open the line to one PLC.

        Args:
            voice: prints details.
            needs: commands that the protocol must have.
            writes: True if something is to be written, which a read-only line refuses before it is opened.
            limit: ends everything on this line when it is over.
            lend: True to let others have the line between two rounds.
            shared: keeps the line open for the next PLC on it.
            finishes: no warning of a restore that did not complete, as this may finish it.

        Raises:
            LineReadOnly: something is to be written to a line that may only be read.
            UsageError: the protocol lacks what is needed.
            LineError: it cannot be opened.
        """
        from fatektool.connection import connect

        address = self.address
        if writes and address.read_only:
            raise LineReadOnly(f"'{click.get_current_context().command_path}' writes")
        if limit is not None:
            address = address.changed(lock_wait_s=min(address.lock_wait_s, limit.require_rest()))
        plc = connect(
            address,
            needs=needs,
            limit=limit,
            lend=lend,
            shared=shared,
            note=voice.detail,
            waiting=voice.say,
            warn=voice.warn,
        )
        if not finishes:
            warn_of_unfinished(address.target, address.station, voice)
        return plc

    def open_line(self, voice: Voice, stack: ExitStack) -> Transport:
        """Open only the line, to ask more than one PLC on it; ``stack`` closes it."""
        from fatektool.connection import open_line
        from fatektool.transport.patience import Patience

        self.address.require_consistent()
        return open_line(
            self.address,
            stack,
            note=voice.detail,
            waiting=voice.say,
            patience=Patience(self.address.timeout_s, self.address.retries, note=voice.detail),
        )
