"""The error of a request without an answer: what was received instead, and what to check first."""

from __future__ import annotations

from math import ceil
from typing import TYPE_CHECKING, Any, Final

from fatektool.counts import counted
from fatektool.errors import DeadlinePassed, GatewayTimeout, NoAnswer, TransportClosed
from fatektool.exchange.state import MARGIN
from fatektool.protocol.commands import PROGRAM_COMMANDS, Command
from fatektool.value import Value, frozen

if TYPE_CHECKING:
    from fatektool.errors import LineError
    from fatektool.exchange.receiver import Receiver
    from fatektool.exchange.state import LinkState
    from fatektool.protocol.commands import Request
    from fatektool.transport.base import Transport


class Effort:
    """Tries, other requests and seconds spent on one request so far.

    Args:
        state: of the link.

    Attributes:
        tries: how many times the request was sent.
    """

    def __init__(self, state: LinkState) -> None:
        self.tries = 0
        self._state = state
        self._began = state.transport.clock()
        self._exchanges = state.counters.exchanges
        self._fences = state.counters.fences

    @property
    def plc_answers(self) -> bool:
        """True if the PLC has answered fences meanwhile."""
        return self._state.counters.fences > self._fences

    @property
    def others(self) -> int:
        """The number of the link's own requests that were sent for it."""
        return self._state.counters.exchanges - self._exchanges - self.tries

    @property
    def seconds(self) -> float:
        """Seconds since the first try."""
        return self._state.transport.clock() - self._began

    def __str__(self) -> str:
        others = counted(self.others, "other request" if self.tries else "request")
        tries = counted(self.tries, "try", "tries")
        parts = ([tries] if self.tries else []) + ([others] if self.others else [])
        return f"in {' and '.join(parts)}, {self.seconds:.1f} s in total"


def no_answer(
    state: LinkState,
    receiver: Receiver,
    request: Request[Any],
    failure: LineError | None,
    effort: Effort,
    *,
    unknown: bool = False,
) -> LineError:
    """The error of a request without an answer, after a check whether that answer is only late.

    Args:
        state: of the link.
        receiver: its input.
        request: the request.
        failure: of the last try, or of the fence before it.
        effort: tries and time so far.
        unknown: True for a write that may have been made.
    """
    if isinstance(failure, TransportClosed | DeadlinePassed):
        return failure
    if not effort.plc_answers:
        receiver.listen_for_late()
    gateway = failure if isinstance(failure, GatewayTimeout) else receiver.gateway_error
    return _Report(state, receiver, request, gateway, effort, unknown).error()


@frozen
class _Report(Value):
    """What is known when no answer was received."""

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
            found += "; it is not known whether the PLC executed it"
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
            return f"its answers are late: {late_words(state.late_s, state.timeout_s)}"
        found = f"received {instead}" if instead else "nothing received"
        if self.effort.plc_answers:
            others = "loopbacks" if Command.LOOPBACK in state.codec.commands else "other requests"
            return f"it answers {others}, but not this request; {found}"
        return found

    def _advice(self) -> str:  # noqa: PLR0911  # one return for each case
        state, request, instead = self.state, self.request, self.receiver.instead
        if self.gateway:
            return str(self.gateway.hint)
        if state.late_s:
            return f"use --timeout {longer_timeout(state.late_s):g}"
        if self.receiver.wrong_number:
            return (
                "a Modbus TCP server must repeat the number, but this server or gateway does not: look for "
                "newer firmware, or for a mode that passes on RTU or ASCII (--protocol modbus-rtu)"
            )
        answers = self.effort.plc_answers
        if answers and request.command in PROGRAM_COMMANDS and request.command not in state.answered:
            from fatektool.protocol.plc_errors import PROGRAM_REFUSED

            return PROGRAM_REFUSED
        if "station" in instead:
            return "check --station"
        if "own request" in instead:
            wires = "" if over_network(state.transport) else ", that A and B are not swapped,"
            return f"the PLC does not answer: check that it is on{wires} and --station"
        if answers:
            return "the PLC is slow, or the line loses frames: try a longer --timeout or more --retries"
        if instead:
            return "check --baud, --line and --protocol, and the termination and shield of the line"
        if over_network(state.transport):
            return f"check that the PLC is on, and --station; {_DOCTOR}. {AT_AN_ETHERNET_MODULE}"
        return (
            "check that the PLC is on, the cable, station, baud and format (factory: station 1, 9600 7E1); "
            f"{_DOCTOR}"
        )


_DOCTOR: Final = "'fatektool doctor' looks for the cause"


AT_AN_ETHERNET_MODULE: Final = (
    "A FATEK Ethernet module does not answer addresses that are not permitted in it, or if its PLC takes "
    "more than 300 ms; it has 8 connections, and handles one request at a time"
)
"""Its limits [E:ethernet-limits], as a sentence without a full stop."""


def over_network(transport: Transport) -> bool:
    """True if there may be an Ethernet module between computer and PLC."""
    return transport.serial_settings is None and transport.name.startswith(("tcp://", "udp://"))


def _named(request: Request[Any]) -> str:
    return f"'{request.command.words}' ({request.command:02X})"


def late_words(late_s: float, timeout_s: float) -> str:
    """How late an answer was, as text."""
    return f"after {late_s:.2g} s (--timeout is {timeout_s:g})"


def longer_timeout(late_s: float) -> float:
    """A time-out in seconds for answers that take so long, with margin: half as much again, in tenths."""
    return ceil(max(MARGIN * late_s, late_s + 0.2) * 10) / 10
