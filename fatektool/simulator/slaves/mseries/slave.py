"""The M-series binary protocol for simulated PLCs.

::

    51 10  00 02  01 40  A1 84  55 AA       52 10  00 06  01 40 00 01 00 00  77 D5  55 AA
                  └─ station          ──────────>               └─ error

Its commands: ``slaves.fatek.commands``. The paper lists 53 without its answer; here it is that of FACON. In
the brief status only the first byte has a meaning. There is no command for the program, so 4F and 50 are
answered like every unknown command, with error 4 (M-series paper, section 2).
"""

from __future__ import annotations

from typing import TYPE_CHECKING

from fatektool.simulator.slaves.base import RequestFrame, RequestKind, SlaveType
from fatektool.simulator.slaves.fatek.commands import COMMANDS, KINDS
from fatektool.simulator.slaves.fatek.slave import FatekSlave
from fatektool.simulator.slaves.mseries import frame as mseries_frame
from fatektool.simulator.slaves.mseries.fields import MSeriesFields

if TYPE_CHECKING:
    from collections.abc import Mapping

    from fatektool.simulator.plc import SimulatedPlc
    from fatektool.simulator.slaves.fatek.fields import Fields


def _brief_status(plc: SimulatedPlc, fields: Fields) -> bytes:
    fields.end()
    return bytes((plc.status_byte(), 0, 0))


class MSeriesSlave(FatekSlave):
    """The M-series slave of one line.

    Args:
        plcs: the PLCs on the line by station.
    """

    delimiters = (mseries_frame.ANSWER, mseries_frame.TERMINATOR)
    commands = COMMANDS | {0x40: _brief_status}
    fields = MSeriesFields
    good = b"\x00"

    def __init__(self, plcs: Mapping[int, SimulatedPlc]) -> None:
        super().__init__(plcs)
        self._cutter = mseries_frame.MSeriesCutter()

    def cut(self, data: bytes) -> list[RequestFrame]:
        """Receive bytes, in any pieces; returns the requests that they complete."""
        requests = []
        for end, frame in self._cutter.feed(data):
            payload = mseries_frame.payload_of(frame)
            kind = KINDS.get(payload[1], RequestKind.OTHER)
            requests.append(RequestFrame(end, frame, payload[0], payload[1:2], payload[2:], kind))
        return requests

    def readdressed(self, answer: bytes, station: int) -> bytes:
        """The same answer from another station, with a correct CRC."""
        return mseries_frame.readdressed(answer, station)

    def reset(self) -> None:
        """Drop an incomplete request."""
        self._cutter.reset()

    def code_of(self, request: RequestFrame) -> int:
        """One byte."""
        return request.command[0]

    def framed(self, request: RequestFrame, data: bytes) -> bytes:
        """The answer to a request with this data."""
        return mseries_frame.sealed(mseries_frame.ANSWER, bytes((request.station,)) + request.command + data)

    def error(self, code: int) -> bytes:
        """One byte."""
        return bytes((code,))


MSERIES = SlaveType(MSeriesSlave, "m-series", 11)
