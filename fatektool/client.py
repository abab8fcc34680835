"""A PLC as an object, with a typed method for each command, based on a ``Link``.

All values are plain: discretes are bool, registers unsigned int, pages 128 bytes. An element is an
``Element`` or its text, ``"R12"``.
"""

from __future__ import annotations

import time
from typing import TYPE_CHECKING

from fatektool.errors import DataError, LineError, PlcBusy, PlcRefused
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
    WriteDiscretes,
    WriteMixed,
    WritePage,
    WriteRegisters,
)
from fatektool.protocol.elements import Element

if TYPE_CHECKING:
    from collections.abc import Callable, Collection, Iterable, Sequence
    from contextlib import ExitStack
    from types import TracebackType
    from typing import Self

    from fatektool.exchange.link import Link
    from fatektool.protocol.commands import Request
    from fatektool.protocol.status import BriefStatus, DetailedStatus
    from fatektool.transport.lent import LentTransport


class Plc:
    """One PLC.

    Every method that sends a request raises ``LineError`` without a valid answer (``NoAnswer`` after all
    retries), ``PlcRefused`` if the answer is an error code, and ``UsageError`` if the protocol cannot express
    the request. Every write raises ``LineReadOnly`` on a read-only line, before anything is sent.

    Args:
        link: requests to one station and their answers.
        target: the target as the user wrote it.
        resources: closed with the PLC; None if the caller closes the link.
        lent: the line, if other processes may use it between two rounds.
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

    @classmethod
    def of(cls, plc: Plc) -> Self:
        """The same PLC on the same open line, as this class."""
        return cls(plc.link, plc.target, plc._resources, plc._lent)  # of the same class

    @property
    def is_open(self) -> bool:
        """True until ``close``. It stays True when the cable is pulled: see ``is_alive``."""
        return self._open

    @property
    def station(self) -> int:
        """The station of the PLC. Set it to send requests to another station on the same line.

        Raises:
            UsageError: no PLC can have this station.
        """
        return self.link.station

    @station.setter
    def station(self, station: int) -> None:
        self.link.fences.change_station(station)

    def is_alive(self) -> bool:
        """Ask whether the PLC answers, by a request that changes nothing, with retries.

        Returns:
            True for an answer, also an error code. False without a valid answer, and after ``close``.
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
        """Open the line again if it was released; wait for it as long as another process uses it.

        Raises:
            LineError: it cannot be opened.
        """
        if self._lent is not None:
            self._lent.take()

    def lend(
        self, seconds: float, *, broken: bool = False, sleep: Callable[[float], object] | None = None
    ) -> None:
        """Wait. Another process that waits for the line gets it meanwhile, until ``take``.

        Args:
            seconds: how long to wait.
            broken: True to open the line again in any case.
            sleep: waits; it may raise to end the waiting. None for ``time.sleep``.
        """
        sleep = sleep or time.sleep
        if self._lent is None:
            sleep(seconds)
            return
        if broken:
            self._lent.give_back()
        self._lent.lend(seconds, sleep)

    def close(self) -> None:
        """Close the line. Closing it twice is allowed."""
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
        """Read the brief status (command 40): mode, faults, model."""
        return self.link.ask(ReadBriefStatus())

    def detailed_status(self) -> DetailedStatus:
        """Read the detailed status (command 53): unit type, OS version, ladder size in words, element counts.

        Raises:
            DataError: the answer has a layout that no paper describes.
        """
        status = self.link.ask(ReadDetailedStatus())
        from fatektool.protocol.status import RawStatus  # loaded by its parser, not before the request is out

        if isinstance(status, RawStatus):
            raise DataError(
                f"detailed status (53): expected {DETAILED_BYTES} bytes, got {len(status.raw)}, "
                "in a layout that no paper describes",
                hint="'fatektool status' shows them",
            )
        return status

    def run(self) -> None:
        """Start the program (command 41), then read the mode back.

        An acknowledgement is not a proof: on a line with echo, the echo of the request may look like one.

        Raises:
            PlcError: acknowledged, but the PLC is not in RUN.
        """
        from fatektool.exchange.mode import set_mode

        set_mode(self.link, run=True)

    def stop(self) -> None:
        """Stop the program (command 41), then read the mode back.

        Raises:
            PlcError: acknowledged, but the PLC is not in STOP.
        """
        from fatektool.exchange.mode import set_mode

        set_mode(self.link, run=False)

    # --- discretes --------------------------------------------------------------------------------

    def disable(self, element: Element | str) -> None:
        """Disable a discrete (command 42): the program no longer changes it."""
        self.link.ask(ControlDiscrete(Control.DISABLE, Element.of(element)))

    def enable(self, element: Element | str) -> None:
        """Enable a discrete (command 42): the program controls it again."""
        self.link.ask(ControlDiscrete(Control.ENABLE, Element.of(element)))

    def set(self, element: Element | str) -> None:
        """Set a discrete to 1 (command 42)."""
        self.link.ask(ControlDiscrete(Control.SET, Element.of(element)))

    def reset(self, element: Element | str) -> None:
        """Reset a discrete to 0 (command 42)."""
        self.link.ask(ControlDiscrete(Control.RESET, Element.of(element)))

    def read_disabled(self, first: Element | str, count: int) -> tuple[bool, ...]:
        """Read which of 1 to 256 consecutive discretes are disabled (command 43): True for disabled."""
        return self.link.ask(ReadDisabled(Element.of(first), count))

    def read_discretes(self, first: Element | str, count: int) -> tuple[bool, ...]:
        """Read 1 to 256 consecutive discretes (command 44)."""
        return self.link.ask(ReadDiscretes(Element.of(first), count))

    def write_discretes(self, first: Element | str, values: Iterable[bool]) -> None:
        """Write 1 to 256 consecutive discretes (command 45)."""
        self.link.ask(WriteDiscretes(Element.of(first), tuple(values)))

    # --- registers --------------------------------------------------------------------------------

    def read_registers(self, first: Element | str, count: int) -> tuple[int, ...]:
        """Read consecutive registers (command 46): 1 to 64 of 16 bits or 1 to 32 of 32 bits, unsigned."""
        return self.link.ask(ReadRegisters(Element.of(first), count))

    def write_registers(self, first: Element | str, values: Iterable[int]) -> None:
        """Write consecutive registers (command 47): 1 to 64 of 16 bits or 1 to 32 of 32 bits, unsigned."""
        self.link.ask(WriteRegisters(Element.of(first), tuple(values)))

    def read_mixed(self, elements: Iterable[Element | str]) -> tuple[int, ...]:
        """Read elements of any kind (command 48), at most 64 words in total; a discrete is 0 or 1."""
        return self.link.ask(ReadMixed(tuple(map(Element.of, elements))))

    def write_mixed(self, items: Iterable[tuple[Element | str, int]]) -> None:
        """Write elements of any kind (command 49), at most 32 words in total; a discrete is 0 or 1."""
        self.link.ask(WriteMixed(tuple((Element.of(each), value) for each, value in items)))

    # --- line and program -------------------------------------------------------------------------

    def broadcast(self, request: Request[None]) -> None:
        """Send a write to every PLC on the line (station 0), then wait for as long as a PLC may take.

        PLCs do not reply to broadcasts, so success cannot be checked.
        """
        link = self.link
        link.broadcast(request)
        wire_s = link.codec.request_bytes(request) * link.byte_time_s
        link.receiver.listen_until(link.transport.clock() + wire_s + link.timeout_s)

    def loopback(self, data: bytes) -> bytes:
        """Send up to 256 characters (command 4E); returns the PLC's answer, which has the same characters."""
        return self.link.ask(Loopback(data))

    def read_page(self, page: int) -> bytes:
        """Read one page of the program (command 4F), 128 bytes."""
        return self.link.ask(ReadPage(page))

    def read_pages(
        self,
        pages: Sequence[int],
        on_page: Callable[[int], None] | None = None,
        *,
        separated: Collection[int] = (),
    ) -> list[bytes]:
        """Read many pages of the program (command 4F), 128 bytes each, each proven to be the right one.

        Args:
            pages: page numbers.
            on_page: gets the number of pages read so far.
            separated: places in ``pages`` before which a brief status (40) is read, so that the answer to the
                page before cannot be taken for theirs.
        """
        from fatektool.exchange.batch import read_separated  # who reads no program does not load it

        requests = [ReadPage(page) for page in pages]
        return read_separated(self.link, requests, ReadBriefStatus(), separated, on_page)

    def read_pages_until_refused(
        self, pages: Sequence[int], on_page: Callable[[int], None] | None = None
    ) -> tuple[list[bytes], PlcRefused | None]:
        """Read pages up to the first that the PLC refuses.

        Args:
            pages: page numbers.
            on_page: gets the number of pages read so far.

        Returns:
            The pages before it, and the refusal; None if the PLC refused none.
        """
        from fatektool.exchange.batch import read_until_refused

        return read_until_refused(self.link, [ReadPage(page) for page in pages], on_page)

    def write_page(self, page: int, data: bytes) -> None:
        """Write one page of the program (command 50), 128 bytes."""
        self.link.ask(WritePage(page, data))

    def write_pages(
        self, pages: Sequence[tuple[int, bytes]], on_page: Callable[[int], None] | None = None
    ) -> None:
        """Write many pages of the program (command 50) in order.

        Read them back afterwards: an acknowledgement is not a proof.

        Args:
            pages: numbers with 128 bytes each.
            on_page: gets the number of pages acknowledged so far; on an error, the page after
                those may be written or not.
        """
        from fatektool.exchange.batch import write_all

        write_all(self.link, [WritePage(page, data) for page, data in pages], on_page)
