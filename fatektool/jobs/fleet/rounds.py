"""Many PLCs: those on one line one after the other, lines side by side.

::

    tasks ──> lines, the longest first ──> N threads, each with a line at a time ──> ended turns

A thread asks one PLC by the functions that a single command uses. PLCs behind one gateway share its
connection, as some serve one at a time, and free it late. The time of a PLC's turn is limited; an interrupt
ends all turns. A line that hangs blocks one of the N threads, and no other line.
"""

from __future__ import annotations

import threading
import time
from collections import deque
from dataclasses import dataclass, field
from queue import Empty, SimpleQueue
from typing import TYPE_CHECKING, Final, Generic, TypeVar

from fatektool.errors import FatektoolError
from fatektool.transport.limit import Limit
from fatektool.transport.shared_line import SharedLine

if TYPE_CHECKING:
    from collections.abc import Callable, Iterator, Sequence
    from types import TracebackType
    from typing import Self

T = TypeVar("T")

_LOOK_S: Final = 0.5
"""A wait of Windows for a queue is not ended by Ctrl-C."""
_GRACE_S: Final = 3.0
"""How long an interrupted turn may take to see it: a read looks every quarter of a second."""


@dataclass(frozen=True, slots=True)
class Task(Generic[T]):
    """What is to be done with one PLC.

    Attributes:
        name: the PLC's.
        line: the PLCs with the same one are asked one after the other.
        work: does it, in a thread; raises what goes wrong.
    """

    name: str
    line: str
    work: Callable[[Turn[T]], T]


@dataclass(slots=True, eq=False)
class Turn(Generic[T]):
    """One PLC's turn. Only its thread changes it; others may read it.

    Attributes:
        task: what is done.
        shared: the line, open from one PLC on it to the next.
        limit: ends it; None before it begins.
        began: when it did, by the clock.
        phase: what is being done, in words; empty before it begins.
        done: pages so far.
        total: pages in all.
        duration_s: how long it took; None as long as it goes on.
        result: what the work gave; None if it failed.
        error: why it failed.
        interrupted: True if it was not begun, or ended early and came to nothing.
    """

    task: Task[T]
    shared: SharedLine | None = None
    limit: Limit | None = None
    began: float = 0.0
    phase: str = ""
    done: int = 0
    total: int = 0
    duration_s: float | None = None
    result: T | None = None
    error: FatektoolError | None = None
    interrupted: bool = True

    def progress(self, phase: str, done: int, total: int) -> None:
        """A job's progress callback."""
        self.phase, self.done, self.total = phase, done, total


@dataclass(slots=True)
class Fleet(Generic[T]):
    """Tasks at work, as long as a ``with`` statement lasts.

    Attributes:
        tasks: what is to be done.
        jobs: so many lines at once.
        deadline_s: how long one PLC's turn may take.
        turns: one for each task, in the same order.
    """

    tasks: Sequence[Task[T]]
    jobs: int
    deadline_s: float
    turns: list[Turn[T]] = field(init=False)
    _lines: deque[list[Turn[T]]] = field(init=False)
    _ended: SimpleQueue[Turn[T]] = field(init=False, default_factory=SimpleQueue)
    _reported: int = field(init=False, default=0)
    _stop: threading.Event = field(init=False, default_factory=threading.Event)
    _threads: list[threading.Thread] = field(init=False, default_factory=list)

    def __post_init__(self) -> None:
        self.turns = [Turn(task) for task in self.tasks]
        lines: dict[str, list[Turn[T]]] = {}
        for turn in self.turns:
            lines.setdefault(turn.task.line, []).append(turn)
        # The longest first, so that none of them is begun when all others have ended.
        self._lines = deque(sorted(lines.values(), key=len, reverse=True))

    def __enter__(self) -> Self:
        for number in range(min(self.jobs, len(self._lines))):
            # A daemon: one that hangs in the system must not keep the process from ending.
            thread = threading.Thread(target=self._work, name=f"fatektool line {number}", daemon=True)
            self._threads.append(thread)
            thread.start()
        return self

    def __exit__(
        self, kind: type[BaseException] | None, error: BaseException | None, trace: TracebackType | None
    ) -> None:
        self.stop()

    def ended(self, look_s: float | None = None) -> Iterator[Turn[T] | None]:
        """Each turn as it ends, until all have.

        Args:
            look_s: gives None after so many seconds in which none ended; by default it waits.
        """
        while self._reported < len(self.turns):
            try:
                turn = self._ended.get(timeout=_LOOK_S if look_s is None else look_s)
            except Empty:
                if look_s is not None:
                    yield None
                continue
            self._reported += 1
            yield turn

    def running(self) -> list[Turn[T]]:
        """The turns that have begun and not ended."""
        return [turn for turn in self.turns if turn.limit is not None and turn.duration_s is None]

    def stop(self) -> None:
        """End all turns early, and begin no other; which have ended shows in ``turns``."""
        self._stop.set()
        until = time.perf_counter() + _GRACE_S
        for thread in self._threads:
            thread.join(max(0.0, until - time.perf_counter()))

    def _work(self) -> None:
        while True:
            try:
                line = self._lines.popleft()
            except IndexError:
                return
            with SharedLine() as shared:
                for turn in line:
                    if self._stop.is_set():
                        return
                    turn.shared = shared
                    self._take(turn)
                    self._ended.put(turn)
                    shared.between()

    def _take(self, turn: Turn[T]) -> None:
        turn.began = time.perf_counter()
        turn.phase = "connecting"
        turn.limit = limit = Limit(self.deadline_s, self._stop)
        try:
            turn.result = turn.task.work(turn)
        except FatektoolError as error:
            turn.error = error
            if not limit.rest_s and not limit.stopped:  # what came of it, not what was the matter
                turn.error = limit.passed(error)
        except Exception as error:  # noqa: BLE001  # one PLC's fault must not end the others' turns
            turn.error = FatektoolError(
                f"a fault of fatektool itself: {type(error).__name__}: {error}",
                hint="please report it with the command line",
            )
        turn.interrupted = turn.error is not None and limit.stopped
        turn.duration_s = time.perf_counter() - turn.began
