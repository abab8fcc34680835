"""The four commands whose write can be undone, over one simulated PLC, with what can be done to its line."""

from __future__ import annotations

import shutil
from dataclasses import dataclass
from functools import cache
from pathlib import Path
from typing import TYPE_CHECKING, Any, Final

from fatektool.cli.shared.unfinished import records_of
from fatektool.jobs.snapshots.formats import as_json
from fatektool.program.archive import save_backup
from fatektool.simulator.build import build_simulation
from fatektool.simulator.line import SimulatedLine
from fatektool.simulator.plc import SimulatedPlc
from tests.cli.running import NEW, OLD
from tests.plant import snapshot_of
from tests.program.samples import backup
from tests.rigs import simulated

if TYPE_CHECKING:
    from collections.abc import Callable

    import pytest

    from tests.cli.running import Cli, Done

WRITES: Final = {b"45", b"47", b"49", b"50"}
"""Requests that write elements or a page."""

TABLE: Final = 'kind = "md0"\n' + "".join(
    f'\n[[transaction]]\nstation = {at}\ncommand = "read"\nlength = {at}\nmaster = "R{at}"\nslave = "R{at}"\n'
    for at in range(1, 21)
)


@dataclass(frozen=True)
class Writer:
    """One of the commands.

    Attributes:
        words: its command line, without target and ``--yes``.
        copies: what its safety copies are called.
        key: of the safety copy in JSON.
        copied: what that is of.
        undo: the command that writes the safety copy back.
        refused: what is said where the PLC takes no write.
    """

    words: tuple[str, ...]
    copies: str
    key: str
    copied: str
    undo: tuple[str, ...]
    refused: str


def _of_values(words: str, copies: str) -> Writer:
    undo = ("snapshot", "apply")
    return Writer(tuple(words.split()), f"{copies}.safety-*", "safety_snapshot", "values", undo, "not kept")


WRITERS: Final = {
    "restore": Writer(
        ("restore", "new.json", "--single-pass"),
        "new.safety-*",
        "safety_backup",
        "program",
        ("restore",),
        "nothing was changed, the PLC holds its previous program",
    ),
    "snapshot apply": _of_values("snapshot apply values.json", "values"),
    "link table write": _of_values("link table write table.toml R500", "table"),
    "link modem set": _of_values(
        "link modem set --number 02-28082192 --modem-on --auto-answer 3 --pulse", "modem"
    ),
}


_AFTER: dict[str, tuple[Any, ...]] = {}
"""What the PLC holds when a command has completed; each runs once for it."""


@cache
def _values() -> str:
    """The file of ``snapshot apply``."""
    return as_json(snapshot_of("R0-R255", "M0-M9", plc=simulated(ladder_words=64)))


class Bench:
    """A simulated PLC whose memory is kept in a file, and one of the commands."""

    def __init__(self, name: str, place: Path, cli: Cli, monkeypatch: pytest.MonkeyPatch) -> None:
        self.name = name
        self.writer = WRITERS[name]
        self.place = place
        self.cli = cli
        self.patch = monkeypatch
        self.target = f"sim:{place / 'plc.state'}"
        save_backup(backup(NEW, target=self.target), place / "new.json")
        (place / "table.toml").write_text(TABLE, encoding="utf-8")
        (place / "values.json").write_text(_values())
        device = build_simulation(ladder_words=400, program=OLD.pages, state=place / "plc.state")
        device.plcs[1].write_words("R", 0, [2] * 256)
        device.plcs[1].write_discretes("M", 0, bytes([1] * 10))
        device.save_if_changed()
        shutil.copy(place / "plc.state", place / "before.state")
        self.before = self.held
        if name not in _AFTER:
            assert self.run("--yes").code == 0
            _AFTER[name] = self.held
            self.reset()
        self.after = _AFTER[name]
        assert self.after != self.before

    def reset(self) -> None:
        """As before the first run: the PLC, and the files."""
        shutil.copy(self.place / "before.state", self.place / "plc.state")
        for path in (*self.copies, *self.records):
            path.unlink()

    def run(self, *more: str) -> Done:
        return self.cli(*self.writer.words, "-p", self.target, *more)

    @property
    def held(self) -> tuple[Any, ...]:
        """All that the PLC holds."""
        plc = build_simulation(state=self.place / "plc.state").plcs[1]
        registers = {area: tuple(words) for area, words in plc.memory.registers.items()}
        status = {area: bytes(bits) for area, bits in plc.memory.status.items()}
        return tuple(plc.pages), registers, status, plc.running

    @property
    def copies(self) -> list[Path]:
        return sorted(self.place.glob(self.writer.copies))

    @property
    def records(self) -> list[Path]:
        return [Path(found.path) for found in records_of(self.target, 1)]

    def untouched(self) -> None:
        """The PLC is as it was, and so are the folders."""
        assert self.held == self.before
        assert self.copies == []
        assert self.records == []

    def undo(self) -> None:
        """The safety copy makes the PLC what it was."""
        (copy,) = self.copies
        done = self.cli(*self.writer.undo, copy, "-p", self.target, "--yes")
        assert done.code == 0, done
        assert self.held == self.before

    def answer(self, answer: Callable[[], str]) -> None:
        """Let somebody answer the question."""
        self.patch.setattr("fatektool.cli.shared.questions.can_ask", lambda: True)
        self.patch.setattr("sys.stdin.readline", answer, raising=False)

    def each_request(
        self, patch: pytest.MonkeyPatch, before: Callable[[bytes], object], after: Callable[[bytes], object]
    ) -> None:
        """Be called ``before`` a request reaches the PLC, and ``after`` it, before its answer is given."""
        receive = SimulatedLine.receive

        def between(line: SimulatedLine, data: bytes, now: float) -> Any:
            before(bytes(data))
            pieces = receive(line, data, now)
            after(bytes(data))
            return pieces

        patch.setattr(SimulatedLine, "receive", between)

    def cut(self, patch: pytest.MonkeyPatch, number: int) -> None:
        """Let the line go dead behind the n-th write, whose answer is lost; 0: with the first on its way."""
        receive, writes, dead = SimulatedLine.receive, 0, False

        def between(line: SimulatedLine, data: bytes, now: float) -> Any:
            nonlocal writes, dead
            writes += data[3:5] in WRITES
            dead = dead or (number == 0 and writes == 1)
            pieces = [] if dead else receive(line, data, now)
            dead = dead or writes == number != 0
            return [] if dead else pieces

        patch.setattr(SimulatedLine, "receive", between)

    def devices(self) -> list[SimulatedPlc]:
        """The PLCs that are made from now on, as commands do."""
        made: list[SimulatedPlc] = []
        original = SimulatedPlc.__init__

        def begin(plc: SimulatedPlc, *values: Any, **named: Any) -> None:
            original(plc, *values, **named)
            made.append(plc)

        self.patch.setattr(SimulatedPlc, "__init__", begin)
        return made
