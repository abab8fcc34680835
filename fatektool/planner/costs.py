"""The costs of the parts of a request on the wire, from the codec."""

from __future__ import annotations

from functools import cache, lru_cache
from typing import TYPE_CHECKING, Any, Final

from fatektool.protocol.commands import (
    ReadDiscretes,
    ReadMixed,
    ReadRegisters,
    Request,
    WriteDiscretes,
    WriteMixed,
    WriteRegisters,
)
from fatektool.protocol.elements import KINDS, Element

if TYPE_CHECKING:
    from fatektool.protocol.codec import Codec


WORD: Final = 16


def turnaround_bytes(turnaround_s: float, byte_time_s: float) -> float:
    """A PLC's turnaround, as bytes of line time."""
    return turnaround_s / byte_time_s


@lru_cache(maxsize=16)
def costs_of(codec: Codec, turnaround: float, *, writes: bool) -> Costs:
    """The costs of ``Costs``, kept from one plan to the next: a job makes many plans for one line."""
    return Costs(codec, turnaround, writes=writes)


class Costs:
    """Bytes of requests and answers, of reads or of writes, and the limits of one request.

    Args:
        codec: the protocol.
        turnaround: the PLC's turnaround in bytes; each request has it once.
        writes: the costs of 45, 47 and 49 instead of 44, 46 and 48.
    """

    def __init__(self, codec: Codec, turnaround: float, *, writes: bool) -> None:
        self._codec = codec
        self._turnaround = turnaround
        self._writes = writes
        self.run = cache(self._run_cost)
        self.run_value = cache(self._run_value)
        self.run_base = cache(self._run_base)
        self.mixed_item = cache(self._mixed_item)
        self.mixed_words = codec.mixed_words(writes=writes)
        self.mixed_base = 0.0
        if self.mixed_words:
            self.mixed_base = self._wire(self._mixed("R", 1)) - self._mixed_item("R") + turnaround
        self.most = cache(self._most)
        self.packs_discretes = cache(self._packs_discretes)
        self.one_is_cheap = cache(self._one_is_cheap)

    def _wire(self, request: Request[Any]) -> int:
        return self._codec.request_bytes(request) + self._codec.answer_bytes(request)

    def _most(self, symbol: str) -> int:
        """The most values in a run."""
        return self._codec.most(symbol, writes=self._writes)

    def _packs_discretes(self, symbol: str) -> bool:
        """True if discretes cost no more than words of them: then words need not be examined."""
        return self._run_cost(symbol, WORD) <= self._run_cost(f"W{symbol}", 1)

    def _one_is_cheap(self, symbol: str) -> bool:
        """True if a run of one costs less than expected from longer runs."""
        return 2 * self._run_cost(symbol, 2) > self._run_cost(symbol, 1) + self._run_cost(symbol, 3)

    def _run_cost(self, symbol: str, count: int) -> float:
        """Bytes of a run, turnaround included."""
        return self._wire(self._run(symbol, count)) + self._turnaround

    def _run(self, symbol: str, count: int) -> Request[Any]:
        first = Element(symbol, 0)
        if KINDS[symbol].bits == 1:
            return WriteDiscretes(first, (False,) * count) if self._writes else ReadDiscretes(first, count)
        return WriteRegisters(first, (0,) * count) if self._writes else ReadRegisters(first, count)

    def _mixed(self, symbol: str, count: int) -> Request[Any]:
        element = Element(symbol, 0)
        return WriteMixed(((element, 0),) * count) if self._writes else ReadMixed((element,) * count)

    def _run_value(self, symbol: str) -> int:
        """Bytes of one more value in a run."""
        return self._wire(self._run(symbol, 2)) - self._wire(self._run(symbol, 1))

    def _run_base(self, symbol: str) -> float:
        """Bytes of a run without its values, turnaround included."""
        return self._wire(self._run(symbol, 1)) - self._run_value(symbol) + self._turnaround

    def _mixed_item(self, symbol: str) -> int:
        """Bytes of one more item in a mixed request."""
        return self._wire(self._mixed(symbol, 2)) - self._wire(self._mixed(symbol, 1))
