"""A PLC that keeps one answer back: what a test does while a command waits for it needs no slow line."""

from __future__ import annotations

import threading
from typing import TYPE_CHECKING

from tests.guard import GUARD_S

if TYPE_CHECKING:
    from types import TracebackType

    from fatektool.simulator.build import Simulation


class HeldAnswer:
    """The answer to the first request for one page, for a ``with`` statement.

    The block is entered when the PLC has the request, which it carries out and answers when the block ends.

    Args:
        simulation: with station 1, served by a thread of this process.
        operation: ``read_page`` or ``write_page``.
        page: whose request is kept waiting.
    """

    def __init__(self, simulation: Simulation, operation: str, page: int) -> None:
        self._asked, self._ended = threading.Event(), threading.Event()
        device = simulation.plcs[1]
        original = getattr(device, operation)

        def held(number: int, *content: bytes) -> object:
            if number == page:
                self._asked.set()
                assert self._ended.wait(GUARD_S)
            return original(number, *content)

        setattr(device, operation, held)

    def __enter__(self) -> None:
        assert self._asked.wait(GUARD_S)

    def __exit__(
        self, kind: type[BaseException] | None, error: BaseException | None, trace: TracebackType | None
    ) -> None:
        self._ended.set()
