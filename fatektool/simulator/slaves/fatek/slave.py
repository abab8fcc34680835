"""A slave of FACON or the M-series for simulated PLCs; frames and notation depend on the protocol.

No answer: to a wrong checksum or an unknown station. A broadcast (station 00) is executed by every PLC, and
none answers. An unknown command is answered with error 4.
"""

from __future__ import annotations

from abc import ABC, abstractmethod
from typing import TYPE_CHECKING, ClassVar

from fatektool.simulator.refusal import Refusal, RefusalCode
from fatektool.simulator.slaves.base import BROADCAST
from fatektool.simulator.slaves.fatek.commands import LOOPBACK, MAX_LOOPBACK

if TYPE_CHECKING:
    from collections.abc import Mapping

    from fatektool.simulator.plc import SimulatedPlc
    from fatektool.simulator.slaves.base import RequestFrame
    from fatektool.simulator.slaves.fatek.commands import Serve
    from fatektool.simulator.slaves.fatek.fields import Fields


class FatekSlave(ABC):
    """The slave of one line.

    Args:
        plcs: the PLCs on the line by station.

    Attributes:
        commands: the function of each command.
        fields: parses a request's data.
        good: the error of a valid answer.
    """

    commands: ClassVar[Mapping[int, Serve]]
    fields: ClassVar[type[Fields]]
    good: ClassVar[bytes]

    def __init__(self, plcs: Mapping[int, SimulatedPlc]) -> None:
        self.plcs = plcs

    @abstractmethod
    def code_of(self, request: RequestFrame) -> int | None:
        """The command's code; None if it is not a code."""

    @abstractmethod
    def framed(self, request: RequestFrame, data: bytes) -> bytes:
        """The answer to a request with this data."""

    @abstractmethod
    def error(self, code: int) -> bytes:
        """An error code as an answer's data."""

    def addressed(self, station: int) -> SimulatedPlc | None:
        """The PLC that answers this station."""
        return self.plcs.get(station)

    def answer(self, request: RequestFrame) -> bytes | None:
        """Execute a request; None for a broadcast and for unknown stations."""
        if request.station == BROADCAST:
            for plc in self.plcs.values():
                self.execute(plc, request)
            return None
        here = self.addressed(request.station)
        return None if here is None else self.execute(here, request)

    def execute(self, plc: SimulatedPlc, request: RequestFrame) -> bytes:
        """Execute a request in a PLC; its answer."""
        code = self.code_of(request)
        try:
            if code == LOOPBACK:
                if len(request.data) > MAX_LOOPBACK:
                    raise Refusal(RefusalCode.ILLEGAL_FORMAT)  # noqa: TRY301 - one way out for all
                return self.framed(request, request.data)
            serve = None if code is None else self.commands.get(code)
            if serve is None:
                raise Refusal(RefusalCode.ILLEGAL_FORMAT)  # noqa: TRY301 - the same
            return self.framed(request, self.good + serve(plc, self.fields(request.data)))
        except Refusal as refusal:
            return self.framed(request, self.error(refusal.code))
