"""The M-series binary protocol over simulated PLCs: one function a command.

::

    51 10  00 02  01 40  A1 84  55 AA       52 10  00 06  01 40 00 01 00 00  77 D5  55 AA
                  └─ station          ──────────>               └─ error

    code  data                              answer after the error
    40    -                                 3 status bytes
    41    01 run, 00 stop
    42    code, discrete                    code 1 disable 2 enable 3 set 4 reset
    43    n, discrete                       n bytes, 01 = disabled
    44    n, discrete                       n bytes
    45    n, discrete, n bytes
    46    n, register                       n values
    47    n, register, n values
    48    n, n elements                     n values
    49    n, n x (element, value)
    4E    0..256 bytes                      the same, without an error byte
    53    -                                 64 bytes

The paper lists 53 without its answer; here it is the one of FACON. Of the brief status only the first byte
says something. There is no command for the program, so that 4F and 50 are answered as every unknown one is,
with error 4.

Silent: a wrong CRC or terminator, a station that is not here. A broadcast (station 00) is executed by every
PLC and answered by none, refused or not. The form of a request is checked first, field by field from the left
(see ``mseries_fields``), its addresses last, and nothing is written unless all of it is right (M-series
paper, section 2).
"""

from __future__ import annotations

from struct import pack
from typing import TYPE_CHECKING

from fatektool.simulator.memory import DiscreteAction
from fatektool.simulator.refusal import Refusal, RefusalCode
from fatektool.simulator.slaves.base import BROADCAST, Request, RequestKind, SlaveType
from fatektool.simulator.slaves.mseries import frame as mseries_frame
from fatektool.simulator.slaves.mseries.fields import Fields, value_bytes

if TYPE_CHECKING:
    from collections.abc import Callable, Mapping

    from fatektool.simulator.elements import Kind
    from fatektool.simulator.plc import SimulatedPlc

MAX_DISCRETES = 256
MAX_WORDS = 64
MAX_MIXED_WRITE_WORDS = 32
MAX_LOOPBACK = 256
_LOOPBACK = b"\x4e"
_KIND_OF_COMMAND = {
    b"\x42": RequestKind.WRITE,
    b"\x45": RequestKind.WRITE,
    b"\x47": RequestKind.WRITE,
    b"\x49": RequestKind.WRITE,
    _LOOPBACK: RequestKind.LOOPBACK,
}


class MSeriesSlave:
    """One line's M-series slave.

    Args:
        plcs: the PLCs on the line by station.
    """

    delimiters = (mseries_frame.ANSWER, mseries_frame.TERMINATOR)

    def __init__(self, plcs: Mapping[int, SimulatedPlc]) -> None:
        self.plcs = plcs
        self._cutter = mseries_frame.FrameCutter()

    def cut(self, data: bytes) -> list[Request]:
        """Take bytes, whatever the chunking; give the requests that they complete."""
        requests = []
        for end, frame in self._cutter.feed(data):
            payload = mseries_frame.payload_of(frame)
            command = payload[1:2]
            kind = _KIND_OF_COMMAND.get(command, RequestKind.OTHER)
            requests.append(Request(end, frame, payload[0], command, payload[2:], kind))
        return requests

    def answer(self, request: Request) -> bytes | None:
        """Execute a request; None for a broadcast and for stations that are not here."""
        if request.station == BROADCAST:
            for plc in self.plcs.values():
                _execute(plc, request)
            return None
        addressed = self.plcs.get(request.station)
        return None if addressed is None else _execute(addressed, request)

    def readdressed(self, answer: bytes, station: int) -> bytes:
        """The same answer as another station would send it, its CRC right."""
        return mseries_frame.readdressed(answer, station)

    def reset(self) -> None:
        """Forget an unfinished request."""
        self._cutter.reset()


def _execute(plc: SimulatedPlc, request: Request) -> bytes:
    head = bytes((request.station,)) + request.command
    try:
        if request.command == _LOOPBACK:
            if len(request.data) > MAX_LOOPBACK:
                raise Refusal(RefusalCode.ILLEGAL_FORMAT)  # noqa: TRY301 - one way out for all
            return mseries_frame.sealed(mseries_frame.ANSWER, head + request.data)
        serve = _COMMANDS.get(request.command)
        if serve is None:
            raise Refusal(RefusalCode.ILLEGAL_FORMAT)  # noqa: TRY301 - the same
        answer = b"\x00" + serve(plc, Fields(request.data))
    except Refusal as refusal:
        answer = bytes((refusal.code,))
    return mseries_frame.sealed(mseries_frame.ANSWER, head + answer)


def _brief_status(plc: SimulatedPlc, fields: Fields) -> bytes:
    fields.end()
    return bytes((plc.status_byte(), 0, 0))


def _detailed_status(plc: SimulatedPlc, fields: Fields) -> bytes:
    fields.end()
    return plc.detailed_status()


def _run_stop(plc: SimulatedPlc, fields: Fields) -> bytes:
    wanted = fields.code(0, 1)
    fields.end()
    if wanted:
        plc.run()
    else:
        plc.stop()
    return b""


def _control_discrete(plc: SimulatedPlc, fields: Fields) -> bytes:
    action = DiscreteAction(fields.code(1, 4))
    kind, address = fields.element(1)
    fields.end()
    plc.control_discrete(action, kind.symbol, address)
    return b""


def _discretes(fields: Fields) -> tuple[int, str, int]:
    count = fields.count(MAX_DISCRETES)
    kind, address = fields.element(1)
    return count, kind.symbol, address


def _read_disabled(plc: SimulatedPlc, fields: Fields) -> bytes:
    count, symbol, address = _discretes(fields)
    fields.end()
    return plc.read_disabled(symbol, address, count)


def _read_discretes(plc: SimulatedPlc, fields: Fields) -> bytes:
    count, symbol, address = _discretes(fields)
    fields.end()
    return plc.read_discretes(symbol, address, count)


def _write_discretes(plc: SimulatedPlc, fields: Fields) -> bytes:
    count, symbol, address = _discretes(fields)
    states = fields.states(count)
    fields.end()
    plc.write_discretes(symbol, address, states)
    return b""


def _registers(fields: Fields) -> tuple[int, Kind, int]:
    count = fields.count(MAX_WORDS)
    kind, address = fields.element(16, 32)
    if count * kind.words > MAX_WORDS:
        raise Refusal(RefusalCode.ILLEGAL_VALUE)
    return count, kind, address


def _read_registers(plc: SimulatedPlc, fields: Fields) -> bytes:
    count, kind, address = _registers(fields)
    fields.end()
    return pack(f">{count}{'I' if kind.bits == 32 else 'H'}", *plc.read_words(kind.symbol, address, count))


def _write_registers(plc: SimulatedPlc, fields: Fields) -> bytes:
    count, kind, address = _registers(fields)
    values = fields.values(kind, count)
    fields.end()
    plc.write_words(kind.symbol, address, values)
    return b""


def _read_mixed(plc: SimulatedPlc, fields: Fields) -> bytes:
    elements = [fields.element(1, 16, 32) for _ in range(fields.count(MAX_WORDS))]
    fields.end()
    if sum(kind.words for kind, _ in elements) > MAX_WORDS:
        raise Refusal(RefusalCode.ILLEGAL_VALUE)
    values = plc.read_mixed((kind.symbol, address) for kind, address in elements)
    return b"".join(
        value.to_bytes(value_bytes(kind), "big") for (kind, _), value in zip(elements, values, strict=True)
    )


def _write_mixed(plc: SimulatedPlc, fields: Fields) -> bytes:
    writes = []
    words = 0
    for _ in range(fields.count(MAX_MIXED_WRITE_WORDS)):
        kind, address = fields.element(1, 16, 32)
        value = fields.states(1)[0] if kind.bits == 1 else fields.values(kind, 1)[0]
        writes.append((kind.symbol, address, value))
        words += kind.words
    fields.end()
    if words > MAX_MIXED_WRITE_WORDS:
        raise Refusal(RefusalCode.ILLEGAL_VALUE)
    plc.write_mixed(writes)
    return b""


_COMMANDS: dict[bytes, Callable[[SimulatedPlc, Fields], bytes]] = {
    b"\x40": _brief_status,
    b"\x41": _run_stop,
    b"\x42": _control_discrete,
    b"\x43": _read_disabled,
    b"\x44": _read_discretes,
    b"\x45": _write_discretes,
    b"\x46": _read_registers,
    b"\x47": _write_registers,
    b"\x48": _read_mixed,
    b"\x49": _write_mixed,
    b"\x53": _detailed_status,
}

MSERIES = SlaveType(MSeriesSlave, "m-series", 11)
