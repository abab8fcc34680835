"""Counts of what was sent and received on a line."""

from __future__ import annotations

from dataclasses import dataclass


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
            f"{self.exchanges} exchanges, {self.bytes_received} bytes received, {self.timeouts} time-outs, "
            f"{self.checksum_errors} wrong checksums, {self.garbled} times noise, "
            f"{self.strays} stray answers, {self.echoes} echoes, {self.fences} fences"
        )
