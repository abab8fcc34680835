"""The FACON ASCII protocol over simulated PLCs: one method a command.

::

    02 '01' '4F' '0005'  LRC 03          02 '01' '4F' '0' 256 hex  LRC 03
       └─ station           ──────────>     error character ─┘

    code  data                              answer after the error character
    40    -                                 3 status bytes
    41    1 run, 0 stop
    42    code, discrete                    code 1 disable 2 enable 3 set 4 reset
    43    n, discrete                       n characters, 1 = disabled
    44    n, discrete                       n characters
    45    n, discrete, n characters
    46    n, register                       n values
    47    n, register, n values
    48    n, n elements                     n values
    49    n, n x (element, value)
    4E    0..256 characters                 the same, without an error character
    4F    page (4 hex)                      256 hex
    50    page, 256 hex
    53    -                                 128 hex

Silent: a wrong LRC, a station that is not here, hex digits of station or LRC that are none. A
broadcast (station 00) is executed by every PLC and answered by none, refused or not. A command that
is unknown, of whatever two characters, is answered with error 4 under its own characters. The form of
a request is checked first, field by field from the left (see ``facon_fields``), its addresses last,
and nothing is written unless all of it is right (FACON paper, sections 2 to 4).
"""

from __future__ import annotations

from functools import lru_cache, partial
from struct import pack
from typing import TYPE_CHECKING

from fatektool.simulator.memory import DiscreteAction
from fatektool.simulator.models import DEFAULT_MODEL, PAGE_BYTES
from fatektool.simulator.refusal import Refusal, RefusalCode
from fatektool.simulator.slaves.base import BROADCAST, Request, RequestKind, SlaveType, addressed
from fatektool.simulator.slaves.facon import frame as facon_frame
from fatektool.simulator.slaves.facon.fields import VALUE_CHARACTERS, Fields, hex_value

if TYPE_CHECKING:
    from collections.abc import Callable, Mapping

    from fatektool.simulator.elements import Kind
    from fatektool.simulator.plc import SimulatedPlc

MAX_DISCRETES = 256
MAX_WORDS = 64
MAX_MIXED_WRITE_WORDS = 32
MAX_LOOPBACK = 256
_LOOPBACK = b"4E"
_CHARACTER_OF_STATE = bytes.maketrans(b"\x00\x01", b"01")
_KIND_OF_COMMAND = {
    b"42": RequestKind.WRITE,
    b"45": RequestKind.WRITE,
    b"47": RequestKind.WRITE,
    b"49": RequestKind.WRITE,
    _LOOPBACK: RequestKind.LOOPBACK,
    b"50": RequestKind.PAGE_WRITE,
}


class FaconSlave:
    """One line's FACON slave.

    Args:
        plcs: the PLCs on the line by station.
        error_character: False leaves the error character out of good answers to 4F and 53, as the
            paper's figures draw them; its worked example has it.
    """

    delimiters = (b"\x02", b"\x03")

    def __init__(self, plcs: Mapping[int, SimulatedPlc], *, error_character: bool = True) -> None:
        self.plcs = plcs
        self._cutter = facon_frame.FrameCutter()
        self._good = b"0" if error_character else b""

    def cut(self, data: bytes) -> list[Request]:
        """Take bytes, whatever the chunking; give the requests that they complete."""
        requests = []
        for end, frame in self._cutter.feed(data):
            station = facon_frame.station_of(frame)
            if station is not None:
                command = frame[3:5]
                kind = _KIND_OF_COMMAND.get(command, RequestKind.OTHER)
                requests.append(Request(end, frame, station, command, frame[5:-3], kind))
        return requests

    def answer(self, request: Request) -> bytes | None:
        """Execute a request; None for a broadcast and for stations that are not here."""
        if request.station == BROADCAST:
            for plc in self.plcs.values():
                self._execute(plc, request)
            return None
        here = addressed(self.plcs, request.station)
        return None if here is None else self._execute(here, request)

    def readdressed(self, answer: bytes, station: int) -> bytes:
        """The same answer as another station would send it, its LRC right."""
        return facon_frame.readdressed(answer, station)

    def reset(self) -> None:
        """Forget an unfinished request."""
        self._cutter.reset()

    def _execute(self, plc: SimulatedPlc, request: Request) -> bytes:
        head = request.raw[:5]
        data = request.data
        command = request.command
        try:
            if command == b"4F":  # first and cached: a whole program is read by it
                return _page_answer(head + self._good, plc.read_page(_page_number(data)))
            if command == _LOOPBACK:
                if len(data) > MAX_LOOPBACK:
                    raise Refusal(RefusalCode.ILLEGAL_FORMAT)  # noqa: TRY301 - one way out for all
                return request.raw
            if command == b"53":
                Fields(data).end()
                return facon_frame.sealed(head + self._good + _hex(plc.detailed_status()))
            serve = _COMMANDS.get(command)
            if serve is None:
                raise Refusal(RefusalCode.ILLEGAL_FORMAT)  # noqa: TRY301 - the same
            return facon_frame.sealed(head + b"0" + serve(plc, Fields(data)))
        except Refusal as refusal:
            return facon_frame.sealed(head + b"%X" % refusal.code)


def _brief_status(plc: SimulatedPlc, fields: Fields) -> bytes:
    fields.end()
    return _hex(plc.brief_status())


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


def _read_disabled(plc: SimulatedPlc, fields: Fields) -> bytes:
    count = fields.count(MAX_DISCRETES)
    kind, address = fields.element(1)
    fields.end()
    return plc.read_disabled(kind.symbol, address, count).translate(_CHARACTER_OF_STATE)


def _read_discretes(plc: SimulatedPlc, fields: Fields) -> bytes:
    count = fields.count(MAX_DISCRETES)
    kind, address = fields.element(1)
    fields.end()
    return plc.read_discretes(kind.symbol, address, count).translate(_CHARACTER_OF_STATE)


def _write_discretes(plc: SimulatedPlc, fields: Fields) -> bytes:
    count = fields.count(MAX_DISCRETES)
    kind, address = fields.element(1)
    states = fields.states(count)
    fields.end()
    plc.write_discretes(kind.symbol, address, states)
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
    values = plc.read_words(kind.symbol, address, count)
    return _hex(pack(f">{count}{'I' if kind.bits == 32 else 'H'}", *values))


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
        b"%0*X" % (VALUE_CHARACTERS[kind.bits], value)
        for (kind, _), value in zip(elements, values, strict=True)
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


def _write_page(plc: SimulatedPlc, fields: Fields) -> bytes:
    number = fields.take(4)
    text = fields.take(2 * PAGE_BYTES)
    fields.end()
    page = hex_value(number)
    hex_value(text)
    plc.write_page(page, bytes.fromhex(text.decode("ascii")))
    return b""


def _page_number(data: bytes) -> int:
    if len(data) != 4:
        raise Refusal(RefusalCode.ILLEGAL_FORMAT)
    return hex_value(data)


@lru_cache(maxsize=2048)
def _page_answer(head: bytes, page: bytes) -> bytes:
    return facon_frame.sealed(head + _hex(page))


def _hex(data: bytes) -> bytes:
    return data.hex().upper().encode("ascii")


_COMMANDS: dict[bytes, Callable[[SimulatedPlc, Fields], bytes]] = {
    b"40": _brief_status,
    b"41": _run_stop,
    b"42": _control_discrete,
    b"43": _read_disabled,
    b"44": _read_discretes,
    b"45": _write_discretes,
    b"46": _read_registers,
    b"47": _write_registers,
    b"48": _read_mixed,
    b"49": _write_mixed,
    b"50": _write_page,
}

FACON = SlaveType(FaconSlave, DEFAULT_MODEL, 10, partial(FaconSlave, error_character=False))
