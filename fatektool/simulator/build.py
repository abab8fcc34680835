"""Builds a simulator from the options of a user.

::

    build_simulation(...) ──> Simulation ──┬── plcs       the PLCs by station, shared by all lines
                                           ├── faults     injected errors, shared too
                                           ├── state      the file that keeps their memory
                                           └── line()     a new line: one for each connection

With a state file, its memory has priority: another model is refused, and ``ladder_words`` and ``program`` are
used only for a new file.
"""

from __future__ import annotations

from dataclasses import dataclass, replace
from math import inf
from typing import TYPE_CHECKING

from fatektool.errors import DataError, UsageError
from fatektool.protocols import DEFAULT
from fatektool.simulator.faults import DEFAULT_SLOW_S, Faults, parse_faults
from fatektool.simulator.line import BITS_PER_CHAR, PIECE_S, WHOLE_ANSWERS, SimulatedLine
from fatektool.simulator.models import DEFAULT_MODEL, MAX_LADDER_WORDS, MODELS, PAGE_BYTES, WORDS_PER_PAGE
from fatektool.simulator.plc import MAX_STATION, SimulatedPlc
from fatektool.simulator.program.demonstration import program_of
from fatektool.simulator.slaves.registry import SLAVES
from fatektool.simulator.state import StateFile

if TYPE_CHECKING:
    import os
    from collections.abc import Callable, Iterable, Mapping, Sequence

    from fatektool.simulator.models import Model
    from fatektool.simulator.slaves.base import Slave


@dataclass(slots=True)
class Simulation:
    """PLCs with their common faults, speed and file.

    Args:
        plcs: the PLCs by station.
        make_slave: a new slave of the protocol.
        faults: injected errors; None for none.
        state: the file with the memory; None for none.
        baud: bits per second; None for no wire time.
        bits_per_char: with start, parity and stop bits.
        scan_s: the PLCs' time to answer, in seconds.
        latency_timer_s: see ``SimulatedLine``.
    """

    plcs: dict[int, SimulatedPlc]
    make_slave: Callable[[Mapping[int, SimulatedPlc]], Slave]
    faults: Faults | None = None
    state: StateFile | None = None
    baud: float | None = None
    bits_per_char: float = BITS_PER_CHAR
    scan_s: float = 0.0
    latency_timer_s: float = 0.0

    @property
    def powered(self) -> bool:
        """False from a power cut to the next ``power_on``."""
        return self.faults is None or self.faults.powered

    def power_on(self) -> None:
        """End a power cut."""
        if self.faults is not None:
            self.faults.power_on()

    def line(self, *, whole_answers: bool = False) -> SimulatedLine:
        """A new line to the PLCs; ``whole_answers`` for each in one piece, as of datagrams."""
        return SimulatedLine(
            self.make_slave(self.plcs),
            self.faults,
            self.baud,
            self.bits_per_char,
            self.scan_s,
            piece_s=WHOLE_ANSWERS if whole_answers else PIECE_S,
            latency_timer_s=self.latency_timer_s,
            after_request=None if self.state is None else self.save_if_changed,
        )

    def save_if_changed(self) -> bool:
        """Write the state file, if there is one and it is not up to date; True if it was written."""
        return self.state is not None and self.state.save_if_changed(self.plcs)


def build_plcs(
    stations: Iterable[int] = (1,),
    model: str | None = None,
    *,
    ladder_words: int | None = None,
    program: Sequence[bytes] | None = None,
    program_seed: int = 1,
    program_swapped: bool = False,
    program_commands: bool = True,
) -> dict[int, SimulatedPlc]:
    """New PLCs, one for each station, all with the same program.

    Args:
        stations: 1 to 254, each once.
        model: a name of ``MODELS``; by default the FBE-28MC.
        ladder_words: another size of the program memory; by default that of ``program`` or the model.
        program: pages 0..N; by default a demonstration program.
        program_seed: varies the demonstration program.
        program_swapped: swap the bytes of each word of an FBs demonstration program.
        program_commands: False for PLCs that refuse reads and writes of their program.
    """
    chosen, pages = _with_program(
        _model(model or DEFAULT_MODEL),
        None if program is None else list(program),
        ladder_words,
        program_seed,
        swapped=program_swapped,
    )
    plcs: dict[int, SimulatedPlc] = {}
    for station in stations:
        if not 1 <= station <= MAX_STATION:
            raise UsageError(f"a PLC's station is 1 to {MAX_STATION}, not {station}")
        if station in plcs:
            raise UsageError(f"station {station} is given twice")
        plcs[station] = SimulatedPlc(station, chosen, pages=pages, program_commands=program_commands)
    if not plcs:
        raise UsageError("a simulator needs at least one station")
    return plcs


def build_simulation(
    stations: Iterable[int] | None = None,
    model: str | None = None,
    *,
    protocol: str = DEFAULT,
    ladder_words: int | None = None,
    program: Sequence[bytes] | None = None,
    program_seed: int = 1,
    program_swapped: bool = False,
    program_commands: bool = True,
    error_character: bool = True,
    state: str | os.PathLike[str] | None = None,
    faults: Iterable[str] = (),
    seed: int = 0,
    slow_s: float = DEFAULT_SLOW_S,
    baud: float | None = None,
    bits_per_char: float | None = None,
    scan_ms: float = 0.0,
    latency_timer_ms: float = 0.0,
) -> Simulation:
    """A simulator, ready for lines.

    Args:
        stations: by default those of the state file, or 1.
        model: by default that of the state file, or that of the protocol in ``SLAVES``.
        protocol: a name of ``SLAVES``.
        ladder_words: see ``build_plcs``.
        program: see ``build_plcs``.
        program_seed: see ``build_plcs``.
        program_swapped: see ``build_plcs``.
        program_commands: see ``build_plcs``.
        error_character: see ``FaconSlave``; False is only for FACON.
        state: keeps the memory in this file, which is created if it does not exist.
        faults: ``KIND=P`` strings.
        seed: of the faults.
        slow_s: the delay of a slow answer.
        baud: bits per second; None for no wire time.
        bits_per_char: with start, parity and stop bits; by default those in ``SLAVES``.
        scan_ms: the PLCs' time to answer.
        latency_timer_ms: of a USB adapter at the client's end; 0 for none.
    """
    if protocol not in SLAVES:
        raise UsageError(f"protocol {protocol!r}: expected one of {', '.join(SLAVES)}")
    slave = SLAVES[protocol]
    make_slave = slave.make if error_character else slave.make_without_error_character
    if make_slave is None:
        raise UsageError(f"{protocol}: only FACON has answers without an error character")
    plan = parse_faults(faults)
    if (baud is not None and not baud > 0) or not scan_ms >= 0:
        raise UsageError(f"expected a baud rate above 0 and a scan time from 0 ms, got {baud} and {scan_ms}")
    if not 0 <= latency_timer_ms < inf:
        raise UsageError(f"latency timer: expected 0 ms or more, got {latency_timer_ms}")
    state_file = None if state is None else StateFile(state)
    kept = None if state_file is None else state_file.load()
    if kept is None or state_file is None:
        plcs = build_plcs(
            (1,) if stations is None else stations,
            model or slave.model,
            ladder_words=ladder_words,
            program=program,
            program_seed=program_seed,
            program_swapped=program_swapped,
            program_commands=program_commands,
        )
    else:
        plcs = _checked(kept, state_file, stations, model)
        for plc in plcs.values():
            plc.program_commands = program_commands

    simulation = Simulation(
        plcs,
        make_slave,
        Faults(plan, seed=seed, slow_s=slow_s) if plan.probabilities or plan.power_cut else None,
        state_file,
        baud,
        bits_per_char or slave.bits_per_char,
        scan_ms / 1000,
        latency_timer_ms / 1000,
    )
    # Written now, so that a path that cannot be written is known before the first request.
    simulation.save_if_changed()
    return simulation


def _with_program(
    chosen: Model, pages: list[bytes] | None, ladder_words: int | None, seed: int, *, swapped: bool
) -> tuple[Model, list[bytes]]:
    """The model with the ladder size and the number of pages of its program, and the program."""
    if ladder_words is None and pages is not None:
        ladder_words = _ladder_words(pages, chosen)
    if ladder_words is not None:
        if not 1 <= ladder_words <= MAX_LADDER_WORDS:
            raise UsageError(f"ladder size: expected 1 to {MAX_LADDER_WORDS} words, got {ladder_words}")
        chosen = replace(chosen, ladder_words=ladder_words)
    if pages is None:
        pages = program_of(chosen, seed=seed, swapped=swapped)
    elif len(pages) != chosen.page_count and _may_end_early(pages, chosen.ladder_words):
        chosen = replace(chosen, pages=len(pages))
    if len(pages) != chosen.page_count or any(len(page) != PAGE_BYTES for page in pages):
        raise DataError(
            f"the program has {len(pages)} pages; a ladder of {chosen.ladder_words} words"
            f" has {chosen.page_count} of {PAGE_BYTES} bytes each"
        )
    return chosen, pages


def _model(name: str) -> Model:
    model = MODELS.get(name.lower())
    if model is None:
        raise UsageError(f"model {name!r}: expected one of {', '.join(MODELS)}")
    return model


def _ladder_words(pages: Sequence[bytes], model: Model) -> int:
    """The ladder size of a program: that in its header, if it agrees with its length."""
    stated = int.from_bytes(pages[0][4:6], "big") if pages else 0
    for words in (stated, model.ladder_words):
        if words and -(-words // WORDS_PER_PAGE) + 1 == len(pages):
            return words
    return max(1, (len(pages) - 1) * WORDS_PER_PAGE)


def _may_end_early(pages: Sequence[bytes], ladder_words: int) -> bool:
    """True for a program of a PLC that refused the pages after its end, or gave one more."""
    if not pages:
        return False
    most = -(-ladder_words // WORDS_PER_PAGE) + 1
    if pages[0][:4] in {b"FBS4", b"BF4S"}:
        return len(pages) <= most
    return len(pages) == most or (len(pages) == most - 1 and pages[0][4:6] == ladder_words.to_bytes(2, "big"))


def _checked(
    kept: list[SimulatedPlc], state: StateFile, stations: Iterable[int] | None, model: str | None
) -> dict[int, SimulatedPlc]:
    plcs = {plc.station: plc for plc in kept}
    wanted = None if stations is None else sorted(stations)
    if wanted is not None and wanted != sorted(plcs):
        raise DataError(
            f"{state.path}: expected the stations {', '.join(map(str, wanted))},"
            f" got {', '.join(map(str, sorted(plcs)))}"
        )
    if model is not None:
        name = _model(model).name
        for plc in kept:
            if plc.model.name != name:
                raise DataError(
                    f"{state.path}: station {plc.station}: expected the model {name}, got {plc.model.name}"
                )
    return plcs
