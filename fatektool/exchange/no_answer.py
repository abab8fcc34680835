"""What to say when no answer came: what was heard instead, and what to look at first."""

from __future__ import annotations

from dataclasses import dataclass
from math import ceil
from typing import TYPE_CHECKING, Any, Final

from fatektool.errors import GatewayTimeout, NoAnswer
from fatektool.protocol.commands import Command
from fatektool.protocol.plc_errors import PROGRAM_COMMANDS, PROGRAM_REFUSED

if TYPE_CHECKING:
    from fatektool.errors import FatektoolError
    from fatektool.exchange.link import Link
    from fatektool.protocol.commands import Request

ROOM: Final = 1.5
"""Of the longest time that an answer was seen to take, so much is waited for, or given as a time-out."""


class Account:
    """What one question has cost so far.

    Args:
        link: where it is asked.

    Attributes:
        tries: how often it was sent.
    """

    def __init__(self, link: Link) -> None:
        self.tries = 0
        self._link = link
        self._began = link.transport.clock()
        self._exchanges = link.counters.exchanges
        self._fences = link.counters.fences

    @property
    def alive(self) -> bool:
        """True if the PLC has answered fences in between."""
        return self._link.counters.fences > self._fences

    @property
    def others(self) -> int:
        """How many requests of the link's own were sent beside it."""
        return self._link.counters.exchanges - self._exchanges - self.tries

    @property
    def seconds(self) -> float:
        """How long it has taken."""
        return self._link.transport.clock() - self._began

    def __str__(self) -> str:
        others = f"{self.others}{' other' if self.tries else ''} request{'' if self.others == 1 else 's'}"
        tries = f"{self.tries} {'try' if self.tries == 1 else 'tries'}"
        parts = ([tries] if self.tries else []) + ([others] if self.others else [])
        return f"in {' and '.join(parts)}, {self.seconds:.1f} s in all"


@dataclass(frozen=True, slots=True)
class Silence:
    """A request that found no answer to trust.

    Args:
        link: where; what was heard on it.
        request: what was asked.
        failure: of the last try, or of the fence before it.
        account: what it has cost.
        unknown: True for a write that may have been made.
    """

    link: Link
    request: Request[Any]
    failure: FatektoolError | None
    account: Account
    unknown: bool = False

    def error(self) -> NoAnswer:
        """The error that says so."""
        link = self.link
        asked = f"{_named(self.request)}"
        before = link.codec.probe.command
        if not self.account.tries and before != self.request.command:  # what had to be known was not learnt
            asked = f"{_named(link.codec.probe)}, which goes before {_named(self.request)}"
        told = self._heard()
        if self.unknown:
            told += "; whether the PLC took it is not known"
        elif self.request.writes and not self.account.tries:
            told += "; nothing was written"
        late_s = link.hearing.late_s
        return NoAnswer(
            f"no answer from station {link.station} on {link.transport.name} "
            f"({link.transport.line or link.codec.name}) to {asked} {self.account}: {told}",
            hint=self._advice(),
            station=link.station,
            target=link.transport.name,
            heard=link.hearing.words or None,
            late_s=round(late_s, 3) if late_s else None,
        )

    @property
    def _gateway(self) -> GatewayTimeout | None:
        """What a gateway said; of a write that was read back in vain, to the read."""
        return self.failure if isinstance(self.failure, GatewayTimeout) else self.link.hearing.gateway

    def _heard(self) -> str:
        link, words = self.link, self.link.hearing.words
        if self._gateway:
            return self._gateway.message
        if link.hearing.late_s:
            return f"its answers come, but late: {late_words(link.hearing.late_s, link.timeout_s)}"
        heard = f"heard {words}" if words else "nothing heard"
        if self.account.alive:
            fences = "loopbacks" if Command.LOOPBACK in link.codec.commands else "other questions"
            return f"it answers {fences}, but not this; {heard}"
        return heard

    def _advice(self) -> str:  # noqa: PLR0911  # a way out a case
        link, request, heard = self.link, self.request, self.link.hearing.words
        if self._gateway:
            return str(self._gateway.hint)
        if link.hearing.late_s:
            return f"give --timeout {longer_timeout(link.hearing.late_s):g}"
        if link.hearing.misnumbered:
            return (
                "a Modbus TCP server must repeat the number: this server or gateway does not; look for newer "
                "firmware, or for a mode in which it passes RTU or ASCII on (--protocol modbus-rtu)"
            )
        alive = self.account.alive
        if alive and request.command in PROGRAM_COMMANDS and request.command not in link.answered:
            return PROGRAM_REFUSED
        if "station" in heard:
            return "check --station"
        if "own request" in heard:
            return "the PLC is silent: is it on, are A and B the right way round, is the station right?"
        if alive:
            return "the PLC is slow or the line loses frames: try a longer --timeout, more --retries"
        if heard:
            return "check --baud, --format and --protocol, and the line's termination and shield"
        if over_network(link):
            return f"is the PLC on, its station right? {AT_AN_ETHERNET_MODULE}"
        return "is the PLC on and the cable in? Check station, baud and format (factory: station 1, 9600 7E1)"


AT_AN_ETHERNET_MODULE: Final = (
    "A FATEK Ethernet module is silent to an address that it does not permit, and where its PLC takes more "
    "than 300 ms; it serves 8 connections, and one request at a time"
)
"""Its limits, [E:ethernet-limits], as a sentence without its full stop."""


def over_network(link: Link) -> bool:
    """True if there may be an Ethernet module in between."""
    return link.transport.line is None and link.transport.name.startswith(("tcp://", "udp://"))


def _named(request: Request[Any]) -> str:
    return f"'{request.command.words}' ({request.command:02X})"


def late_words(late_s: float, timeout_s: float) -> str:
    """How late an answer came."""
    return f"after {late_s:.2g} s, and --timeout is {timeout_s:g}"


def longer_timeout(late_s: float) -> float:
    """A time-out in seconds for answers that take so long, with room: half as much again, in tenths."""
    return ceil(max(ROOM * late_s, late_s + 0.2) * 10) / 10
