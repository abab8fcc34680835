"""Injected faults of a line and a PLC, the same for the same seed.

::

    drop          no answer
    flip          one of the low 7 bits of one byte of the answer is wrong, not only the case of a letter
    truncate      the answer ends too early, after its first byte at the soonest
    noise         1 to 8 random bytes before the answer, also those that delimit one
    duplicate     the answer is sent twice
    late          the answer is sent only after the next request was received
    slow          the answer is sent 0.8 s later
    wrong-station the answer has another station, with a correct checksum
    lying-write   a write is acknowledged, but not made
    echo          the request is sent back first, as on a two-wire line
    wrong-line    wrong baud or format: the request is not understood, about as many bytes of noise are sent
    twins         two PLCs with this station: one answer follows the other at once, or they overlap, one byte
                  apart, and a bit is 0 if it is 0 in either
    bit-errors=P  one of the low 7 bits of a byte of the answer is wrong, with probability P for each byte:
                  so long answers have more errors
    power-cut=N   the power fails at the N-th request to write a program page

Each kind except the last two has a probability, drawn for each answer (``echo``: for each piece of received
bytes). Each kind has its own generator, so another kind does not change which answers the others hit. A
dropped answer and the noise of a wrong line have no other faults. Without a hit, twins answer at the same
time and look like one PLC. The noise of a wrong line never ends like a frame, so no frame is ever found in
it.
"""

from __future__ import annotations

from dataclasses import dataclass, field
from operator import and_
from random import Random
from typing import TYPE_CHECKING

from fatektool.errors import UsageError
from fatektool.simulator.slaves.base import BROADCAST, RequestFrame, RequestKind, Slave, addressed

if TYPE_CHECKING:
    from collections.abc import Iterable, Mapping

PROBABILITY_KINDS = (
    "drop",
    "flip",
    "truncate",
    "noise",
    "duplicate",
    "late",
    "slow",
    "wrong-station",
    "lying-write",
    "echo",
    "wrong-line",
    "twins",
)
"""The kinds whose probability is that of an answer."""

BIT_ERRORS = "bit-errors"
POWER_CUT = "power-cut"
FAULT_KINDS = (*PROBABILITY_KINDS, BIT_ERRORS, POWER_CUT)

DEFAULT_SLOW_S = 0.8
_MAX_NOISE = 8
_STATIONS = 0xFE
_CASE = 0x20
"""The bit that a small letter has and a capital has not."""


@dataclass(frozen=True, slots=True)
class FaultPlan:
    """The kinds of faults and their probabilities.

    Args:
        probabilities: kind to probability, 0 to 1.
        power_cut: the write of a page, counted from 1, at which the power fails; None for never.
    """

    probabilities: Mapping[str, float] = field(default_factory=dict)
    power_cut: int | None = None


def parse_faults(texts: Iterable[str]) -> FaultPlan:
    """A plan from ``KIND=P`` strings; UsageError for anything else."""
    probabilities: dict[str, float] = {}
    power_cut = None
    for text in texts:
        kind, equals, value = text.partition("=")
        if kind not in FAULT_KINDS or not equals:
            raise UsageError(
                f"fault {text!r}: expected KIND=P, P from 0 to 1, KIND one of"
                f" {', '.join(PROBABILITY_KINDS)}, {BIT_ERRORS}; or {POWER_CUT}=N"
            )
        if kind in probabilities or (kind == POWER_CUT and power_cut is not None):
            raise UsageError(f"fault {kind} is given twice")
        if kind == POWER_CUT:
            if not (value.isascii() and value.isdigit() and int(value)):
                raise UsageError(f"fault {kind}: expected the number of a page write, from 1, got {value!r}")
            power_cut = int(value)
        else:
            probabilities[kind] = _probability(kind, value)
    return FaultPlan(probabilities, power_cut)


def _probability(kind: str, text: str) -> float:
    try:
        value = float(text)
    except ValueError:
        value = -1.0
    if not 0 <= value <= 1:  # refuses NaN too
        raise UsageError(f"fault {kind}: expected a probability from 0 to 1, got {text!r}")
    return value


@dataclass(slots=True)
class SpoiledAnswer:
    """One answer with its faults.

    Args:
        copies: the bytes to send, one entry for each copy; none if it is dropped.
        delay_s: delay in seconds.
        late: True if it is sent only after the next request.
    """

    copies: list[bytes]
    delay_s: float = 0.0
    late: bool = False


class Faults:
    """The injected faults of one simulator, shared by all its connections.

    Args:
        plan: the kinds and their probabilities.
        seed: the same seed and the same requests give the same faults.
        slow_s: the delay of a slow answer.

    ``counts`` has the number of hits of each kind.
    """

    def __init__(self, plan: FaultPlan, *, seed: int = 0, slow_s: float = DEFAULT_SLOW_S) -> None:
        self.plan = plan
        self.slow_s = slow_s
        self.powered = True
        self.counts = dict.fromkeys((*plan.probabilities, *([POWER_CUT] if plan.power_cut else [])), 0)
        self._random = {kind: Random(f"{kind} {seed}") for kind in plan.probabilities}  # noqa: S311
        self._page_writes = 0

    def power_on(self) -> None:
        """End a power cut; the memory is unchanged."""
        self.powered = True

    def echoes(self) -> bool:
        """Whether the received bytes are sent back."""
        return self._strikes("echo")

    def answer(self, slave: Slave, request: RequestFrame) -> bytes | None:
        """Execute ``request``, unless the power fails, or a write is acknowledged but not made."""
        if request.kind in {RequestKind.OTHER, RequestKind.LOOPBACK}:
            return slave.answer(request)
        plc = addressed(slave.plcs, request.station)
        here = plc is not None or request.station == BROADCAST
        if here and request.kind is RequestKind.PAGE_WRITE:
            self._page_writes += 1
            if self._page_writes == self.plan.power_cut:
                self.counts[POWER_CUT] += 1
                self.powered = False
                return None
        if plc is None or not self._strikes("lying-write"):
            return slave.answer(request)
        plc.acknowledge_only = True
        try:
            return slave.answer(request)
        finally:
            plc.acknowledge_only = False

    def spoil(self, slave: Slave, request: RequestFrame, answer: bytes) -> SpoiledAnswer:
        """Apply the drawn faults to an answer."""
        if self._strikes("drop"):
            return SpoiledAnswer([])
        if self._strikes("wrong-station"):
            other = (request.station + self._random["wrong-station"].randrange(_STATIONS - 1)) % _STATIONS + 1
            answer = slave.readdressed(answer, other)
        if self._strikes("flip"):
            spoiled = bytearray(answer)
            random = self._random["flip"]
            place, bit = random.randrange(len(answer)), 1 << random.randrange(7)
            if bit == _CASE and answer[place : place + 1].isalpha():  # a small hex digit is read as a capital
                bit >>= 1
            spoiled[place] ^= bit
            answer = bytes(spoiled)
        answer = self._with_bit_errors(answer)
        if self._strikes("truncate"):
            answer = answer[: self._random["truncate"].randrange(1, len(answer))]
        if self._strikes("noise"):
            answer = self._noise(slave.delimiters) + answer
        copies = self._from_twins(answer) if self._strikes("twins") else [answer]
        if self._strikes("duplicate"):
            copies *= 2
        delay_s = self.slow_s if self._strikes("slow") else 0.0
        return SpoiledAnswer(copies, delay_s, late=self._strikes("late"))

    def garbage(self, slave: Slave, request: RequestFrame) -> bytes | None:
        """The noise for a request that no PLC understands; None if it is understood.

        It is empty for a broadcast, which no PLC answers.
        """
        broadcast = request.station == BROADCAST
        here = broadcast or addressed(slave.plcs, request.station) is not None
        if not here or not self._strikes("wrong-line"):
            return None
        if broadcast:
            return b""
        random = self._random["wrong-line"]
        length = random.randint(len(request.raw) * 3 // 4, len(request.raw) * 5 // 4)
        never = slave.delimiters[-1][-1]
        return bytes(byte + (byte >= never) for byte in (random.randrange(255) for _ in range(length)))

    def _noise(self, delimiters: tuple[bytes, ...]) -> bytes:
        # One draw in four delimits a frame, which is rare in random bytes.
        random = self._random["noise"]
        noise = bytearray()
        count = random.randint(1, _MAX_NOISE)
        while len(noise) < count:
            noise += random.choice(delimiters) if random.random() < 1 / 4 else bytes((random.randrange(256),))
        return bytes(noise[:count])

    def _with_bit_errors(self, answer: bytes) -> bytes:
        random = self._random.get(BIT_ERRORS)
        if random is None:
            return answer
        spoiled = bytearray(answer)
        for at in range(len(spoiled)):
            if self._strikes(BIT_ERRORS):
                spoiled[at] ^= 1 << random.randrange(7)
        return bytes(spoiled)

    def _from_twins(self, answer: bytes) -> list[bytes]:
        if self._random["twins"].random() < 1 / 2:
            return [answer, answer]
        # An idle line is high, all ones; a low output wins over a high one.
        return [bytes(map(and_, answer + b"\xff", b"\xff" + answer))]

    def _strikes(self, kind: str) -> bool:
        random = self._random.get(kind)
        if random is None or random.random() >= self.plan.probabilities[kind]:
            return False
        self.counts[kind] += 1
        return True
