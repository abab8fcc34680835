"""RUN and STOP (command 41), and the mode read back, which alone proves it."""

from __future__ import annotations

from typing import TYPE_CHECKING, Final

from fatektool.errors import PlcError, PlcRefused
from fatektool.protocol.commands import ReadBriefStatus, RunStop

if TYPE_CHECKING:
    from fatektool.exchange.link import Link

_TRIES: Final = 20
"""A PLC may need a scan or two."""


def set_mode(link: Link, *, run: bool) -> None:
    """Start or stop the program, then read the mode back until it is that, at most for the PLC's time-out.

    Raises:
        PlcError: acknowledged, but the PLC is in the other mode, or its mode cannot be read.
    """
    link.ask(RunStop(run))
    clock = link.transport.clock
    deadline = clock() + link.timeout_s
    word, other = ("RUN", "STOP") if run else ("STOP", "RUN")
    for _ in range(_TRIES):
        try:
            flags = link.ask(ReadBriefStatus()).flags
        except PlcRefused as error:
            raise PlcError(
                f"the PLC acknowledged {word}, but its mode cannot be read back: {error.message}",
                hint="look at the RUN lamp of the PLC",
            ) from error
        if flags.running == run:
            return
        if clock() > deadline:
            break
    raise PlcError(
        f"the PLC acknowledged {word}, but its status is still {other}",
        hint="see 'fatektool status': an emergency stop or the switch of the PLC may prevent it",
    )
