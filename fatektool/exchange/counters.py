"""Counts of what was sent and received on a line."""

from __future__ import annotations

from dataclasses import dataclass

from fatektool.counts import counted


@dataclass(slots=True)
class Counters:
    """Counts of what was sent and received on a line."""

    exchanges: int = 0
    writes: int = 0  # requests that write, sent or about to be sent
    timeouts: int = 0
    checksum_errors: int = 0
    garbled: int = 0
    strays: int = 0
    echoes: int = 0
    fences: int = 0
    bytes_received: int = 0

    @property
    def trouble(self) -> int:
        """The number of errors; 0 on a clean line."""
        return self.timeouts + self.checksum_errors + self.garbled + self.strays

    def __str__(self) -> str:
        return (
            f"{counted(self.exchanges, 'exchange')}, {counted(self.bytes_received, 'byte')} received, "
            f"{counted(self.timeouts, 'time-out')}, {counted(self.checksum_errors, 'wrong checksum')}, "
            f"noise {counted(self.garbled, 'time')}, {counted(self.strays, 'stray answer')}, "
            f"{counted(self.echoes, 'echo', 'echoes')}, {counted(self.fences, 'fence')}"
        )
