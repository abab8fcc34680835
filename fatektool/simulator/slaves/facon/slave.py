"""The FACON ASCII protocol for simulated PLCs.

::

    02 '01' '4F' '0005'  LRC 03          02 '01' '4F' '0' 256 hex  LRC 03
       └─ station           ──────────>     error character ─┘

    code  data                              answer after the error character
    4F    page (4 hex)                      256 hex
    50    page, 256 hex

All other commands: ``slaves.fatek.commands``. An unknown command, of whatever two characters, is answered
with error 4 and its own characters. There is no answer if station or LRC are not hex digits (FACON paper,
sections 2 to 4).
"""

from __future__ import annotations

from functools import lru_cache, partial
from typing import TYPE_CHECKING

from fatektool.simulator.models import DEFAULT_MODEL, PAGE_BYTES
from fatektool.simulator.refusal import Refusal, RefusalCode
from fatektool.simulator.slaves.base import RequestFrame, RequestKind, SlaveType, addressed
from fatektool.simulator.slaves.facon import frame as facon_frame
from fatektool.simulator.slaves.facon.fields import FaconFields, require_hex, to_hex
from fatektool.simulator.slaves.fatek.commands import COMMANDS, KINDS
from fatektool.simulator.slaves.fatek.slave import FatekSlave

if TYPE_CHECKING:
    from collections.abc import Mapping

    from fatektool.simulator.plc import SimulatedPlc
    from fatektool.simulator.slaves.fatek.fields import Fields

_READ_PAGE = b"4F"
_DETAILED_STATUS = b"53"
_KINDS = {facon_frame.HEX2[code]: kind for code, kind in (KINDS | {0x50: RequestKind.PAGE_WRITE}).items()}


def _brief_status(plc: SimulatedPlc, fields: Fields) -> bytes:
    fields.end()
    return fields.written(plc.brief_status())


def _write_page(plc: SimulatedPlc, fields: Fields) -> bytes:
    number = fields.take(4)
    text = fields.take(2 * PAGE_BYTES)
    fields.end()
    require_hex(number + text)
    plc.write_page(int(number, 16), bytes.fromhex(text.decode("ascii")))
    return b""


class FaconSlave(FatekSlave):
    """The FACON slave of one line.

    Args:
        plcs: the PLCs on the line by station.
        error_character: False for answers to 4F and 53 without the error character, as in the paper's
            figures; its example has it.
    """

    delimiters = (b"\x02", b"\x03")
    commands = COMMANDS | {0x40: _brief_status, 0x50: _write_page}
    fields = FaconFields
    good = b"0"

    def __init__(self, plcs: Mapping[int, SimulatedPlc], *, error_character: bool = True) -> None:
        super().__init__(plcs)
        self._cutter = facon_frame.FaconCutter()
        self._good_if_any = b"0" if error_character else b""

    def cut(self, data: bytes) -> list[RequestFrame]:
        """Receive bytes, in any pieces; returns the requests that they complete."""
        requests = []
        for end, frame in self._cutter.feed(data):
            station = facon_frame.station_of(frame)
            if station is not None:
                command = frame[3:5]
                kind = _KINDS.get(command, RequestKind.OTHER)
                requests.append(RequestFrame(end, frame, station, command, frame[5:-3], kind))
        return requests

    def readdressed(self, answer: bytes, station: int) -> bytes:
        """The same answer from another station, with a correct LRC."""
        return facon_frame.readdressed(answer, station)

    def reset(self) -> None:
        """Drop an incomplete request."""
        self._cutter.reset()

    def addressed(self, station: int) -> SimulatedPlc | None:
        """The PLC with this number, else one whose station check is off."""
        return addressed(self.plcs, station)

    def code_of(self, request: RequestFrame) -> int | None:
        """From two hex digits; None if they are not."""
        return facon_frame.BYTE_OF.get(request.command)

    def framed(self, request: RequestFrame, data: bytes) -> bytes:
        """The answer to a request with this data."""
        return facon_frame.sealed(_head(request) + data)

    def error(self, code: int) -> bytes:
        """One hex digit."""
        return b"%X" % code

    def execute(self, plc: SimulatedPlc, request: RequestFrame) -> bytes:
        """Execute a request in a PLC; its answer. Those to 4F and 53 may have no error character."""
        command = request.command
        if command not in {_READ_PAGE, _DETAILED_STATUS}:
            return super().execute(plc, request)
        head = _head(request) + self._good_if_any
        try:
            if command == _READ_PAGE:  # cached: a whole program is read by it
                return _page_answer(head, plc.read_page(_page_number(request.data)))
            FaconFields(request.data).end()
            return facon_frame.sealed(head + to_hex(plc.detailed_status()))
        except Refusal as refusal:
            return self.framed(request, self.error(refusal.code))


def _head(request: RequestFrame) -> bytes:
    """STX, the station in upper case, the command as it was sent."""
    return b"\x02" + facon_frame.HEX2[request.station] + request.command


def _page_number(data: bytes) -> int:
    if len(data) != 4:
        raise Refusal(RefusalCode.ILLEGAL_FORMAT)
    require_hex(data)
    return int(data, 16)


@lru_cache(maxsize=2048)
def _page_answer(head: bytes, page: bytes) -> bytes:
    return facon_frame.sealed(head + to_hex(page))


FACON = SlaveType(FaconSlave, DEFAULT_MODEL, 10, partial(FaconSlave, error_character=False))
