"""A PLC as an object: a typed method for each command, over a link that keeps answers apart.

All values are plain: discretes are bool, registers unsigned int, pages 128 bytes.
"""

from __future__ import annotations

import time
from typing import TYPE_CHECKING

from fatektool.errors import DataError, LineError, PlcBusy, PlcError, PlcRefused
from fatektool.exchange.batch import ask_all, ask_until_refused, tell_all
from fatektool.protocol.commands import (
    DETAILED_BYTES,
    Control,
    ControlDiscrete,
    Loopback,
    ReadBriefStatus,
    ReadDetailedStatus,
    ReadDisabled,
    ReadDiscretes,
    ReadMixed,
    ReadPage,
    ReadRegisters,
    RunStop,
    WriteDiscretes,
    WriteMixed,
    WritePage,
    WriteRegisters,
)

if TYPE_CHECKING:
    from collections.abc import Callable, Iterable, Sequence
    from contextlib import ExitStack
    from types import TracebackType
    from typing import Self

    from fatektool.exchange.link import Link
    from fatektool.protocol.commands import Request
    from fatektool.protocol.elements import Element
    from fatektool.protocol.status import BriefStatus, DetailedStatus
    from fatektool.transport.lent import LentTransport

_MODE_TRIES = 20


class Plc:
    """One PLC: station and line are the link's.

    Every method raises ``LineError`` when no answer can be trusted, and ``PlcRefused`` when the answer is
    an error code.

    Args:
        link: exchanges with one station.
        target: the target as the user named it.
        resources: closed with the PLC; None if the link is somebody else's.
        lent: the line, if others may have it now and then.
    """

    def __init__(
        self,
        link: Link,
        target: str,
        resources: ExitStack | None = None,
        lent: LentTransport | None = None,
    ) -> None:
        self.link = link
        self.target = target
        self._resources = resources
        self._lent = lent
        self._open = True

    @property
    def is_open(self) -> bool:
        """True until ``close``. A cable that was pulled does not show here: ask ``is_alive``."""
        return self._open

    @property
    def station(self) -> int:
        """Who is asked. Set it to ask another station on the same line, without opening it anew.

        Raises:
            UsageError: no PLC can have this station.
        """
        return self.link.station

    @station.setter
    def station(self, station: int) -> None:
        self.link.fences.turn_to(station)

    def is_alive(self) -> bool:
        """True if the PLC answers: one request that changes nothing, with the link's time-out and retries.

        A refusal is an answer too. False where no usable answer comes, and when the line is closed.
        """
        if not self._open:
            return False
        try:
            self.link.ask(self.link.codec.probe)
        except (PlcRefused, PlcBusy):
            return True
        except LineError:
            return False
        return True

    def take(self) -> None:
        """Have the line again if it was lent, however long that takes.

        Raises:
            LineError: it cannot be opened.
        """
        if self._lent is not None:
            self._lent.take()

    def lend(self, seconds: float, *, broken: bool = False) -> None:
        """Wait so many seconds; who waits for the line may have it, until it is asked for with ``take``.

        Args:
            seconds: from now on.
            broken: True if the line is to be opened anew in any case.
        """
        if self._lent is None:
            time.sleep(seconds)
            return
        if broken:
            self._lent.give_back()
        self._lent.lend(seconds)

    def close(self) -> None:
        """Close the line; again is fine."""
        self._open = False
        if self._resources is not None:
            self._resources.close()

    def __enter__(self) -> Self:
        return self

    def __exit__(
        self, kind: type[BaseException] | None, error: BaseException | None, trace: TracebackType | None
    ) -> None:
        self.close()

    # --- status and mode --------------------------------------------------------------------------

    def brief_status(self) -> BriefStatus:
        """40."""
        return self.link.ask(ReadBriefStatus())

    def detailed_status(self) -> DetailedStatus:
        """53.

        Raises:
            DataError: the answer has a layout that no paper describes.
        """
        status = self.link.ask(ReadDetailedStatus())
        from fatektool.protocol.status import RawStatus  # loaded by its parser, not before the request is out

        if isinstance(status, RawStatus):
            raise DataError(
                f"detailed status (53): expected {DETAILED_BYTES} bytes, got {len(status.raw)}, "
                f"and no paper says what they mean",
                hint="'fatektool status' shows them",
            )
        return status

    def run(self) -> None:
        """41, then read the mode back, as on some lines an acknowledgement proves nothing.

        Raises:
            PlcError: acknowledged, but the PLC does not run.
        """
        self._set_mode(run=True)

    def stop(self) -> None:
        """41, then read the mode back.

        Raises:
            PlcError: acknowledged, but the PLC does not stop.
        """
        self._set_mode(run=False)

    def _set_mode(self, *, run: bool) -> None:
        self.link.ask(RunStop(run))
        clock = self.link.transport.clock
        deadline = clock() + self.link.timeout_s
        word, other = ("RUN", "STOP") if run else ("STOP", "RUN")
        for _ in range(_MODE_TRIES):  # a PLC may need a scan or two
            try:
                flags = self.brief_status().flags
            except PlcRefused as error:
                raise PlcError(
                    f"the PLC acknowledged {word}, and its mode cannot be read back: {error.message}",
                    hint="look at the RUN lamp of the PLC",
                ) from error
            if flags.running == run:
                return
            if clock() > deadline:
                break
        raise PlcError(
            f"the PLC acknowledged {word}, but its status still says {other}",
            hint="see 'fatektool status': an emergency stop or the PLC's own switch may hold it",
        )

    # --- discretes --------------------------------------------------------------------------------

    def disable(self, element: Element) -> None:
        """42: take a discrete out of the program's hands."""
        self.link.ask(ControlDiscrete(Control.DISABLE, element))

    def enable(self, element: Element) -> None:
        """42: give a discrete back to the program."""
        self.link.ask(ControlDiscrete(Control.ENABLE, element))

    def set(self, element: Element) -> None:
        """42: switch a discrete on."""
        self.link.ask(ControlDiscrete(Control.SET, element))

    def reset(self, element: Element) -> None:
        """42: switch a discrete off."""
        self.link.ask(ControlDiscrete(Control.RESET, element))

    def read_disabled(self, first: Element, count: int) -> tuple[bool, ...]:
        """43: True for each of 1 to 256 discretes that is disabled."""
        return self.link.ask(ReadDisabled(first, count))

    def read_discretes(self, first: Element, count: int) -> tuple[bool, ...]:
        """44: 1 to 256 discretes."""
        return self.link.ask(ReadDiscretes(first, count))

    def write_discretes(self, first: Element, values: Iterable[bool]) -> None:
        """45: 1 to 256 discretes."""
        self.link.ask(WriteDiscretes(first, tuple(values)))

    # --- registers --------------------------------------------------------------------------------

    def read_registers(self, first: Element, count: int) -> tuple[int, ...]:
        """46: 1 to 64 words of 16 bits, or 1 to 32 of 32 bits, unsigned."""
        return self.link.ask(ReadRegisters(first, count))

    def write_registers(self, first: Element, values: Iterable[int]) -> None:
        """47: 1 to 64 words of 16 bits, or 1 to 32 of 32 bits, unsigned."""
        self.link.ask(WriteRegisters(first, tuple(values)))

    def read_mixed(self, elements: Iterable[Element]) -> tuple[int, ...]:
        """48: elements of any kind, at most 64 words in all."""
        return self.link.ask(ReadMixed(tuple(elements)))

    def write_mixed(self, items: Iterable[tuple[Element, int]]) -> None:
        """49: elements of any kind with their values, at most 32 words in all."""
        self.link.ask(WriteMixed(tuple(items)))

    # --- line and program -------------------------------------------------------------------------

    def broadcast(self, request: Request[None]) -> None:
        """A write to every PLC on the line. None answers: wait for as long as one may take to do it."""
        link = self.link
        link.broadcast(request)
        wire_s = link.codec.request_bytes(request) * link.byte_time_s
        link.hearing.listen_until(link.transport.clock() + wire_s + link.timeout_s)

    def loopback(self, data: bytes) -> bytes:
        """4E: what the PLC sends back, which is what it was sent."""
        return self.link.ask(Loopback(data))

    def read_page(self, page: int) -> bytes:
        """4F: one page of the program, 128 bytes."""
        return self.link.ask(ReadPage(page))

    def read_pages(self, pages: Sequence[int], on_page: Callable[[int], None] | None = None) -> list[bytes]:
        """4F for many pages, none of which can hold another's answer.

        Args:
            pages: their numbers.
            on_page: is called with the number of pages read so far.
        """
        return ask_all(self.link, [ReadPage(page) for page in pages], on_page)

    def read_pages_until_refused(
        self, pages: Sequence[int], on_page: Callable[[int], None] | None = None
    ) -> tuple[list[bytes], PlcRefused | None]:
        """The same up to the first page that is refused, and that refusal; None if all were given."""
        return ask_until_refused(self.link, [ReadPage(page) for page in pages], on_page)

    def write_page(self, page: int, data: bytes) -> None:
        """50: one page of the program, 128 bytes."""
        self.link.ask(WritePage(page, data))

    def write_pages(
        self, pages: Sequence[tuple[int, bytes]], on_page: Callable[[int], None] | None = None
    ) -> None:
        """50 for many pages, in order. Read them back: an acknowledgement is no proof.

        Args:
            pages: numbers with 128 bytes each.
            on_page: is called with the number of pages acknowledged so far; on an error, the page behind
                those may be written or not.
        """
        tell_all(self.link, [WritePage(page, data) for page, data in pages], on_page)
