"""A simulated PLC in a file, snapshots, and lines that fail when they are told to."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

from fatektool.jobs.elements.selection import parse_items
from fatektool.jobs.snapshots.snapshot import Snapshot, take_snapshot
from fatektool.jobs.snapshots.spec import items_of
from fatektool.simulator.build import build_simulation
from fatektool.simulator.line import SimulatedLine
from fatektool.simulator.refusal import Refusal, RefusalCode
from tests.cli.running import check
from tests.rigs import Simulated, simulated

if TYPE_CHECKING:
    from collections.abc import Callable
    from collections.abc import Set as AbstractSet
    from pathlib import Path

    import pytest

    from fatektool.simulator.elements import SymbolKind
    from fatektool.simulator.plc import SimulatedPlc
    from tests.cli.running import Cli, Done


def copied(made: Path, folder: Path) -> None:
    """Copy PLCs and backups that were made once into the folder of a test: the targets in them too."""
    for path in made.iterdir():
        text = path.read_text(encoding="utf-8")
        (folder / path.name).write_text(text.replace(str(made), str(folder)), encoding="utf-8")


class Plant:
    """A simulated PLC whose memory lies in a file."""

    def __init__(self, folder: Path, cli: Cli, name: str = "plc.state") -> None:
        self.state = folder / name
        self.target = f"sim:{self.state}"
        self.cli = cli
        build_simulation(ladder_words=64, state=self.state)

    @property
    def device(self) -> SimulatedPlc:
        """The PLC as it is now, to look at."""
        return build_simulation(state=self.state).plcs[1]

    def change(self, *, running: bool | None = None, inputs: dict[int, int] | None = None) -> None:
        simulation = build_simulation(state=self.state)
        device = simulation.plcs[1]
        if running is not None:
            device.running = running
        for address, value in (inputs or {}).items():
            device.set_input(address, value)
        simulation.save_if_changed()

    def register(self, address: int) -> int:
        return self.device.read_words("R", address, 1)[0]

    def write(self, *words: str) -> None:
        done = self.cli("write", *words)
        assert done.code == 0, done.err

    def json(self, schema: str, *words: object, code: int = 0) -> Any:
        """The document of a command, held against its schema."""
        done = self.cli(*words, "--json")
        assert done.code == code, (done.out, done.err)
        return done.document(schema)


def small(**options: Any) -> Simulated:
    """A PLC with a program of one page."""
    return simulated(**{"ladder_words": 64} | options)


def with_holes(
    holes: AbstractSet[int], code: RefusalCode = RefusalCode.ILLEGAL_ADDRESS, **options: Any
) -> Simulated:
    """A PLC that refuses some of its R registers."""
    made = small(**options)
    memory = made.device.memory
    check = memory.check

    def refusing(kind: SymbolKind, address: int, count: int) -> int:
        end = check(kind, address, count)
        if kind.area == "R" and not holes.isdisjoint(range(address, end)):
            raise Refusal(code)
        return end

    memory.check = refusing  # type: ignore[method-assign]  # a PLC with other rules
    return made


def snapshot_of(*elements: str, plc: Simulated | None = None) -> Snapshot:
    snapshot = take_snapshot((plc or small()).plc, items_of(parse_items(elements)))
    check(snapshot.document(), "snapshot")
    return snapshot


def spied(
    monkeypatch: pytest.MonkeyPatch,
    before: Callable[[bytes], object],
    passes: Callable[[], bool] = lambda: True,
) -> None:
    """Stand between all lines of this process and their PLCs.

    Args:
        monkeypatch: undoes it.
        before: is told of each request.
        passes: is asked whether the line is alive: before the request and before its answer.
    """
    receive = SimulatedLine.receive

    def between(self: SimulatedLine, data: bytes, now: float) -> Any:
        before(bytes(data))
        pieces = receive(self, data, now) if passes() else []
        return pieces if passes() else []

    monkeypatch.setattr(SimulatedLine, "receive", between)


def recorded(monkeypatch: pytest.MonkeyPatch) -> list[bytes]:
    """What is sent on all lines of this process."""
    sent: list[bytes] = []
    spied(monkeypatch, sent.append)
    return sent


def cut_after(monkeypatch: pytest.MonkeyPatch, requests: int) -> None:
    """Let every line of this process go dead after so many requests."""
    sent: list[bytes] = []
    spied(monkeypatch, sent.append, lambda: len(sent) <= requests)


def is_write(frame: bytes) -> bool:
    """A request that writes elements: 45, 47 or 49."""
    return frame[3:5] in {b"45", b"47", b"49"}


def cut_in_write(monkeypatch: pytest.MonkeyPatch, number: int) -> None:
    """Let every line of this process go dead behind the n-th write, which is done: its answer is lost.

    Number 0 is the first, lost on the way to the PLC.
    """
    writes: list[bytes] = []
    looks = 0

    def before(data: bytes) -> None:
        if is_write(data):
            writes.append(data)

    def passes() -> bool:
        nonlocal looks
        looks += len(writes) >= max(1, number)
        return looks < (1 if number == 0 else 2)

    spied(monkeypatch, before, passes)


def error_of(done: Done, code: int) -> str:
    """The one line of an error."""
    assert done.code == code, done
    (line,) = done.err.splitlines()
    assert line.startswith("fatektool: ")
    return line
