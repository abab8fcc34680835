"""What a fleet keeps of its PLCs, counted: documents and errors that are alive."""

from __future__ import annotations

import gc
import threading
import weakref
from typing import TYPE_CHECKING, Any

import pytest

from fatektool.address import PlcAddress
from fatektool.cli.many.alarms import Alarms
from fatektool.cli.many.fleet.run import Orders, run_fleet
from fatektool.cli.many.outcome import JobResult
from fatektool.cli.shared.output import Voice
from fatektool.errors import LineError
from fatektool.inventory.entries import Inventory, PlcEntry

if TYPE_CHECKING:
    from collections.abc import Iterator
    from pathlib import Path

    from fatektool.cli.many.outcome import Outcome
    from fatektool.jobs.fleet.rounds import Turn

PLCS = 5


@pytest.fixture(autouse=True)
def none_but_its_own() -> Iterator[None]:
    """Collect the garbage of the test alone: among the objects of all tests before it takes half a second."""
    gc.freeze()
    yield
    gc.unfreeze()


class Large(dict[str, Any]):
    """A document, or what was read, that can be watched."""


class Watch:
    """How many large things are alive, at the most, when a turn begins."""

    def __init__(self) -> None:
        self.alive: weakref.WeakSet[Watched] = weakref.WeakSet()
        self.most = 0

    def large(self) -> Large:
        gc.collect()  # an error and its frames hold each other
        self.most = max(self.most, len(self.alive))
        watched = Watched()
        self.alive.add(watched)
        return Large(watched=watched)


class Slow(Alarms):
    """Lets a turn begin when the one before has been told of."""

    def __init__(self, prometheus: Path) -> None:
        super().__init__(prometheus, None, None)
        self.told = threading.Semaphore(1)

    def notify(self, job: str, outcome: Outcome, voice: Voice) -> None:
        super().notify(job, outcome, voice)
        self.told.release()


class Watched:
    """Lives as long as the document that holds it."""


def run(folder: Path, watch: Watch, *, fails: bool, json: bool) -> dict[str, Any]:
    entries = {f"plc-{number}": PlcEntry(f"plc-{number}", PlcAddress("sim:")) for number in range(PLCS)}
    orders = Orders(Inventory(folder / "fatek.toml", entries), list(entries.values()), 1, 60.0)
    alarms = Slow(folder / "fleet.prom")

    def work(entry: PlcEntry, turn: Turn[JobResult]) -> JobResult:
        alarms.told.acquire()
        read_so_far = watch.large()
        turn.progress("reading", len(read_so_far), 0)
        if fails:
            raise LineError(f"{entry.name}: no answer")
        return JobResult(0, read_so_far, "same", changed=False)

    document, interrupted = run_fleet("verify", orders, alarms, Voice(json=json, quiet=True), work)
    assert not interrupted
    assert (folder / "fleet.prom").exists()
    return document


@pytest.mark.parametrize("fails", [False, True])
def test_what_was_read_goes_when_it_is_told(tmp_path: Path, *, fails: bool) -> None:
    """Also where figures for Prometheus are kept to the end, and where each PLC failed."""
    watch = Watch()
    document = run(tmp_path, watch, fails=fails, json=False)
    assert document["summary"]["failed"] == (PLCS if fails else 0)
    assert watch.most <= 1  # that of the turn before, whose telling is just about to return
    assert not watch.alive


def test_documents_stay_where_they_will_be_printed(tmp_path: Path) -> None:
    watch = Watch()
    document = run(tmp_path, watch, fails=False, json=True)
    assert len(watch.alive) == PLCS
    assert all(plc["document"]["watched"] in watch.alive for plc in document["plcs"])
