"""One simulated PLC: its operations, as values, for all protocols.

::

    SimulatedPlc
    ├── model      what it is
    ├── memory     discretes and registers
    ├── pages      its ladder program, page 0 the header
    └── flags      RUN, battery, ROM pack .. and the faults that prevent RUN

A slave of a protocol parses a request, calls the operation, and converts a ``Refusal`` into that protocol's
error answer. There are no frames here.
"""

from __future__ import annotations

from typing import TYPE_CHECKING

from fatektool.simulator.memory import DiscreteAction, SimulatedMemory
from fatektool.simulator.models import DEFAULT_MODEL, MODELS, PAGE_BYTES, Model
from fatektool.simulator.program.demonstration import program_of
from fatektool.simulator.refusal import Refusal, RefusalCode

if TYPE_CHECKING:
    from collections.abc import Iterable, Sequence

MAX_STATION = 0xFE
_STATION_CHECK = 4149
_DETAILED_BYTES = 64


class _Flag:
    """A flag of the PLC; its change is a change of the PLC's state."""

    def __set_name__(self, owner: type[SimulatedPlc], name: str) -> None:
        self._slot = f"_{name}"

    def __get__(self, plc: SimulatedPlc, owner: type[SimulatedPlc]) -> bool:
        return bool(plc.__dict__.get(self._slot, False))

    def __set__(self, plc: SimulatedPlc, value: bool) -> None:
        if value != plc.__dict__.get(self._slot, False):
            plc.__dict__[self._slot] = bool(value)
            plc.changes += 1


STATUS_BITS = (
    "running",
    "battery_low",
    "ladder_checksum_error",
    "rom_pack",
    "watchdog",
    "id_set",
    "emergency_stop",
)
"""The flags of status byte 1, bit 0 first."""

FLAGS = (*STATUS_BITS, "id_differs", "syntax_error", "unsupported_instruction", "password")
"""All flags; the last four are in no status. Three prevent RUN, ``password`` prevents reads of pages."""

_RUN_REFUSALS = (
    ("ladder_checksum_error", RefusalCode.LADDER_CHECKSUM),
    ("id_differs", RefusalCode.ID_DIFFERS),
    ("syntax_error", RefusalCode.SYNTAX),
    ("unsupported_instruction", RefusalCode.UNSUPPORTED_INSTRUCTION),
)


class SimulatedPlc:
    """A PLC with memory and a program, in STOP at first.

    Args:
        station: 1 to 254.
        model: by default the FBE-28MC.
        pages: its program, as many pages of 128 bytes as the model has; a demonstration one if None.
        program_commands: False if it refuses reads and writes of its program (error 4), as an FBs may
            [E:fbs-program].

    With ``acknowledge_only``, every write is checked and acknowledged, but not made: a fault.
    """

    running = _Flag()
    battery_low = _Flag()
    ladder_checksum_error = _Flag()
    rom_pack = _Flag()
    watchdog = _Flag()
    id_set = _Flag()
    emergency_stop = _Flag()
    id_differs = _Flag()
    syntax_error = _Flag()
    unsupported_instruction = _Flag()
    password = _Flag()

    def __init__(
        self,
        station: int = 1,
        model: Model = MODELS[DEFAULT_MODEL],
        *,
        pages: Sequence[bytes] | None = None,
        program_commands: bool = True,
    ) -> None:
        if not 1 <= station <= MAX_STATION:
            raise ValueError(f"a PLC's station is 1 to {MAX_STATION}, not {station}")
        self.station = station
        self.model = model
        self.memory = SimulatedMemory(model)
        self.pages = program_of(model) if pages is None else list(pages)
        if len(self.pages) != model.page_count or any(len(page) != PAGE_BYTES for page in self.pages):
            raise ValueError(f"expected {model.page_count} pages of {PAGE_BYTES} bytes for {model.name}")
        self.program_commands = program_commands
        self.acknowledge_only = False
        self.changes = 0

    @property
    def revision(self) -> int:
        """Increases with every change of memory, program or flags."""
        return self.changes + self.memory.revision

    # Status and mode -------------------------------------------------------------------------

    def status_byte(self) -> int:
        """Status byte 1 of commands 40 and 53."""
        return sum(getattr(self, name) << bit for bit, name in enumerate(STATUS_BITS))

    def brief_status(self) -> bytes:
        """The 3 bytes of command 40."""
        return bytes((self.status_byte(), self.model.status2, self.model.status3))

    def detailed_status(self) -> bytes:
        """The 64 bytes of command 53; 16-bit values high byte first, bytes 29 to 64 reserved."""
        model = self.model
        counts = (
            model.ladder_words,
            model.discrete_inputs,
            model.discrete_outputs,
            model.analog_inputs,
            model.analog_outputs,
            model.m_relays,
            model.s_relays,
            model.l_relays,
            model.r_registers,
            model.d_registers,
            model.timers,
            model.counters,
        )
        known = bytes((self.status_byte(), model.unit_type, model.points_code, model.os_version))
        known += b"".join(count.to_bytes(2, "big") for count in counts)
        return known.ljust(_DETAILED_BYTES, b"\x00")

    def run(self) -> None:
        """Go to RUN, unless a fault of the program prevents it."""
        for flag, code in _RUN_REFUSALS:
            if getattr(self, flag):
                raise Refusal(code)
        self.running = True

    def stop(self) -> None:
        """Go to STOP, which is never refused."""
        self.running = False

    # Program ---------------------------------------------------------------------------------

    def read_page(self, page: int) -> bytes:
        """One page of 128 bytes; RUN or STOP.

        The answer of a PLC with a password is not known; 4, 'command can not execute', is assumed.
        """
        if not self.program_commands or self.password:
            raise Refusal(RefusalCode.ILLEGAL_FORMAT)
        if page >= len(self.pages):
            raise Refusal(RefusalCode.ILLEGAL_ADDRESS)
        return self.pages[page]

    def write_page(self, page: int, content: bytes) -> None:
        """Replace one page of 128 bytes; in STOP and without a ROM pack only.

        In the paper, code 3 is for a ROM pack. It has no code for a running PLC; 4, 'command can not
        execute', is assumed.
        """
        if not self.program_commands:
            raise Refusal(RefusalCode.ILLEGAL_FORMAT)
        if self.rom_pack:
            raise Refusal(RefusalCode.WRITE_PROHIBITED)
        if self.running:
            raise Refusal(RefusalCode.ILLEGAL_FORMAT)
        if page >= len(self.pages):
            raise Refusal(RefusalCode.ILLEGAL_ADDRESS)
        if len(content) != PAGE_BYTES:
            raise Refusal(RefusalCode.ILLEGAL_FORMAT)
        if not self.acknowledge_only:
            self.pages[page] = content
            self.changes += 1

    # Elements --------------------------------------------------------------------------------

    def read_discretes(self, symbol: str, address: int, count: int) -> bytes:
        """States of consecutive discretes, a byte 0 or 1 each."""
        return self.memory.read_discretes(symbol, address, count)

    def read_disabled(self, symbol: str, address: int, count: int) -> bytes:
        """Disable flags of consecutive discretes, 1 for disabled."""
        return self.memory.read_disabled(symbol, address, count)

    def write_discretes(self, symbol: str, address: int, values: bytes) -> None:
        """Write consecutive discretes; ``values`` are bytes 0 or 1."""
        if self.acknowledge_only:
            self.memory.read_discretes(symbol, address, len(values))
        else:
            self.memory.write_discretes(symbol, address, values)

    def control_discrete(self, action: DiscreteAction, symbol: str, address: int) -> None:
        """Disable, enable, set or reset one discrete."""
        if self.acknowledge_only:
            self.memory.read_discretes(symbol, address, 1)
        else:
            self.memory.control(action, symbol, address)

    @property
    def checks_station(self) -> bool:
        """False while the low byte of R4149 is 1: port 0 answers every number then."""
        registers = self.memory.registers["R"]
        return len(registers) <= _STATION_CHECK or registers[_STATION_CHECK] & 0xFF != 1

    def read_words(self, symbol: str, address: int, count: int) -> list[int]:
        """Values of consecutive 16- or 32-bit elements."""
        return self.memory.read_words(symbol, address, count)

    def write_words(self, symbol: str, address: int, values: Sequence[int]) -> None:
        """Write consecutive 16- or 32-bit elements."""
        if self.acknowledge_only:
            self.memory.read_words(symbol, address, len(values))
        else:
            self.memory.write_words(symbol, address, values)

    def read_long_counters(self, first: int, count: int) -> list[int]:
        """Words of C200 and on, which have 32 bits, low word first, counted from that of C200."""
        return self.memory.read_long_counters(first, count)

    def write_long_counters(self, first: int, values: Sequence[int]) -> None:
        """Write words of C200 and on."""
        if self.acknowledge_only:
            self.memory.read_long_counters(first, len(values))
        else:
            self.memory.write_long_counters(first, values)

    def read_mixed(self, elements: Iterable[tuple[str, int]]) -> list[int]:
        """Values of elements of any kind: (symbol, address)."""
        return self.memory.read_mixed(elements)

    def write_mixed(self, writes: Sequence[tuple[str, int, int]]) -> None:
        """Write elements of any kind: (symbol, address, value); all of them or none."""
        if self.acknowledge_only:
            self.memory.read_mixed((symbol, address) for symbol, address, _ in writes)
        else:
            self.memory.write_mixed(writes)

    def set_input(self, address: int, value: int) -> None:
        """Switch the terminal of X ``address`` on or off."""
        self.memory.set_input(address, value)

    def set_input_register(self, address: int, value: int) -> None:
        """Set R ``address`` as the PLC's own hardware does."""
        self.memory.set_input_register(address, value)
