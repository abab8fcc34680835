"""The error of a request that found no answer: what was received instead, and what to check first."""

from __future__ import annotations

from dataclasses import dataclass
from math import ceil
from typing import TYPE_CHECKING, Any, Final

from fatektool.errors import DeadlinePassed, GatewayTimeout, NoAnswer, TransportClosed
from fatektool.exchange.state import MARGIN
from fatektool.protocol.commands import PROGRAM_COMMANDS, Command
from fatektool.value import Value

if TYPE_CHECKING:
    from fatektool.errors import LineError
    from fatektool.exchange.receiver import Receiver
    from fatektool.exchange.state import LinkState
    from fatektool.protocol.commands import Request
    from fatektool.transport.base import Transport


class Effort:
    """What one request has cost so far: tries, other requests, seconds.

    Args:
        state: of the link.

    Attributes:
        tries: how often the request was sent.
    """

    def __init__(self, state: LinkState) -> None:
        self.tries = 0
        self._state = state
        self._began = state.transport.clock()
        self._exchanges = state.counters.exchanges
        self._fences = state.counters.fences

    @property
    def plc_answers(self) -> bool:
        """True if the PLC has answered fences in between."""
        return self._state.counters.fences > self._fences

    @property
    def others(self) -> int:
        """How many requests of the link's own were sent beside it."""
        return self._state.counters.exchanges - self._exchanges - self.tries

    @property
    def seconds(self) -> float:
        """How long it has taken."""
        return self._state.transport.clock() - self._began

    def __str__(self) -> str:
        others = f"{self.others}{' other' if self.tries else ''} request{'' if self.others == 1 else 's'}"
        tries = f"{self.tries} {'try' if self.tries == 1 else 'tries'}"
        parts = ([tries] if self.tries else []) + ([others] if self.others else [])
        return f"in {' and '.join(parts)}, {self.seconds:.1f} s in all"


def no_answer(
    state: LinkState,
    receiver: Receiver,
    request: Request[Any],
    failure: LineError | None,
    effort: Effort,
    *,
    unknown: bool = False,
) -> LineError:
    """The error of a request that found no answer, after a look whether that answer is only late.

    Args:
        state: of the link.
        receiver: its input.
        request: what was asked.
        failure: of the last try, or of the fence before it.
        effort: what it has cost.
        unknown: True for a write that may have been made.
    """
    if isinstance(failure, TransportClosed | DeadlinePassed):
        return failure
    if not effort.plc_answers:
        receiver.listen_for_late()
    gateway = failure if isinstance(failure, GatewayTimeout) else receiver.gateway_error
    return _Report(state, receiver, request, gateway, effort, unknown).error()


@dataclass(frozen=True, slots=True, eq=False, repr=False)
class _Report(Value):
    state: LinkState
    receiver: Receiver
    request: Request[Any]
    gateway: GatewayTimeout | None
    effort: Effort
    unknown: bool

    def error(self) -> NoAnswer:
        state, request = self.state, self.request
        asked = _named(request)
        probe = state.codec.probe
        if not self.effort.tries and probe.command != request.command:  # it was never sent
            asked = f"{_named(probe)}, which is sent before {_named(request)}"
        found = self._found()
        if self.unknown:
            found += "; whether the PLC took it is not known"
        elif request.writes and not self.effort.tries:
            found += "; nothing was written"
        return NoAnswer(
            f"no answer from station {state.station} on {state.transport.name} "
            f"({state.transport.serial_settings or state.codec.name}) to {asked} {self.effort}: {found}",
            hint=self._advice(),
            station=state.station,
            target=state.transport.name,
            heard=self.receiver.instead or None,
            late_s=round(state.late_s, 3) if state.late_s else None,
        )

    def _found(self) -> str:
        state, instead = self.state, self.receiver.instead
        if self.gateway:
            return self.gateway.message
        if state.late_s:
            return f"its answers come late: {late_words(state.late_s, state.timeout_s)}"
        found = f"received {instead}" if instead else "nothing received"
        if self.effort.plc_answers:
            others = "loopbacks" if Command.LOOPBACK in state.codec.commands else "other requests"
            return f"it answers {others}, but not this request; {found}"
        return found

    def _advice(self) -> str:  # noqa: PLR0911  # a way out a case
        state, request, instead = self.state, self.request, self.receiver.instead
        if self.gateway:
            return str(self.gateway.hint)
        if state.late_s:
            return f"give --timeout {longer_timeout(state.late_s):g}"
        if self.receiver.wrong_number:
            return (
                "a Modbus TCP server must repeat the number: this server or gateway does not; look for newer "
                "firmware, or for a mode in which it passes RTU or ASCII on (--protocol modbus-rtu)"
            )
        answers = self.effort.plc_answers
        if answers and request.command in PROGRAM_COMMANDS and request.command not in state.answered:
            from fatektool.protocol.plc_errors import PROGRAM_REFUSED

            return PROGRAM_REFUSED
        if "station" in instead:
            return "check --station"
        if "own request" in instead:
            return "the PLC is silent: is it on, are A and B the right way round, is the station right?"
        if answers:
            return "the PLC is slow or the line loses frames: try a longer --timeout, more --retries"
        if instead:
            return "check --baud, --format and --protocol, and the line's termination and shield"
        if over_network(state.transport):
            return f"is the PLC on, its station right? {AT_AN_ETHERNET_MODULE}"
        return "is the PLC on and the cable in? Check station, baud and format (factory: station 1, 9600 7E1)"


AT_AN_ETHERNET_MODULE: Final = (
    "A FATEK Ethernet module does not answer an address that it does not permit, nor when its PLC takes more "
    "than 300 ms; it serves 8 connections, and one request at a time"
)
"""Its limits, [E:ethernet-limits], as a sentence without its full stop."""


def over_network(transport: Transport) -> bool:
    """True if there may be an Ethernet module in between."""
    return transport.serial_settings is None and transport.name.startswith(("tcp://", "udp://"))


def _named(request: Request[Any]) -> str:
    return f"'{request.command.words}' ({request.command:02X})"


def late_words(late_s: float, timeout_s: float) -> str:
    """How late an answer came."""
    return f"after {late_s:.2g} s, and --timeout is {timeout_s:g}"


def longer_timeout(late_s: float) -> float:
    """A time-out in seconds for answers that take so long, with margin: half as much again, in tenths."""
    return ceil(max(MARGIN * late_s, late_s + 0.2) * 10) / 10
