"""The commands of FACON and the M-series: one function for each.

::

    code  data                              answer after the error
    40    -                                 3 status bytes
    41    1 run, 0 stop
    42    code, discrete                    code 1 disable 2 enable 3 set 4 reset
    43    n, discrete                       n states, 1 = disabled
    44    n, discrete                       n states
    45    n, discrete, n states
    46    n, register                       n values
    47    n, register, n values
    48    n, n elements                     n values
    49    n, n x (element, value)
    4E    0..256 bytes                      the same, without an error
    53    -                                 64 bytes

The form of a request is checked first, field by field from the left (see ``fields``), its addresses last, and
nothing is written unless all of it is right.
"""

from __future__ import annotations

from collections.abc import Callable
from struct import pack
from typing import TYPE_CHECKING

from fatektool.simulator.memory import DiscreteAction
from fatektool.simulator.plc import SimulatedPlc
from fatektool.simulator.refusal import Refusal, RefusalCode
from fatektool.simulator.slaves.base import RequestKind
from fatektool.simulator.slaves.fatek.fields import Fields

if TYPE_CHECKING:
    from fatektool.simulator.elements import SymbolKind

MAX_DISCRETES = 256
MAX_WORDS = 64
MAX_MIXED_WRITE_WORDS = 32
MAX_LOOPBACK = 256
LOOPBACK = 0x4E

Serve = Callable[[SimulatedPlc, Fields], bytes]
"""Executes a command; returns the data of its answer after the error."""

KINDS = {
    0x42: RequestKind.WRITE,
    0x45: RequestKind.WRITE,
    0x47: RequestKind.WRITE,
    0x49: RequestKind.WRITE,
    LOOPBACK: RequestKind.LOOPBACK,
}


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
    return fields.written_states(plc.read_disabled(symbol, address, count))


def _read_discretes(plc: SimulatedPlc, fields: Fields) -> bytes:
    count, symbol, address = _discretes(fields)
    fields.end()
    return fields.written_states(plc.read_discretes(symbol, address, count))


def _write_discretes(plc: SimulatedPlc, fields: Fields) -> bytes:
    count, symbol, address = _discretes(fields)
    states = fields.states(count)
    fields.end()
    plc.write_discretes(symbol, address, states)
    return b""


def _registers(fields: Fields) -> tuple[int, SymbolKind, int]:
    count = fields.count(MAX_WORDS)
    kind, address = fields.element(16, 32)
    if count * kind.words > MAX_WORDS:
        raise Refusal(RefusalCode.ILLEGAL_VALUE)
    return count, kind, address


def _read_registers(plc: SimulatedPlc, fields: Fields) -> bytes:
    count, kind, address = _registers(fields)
    fields.end()
    values = plc.read_words(kind.symbol, address, count)
    return fields.written(pack(f">{count}{'I' if kind.bits == 32 else 'H'}", *values))


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
        fields.written_value(kind, value) for (kind, _), value in zip(elements, values, strict=True)
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


def _detailed_status(plc: SimulatedPlc, fields: Fields) -> bytes:
    fields.end()
    return fields.written(plc.detailed_status())


COMMANDS: dict[int, Serve] = {
    0x41: _run_stop,
    0x42: _control_discrete,
    0x43: _read_disabled,
    0x44: _read_discretes,
    0x45: _write_discretes,
    0x46: _read_registers,
    0x47: _write_registers,
    0x48: _read_mixed,
    0x49: _write_mixed,
    0x53: _detailed_status,
}
"""All except 40, whose bytes differ, and 4E, whose answer has no error."""
