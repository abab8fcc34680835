"""A PLC's memory: discretes with their disable flags, registers, and views of both.

In three cases the PLC acknowledges a write that has no effect, because the protocol has no code for that:

* A **disabled** discrete keeps its state after any write; only *set* and *reset* (command 42) change it. This
is
  the purpose of disabling: to force a state against the program.
* An **enabled X** follows its terminal. No write changes it. ``set_input`` is the terminal.
* **R3840..R3903** are the analog and special inputs; only ``set_input_register`` changes them.

An address above the model's range is refused with A (FACON paper, section 4.1), and so is a packed word (WX,
DWM ..) whose address is not a multiple of 8, as that section requires: the element does not exist. A packed
word or 32-bit register must be completely inside the model's range; one that is partly outside is refused
with A too. An odd 32-bit register (DR15 = R16, R15) is valid. A write is made completely or not at all.
"""

from __future__ import annotations

import sys
from array import array
from enum import IntEnum
from typing import TYPE_CHECKING

from fatektool.simulator.elements import SymbolKind, kind_of
from fatektool.simulator.refusal import Refusal, RefusalCode

if TYPE_CHECKING:
    from collections.abc import Iterable, Sequence

    from fatektool.simulator.models import Model

INPUT_REGISTERS = range(3840, 3904)
LONG_COUNTERS = range(200, 256)
"""They have 32 bits: their low words are in the counters' registers, their high words separate."""

_PACKED_MULTIPLE = 8
_ASCII_BIT = bytes.maketrans(b"\x00\x01", b"01")


class DiscreteAction(IntEnum):
    """The operations of command 42 on one discrete."""

    DISABLE = 1
    ENABLE = 2
    SET = 3
    RESET = 4


class SimulatedMemory:
    """The elements of one PLC, all zero and enabled at first.

    ``revision`` increases with every write.
    """

    def __init__(self, model: Model) -> None:
        counts = {
            "X": model.discrete_inputs,
            "Y": model.discrete_outputs,
            "M": model.m_relays,
            "S": model.s_relays,
            "T": model.timers,
            "C": model.counters,
        }
        self.status = {area: bytearray(count) for area, count in counts.items()}
        self.disabled = {area: bytearray(count) for area, count in counts.items()}
        self.inputs = bytearray(model.discrete_inputs)
        self.registers = {
            "R": _zeros(model.r_registers),
            "D": _zeros(model.d_registers),
            "F": _zeros(model.f_registers),
            "RT": _zeros(model.timers),
            "RC": _zeros(model.counters),
            "RC high": _zeros(max(0, model.counters - LONG_COUNTERS.start)),
        }
        self.revision = 0
        self._sizes = counts | {area: len(table) for area, table in self.registers.items()}

    def check(self, kind: SymbolKind, address: int, count: int) -> int:
        """The end in the area of ``count`` elements from ``address``; refuses it above the model's range."""
        end = address + count * kind.step
        if address < 0 or end > self._sizes[kind.area] or (kind.packed and address % _PACKED_MULTIPLE):
            raise Refusal(RefusalCode.ILLEGAL_ADDRESS)
        return end

    def read_discretes(self, symbol: str, address: int, count: int) -> bytes:
        """States of consecutive discretes, one byte 0 or 1 each."""
        kind = kind_of(symbol, 1)
        return bytes(self.status[kind.area][address : self.check(kind, address, count)])

    def read_disabled(self, symbol: str, address: int, count: int) -> bytes:
        """Disable flags of consecutive discretes, 1 for disabled."""
        kind = kind_of(symbol, 1)
        return bytes(self.disabled[kind.area][address : self.check(kind, address, count)])

    def write_discretes(self, symbol: str, address: int, values: bytes) -> None:
        """Write consecutive discretes; ``values`` are bytes 0 or 1."""
        kind = kind_of(symbol, 1)
        self.check(kind, address, len(values))
        self._store_discretes(kind.area, address, values)
        self.revision += 1

    def control(self, action: DiscreteAction, symbol: str, address: int) -> None:
        """Disable, enable, set or reset one discrete."""
        area = kind_of(symbol, 1).area
        self.check(kind_of(symbol), address, 1)
        status, disabled = self.status[area], self.disabled[area]
        if action is DiscreteAction.DISABLE:
            disabled[address] = 1
        elif action is DiscreteAction.ENABLE:
            disabled[address] = 0
            if area == "X":
                status[address] = self.inputs[address]
        elif area != "X" or disabled[address]:
            status[address] = action is DiscreteAction.SET
        self.revision += 1

    def read_words(self, symbol: str, address: int, count: int) -> list[int]:
        """Values of consecutive 16- or 32-bit elements, registers or packed discretes."""
        kind = kind_of(symbol, 16, 32)
        end = self.check(kind, address, count)
        if kind.packed:
            # int() needs the highest bit first, so the range is read from its end.
            bits = bytes(self.status[kind.area][address:end]).translate(_ASCII_BIT)[::-1]
            starts = range(len(bits) - kind.bits, -1, -kind.bits)
            return [int(bits[start : start + kind.bits], 2) for start in starts]
        words = self.registers[kind.area][address:end].tolist()
        if kind.step == 1:
            return words
        return [high << 16 | low for low, high in zip(words[::2], words[1::2], strict=True)]

    def write_words(self, symbol: str, address: int, values: Sequence[int]) -> None:
        """Write consecutive 16- or 32-bit elements, registers or packed discretes."""
        kind = kind_of(symbol, 16, 32)
        end = self.check(kind, address, len(values))
        if kind.packed:
            bits = bytes(value >> bit & 1 for value in values for bit in range(kind.bits))
            self._store_discretes(kind.area, address, bits)
        else:
            if kind.step != 1:
                values = [half for value in values for half in (value & 0xFFFF, value >> 16)]
            self._store_registers(kind.area, address, end, values)
        self.revision += 1

    def read_long_counters(self, first: int, count: int) -> list[int]:
        """Words of the counters of 32 bits, low word first, counted from that of C200."""
        return [table[at] for table, at in self._long_counters(first, count)]

    def write_long_counters(self, first: int, values: Sequence[int]) -> None:
        """Write words of the counters of 32 bits."""
        for (table, at), value in zip(self._long_counters(first, len(values)), values, strict=True):
            table[at] = value
        self.revision += 1

    def _long_counters(self, first: int, count: int) -> list[tuple[array[int], int]]:
        highs, lows = self.registers["RC high"], self.registers["RC"]
        if first < 0 or first + count > 2 * len(highs):
            raise Refusal(RefusalCode.ILLEGAL_ADDRESS)
        start = LONG_COUNTERS.start
        places = (divmod(word, 2) for word in range(first, first + count))
        return [(highs, counter) if high else (lows, start + counter) for counter, high in places]

    def read_mixed(self, elements: Iterable[tuple[str, int]]) -> list[int]:
        """Values of elements of any kind."""
        values = []
        for symbol, address in elements:
            if symbol in self.status:
                values.append(self.read_discretes(symbol, address, 1)[0])
            else:
                values.append(self.read_words(symbol, address, 1)[0])
        return values

    def write_mixed(self, writes: Sequence[tuple[str, int, int]]) -> None:
        """Write elements of any kind, in order: (symbol, address, value)."""
        for symbol, address, _ in writes:
            self.check(kind_of(symbol), address, 1)
        for symbol, address, value in writes:
            if symbol in self.status:
                self.write_discretes(symbol, address, bytes((value,)))
            else:
                self.write_words(symbol, address, (value,))

    def set_input(self, address: int, value: int) -> None:
        """Switch a terminal X on or off; X follows unless it is disabled."""
        self.inputs[address] = bool(value)
        if not self.disabled["X"][address]:
            self.status["X"][address] = bool(value)
        self.revision += 1

    def set_input_register(self, address: int, value: int) -> None:
        """Set a register as the PLC's own hardware does, also input registers."""
        self.registers["R"][address] = value
        self.revision += 1

    def preset(self, symbol: str, address: int, value: int) -> None:
        """Set an element of any kind as nothing but the PLC itself can: inputs and disabled discretes too."""
        kind = kind_of(symbol)
        end = self.check(kind, address, 1)
        if kind.area in self.status:
            for bit, place in enumerate(range(address, end)):
                self.status[kind.area][place] = value >> bit & 1
                if kind.area == "X":
                    self.inputs[place] = value >> bit & 1
        else:
            for place in range(address, end):
                self.registers[kind.area][place] = value & 0xFFFF
                value >>= 16
        self.revision += 1

    def _store_discretes(self, area: str, address: int, values: bytes) -> None:
        if area == "X":
            return
        end = address + len(values)
        status, disabled = self.status[area], self.disabled[area]
        if disabled.find(1, address, end) < 0:
            status[address:end] = values
            return
        for position, value in enumerate(values, address):
            if not disabled[position]:
                status[position] = value

    def _store_registers(self, area: str, address: int, end: int, values: Sequence[int]) -> None:
        table = self.registers[area]
        if area == "R" and address < INPUT_REGISTERS.stop and end > INPUT_REGISTERS.start:
            for position, value in enumerate(values, address):
                if position not in INPUT_REGISTERS:
                    table[position] = value
        else:
            table[address:end] = array("H", values)


def _zeros(count: int) -> array[int]:
    return array("H", bytes(2 * count))


if array("H").itemsize != 2:  # pragma: no cover - no such Python is known
    sys.exit("an array of 'H' is not of 16 bits here")
