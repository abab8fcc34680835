"""Frames cut out of a stream of bytes, whatever its chunks, and found again behind bytes that are none.

::

    Delimited    begin ... end               FACON, Modbus ASCII
    Measured     a beginning that says how   M-series, Modbus RTU and TCP
                 long the frame is

As little as possible is dropped, so a good frame behind a bad one is found. Where a byte begins a frame
wherever it comes, a second one before the end begins another, and what was before it is dropped. Where the
length alone says where a frame ends, something is a frame if all that can be known of its beginning holds. If
it turns out to be none, it is dropped up to what could be the next beginning, even one within what its length
had covered. A frame that has not come whole when its time is over is dropped in the same way
(``expect_no_more``).
"""

from __future__ import annotations

from abc import ABC, abstractmethod
from typing import TYPE_CHECKING, ClassVar, Final

from fatektool.errors import FrameError

if TYPE_CHECKING:
    from fatektool.protocol.codec import Frame

_MAX_BUFFER: Final = 1 << 16


class Resync(ABC):
    """The bytes that were fed and not yet given as frames: a ``Decoder`` but for ``next_frame``."""

    def __init__(self) -> None:
        self._buffer = bytearray()
        self._all_came = False

    def feed(self, data: bytes) -> None:
        """Take bytes from the wire; of more than 64 KiB not asked for, the oldest are forgotten."""
        self._all_came = False
        self._buffer += data
        if len(self._buffer) > _MAX_BUFFER:
            del self._buffer[:-_MAX_BUFFER]

    def clear(self) -> int:
        """Forget what was fed and not yet given; return how many bytes that was."""
        left = len(self._buffer)
        self._buffer.clear()
        return left

    @abstractmethod
    def expect_no_more(self) -> bool:
        """The time for what was fed is over; True if ``next_frame`` may find something in it now."""

    @abstractmethod
    def next_frame(self) -> Frame | None:
        """Give the next whole frame, or None if more bytes are needed.

        Raises:
            FrameError: bytes that are no frame; they are dropped.
        """

    def _dropped(self, message: str, count: int, *, checksum: bool = False) -> FrameError:
        """Drop so many bytes, and say why."""
        raw = bytes(self._buffer[:count])
        del self._buffer[:count]
        return FrameError(message, raw=raw, checksum=checksum)


class Delimited(Resync):
    """Frames from a byte that is never inside a frame to an end that is not either.

    Attributes:
        begin: the byte that begins a frame.
        end: the bytes that end it.
        longest: how long a frame can be.
    """

    begin: ClassVar[bytes]
    end: ClassVar[bytes]
    longest: ClassVar[int]

    def expect_no_more(self) -> bool:
        """False: nothing can follow a frame that has not ended, as it would have begun another."""
        return False

    def next_frame(self) -> Frame | None:
        """Give the next whole frame, or None if more bytes are needed.

        Raises:
            FrameError: bytes that are no frame; they are dropped.
        """
        buffer = self._buffer
        if not buffer:
            return None
        start = buffer.find(self.begin)
        if start:
            raise self._dropped("noise outside a frame", start if start > 0 else len(buffer))
        end = buffer.find(self.end, 1)
        again = buffer.find(self.begin, 1, end if end > 0 else len(buffer))
        if again > 0:
            raise self._dropped("a frame broke off and another began", again)
        if end < 0:
            if len(buffer) >= self.longest:
                raise self._dropped(f"no end within {self.longest} bytes", len(buffer))
            return None
        raw = bytes(buffer[: end + len(self.end)])
        del buffer[: len(raw)]
        return self._parse(raw)

    @abstractmethod
    def _parse(self, raw: bytes) -> Frame:
        """The frame from begin to end.

        Raises:
            FrameError: a wrong checksum, or no frame.
        """


class Measured(Resync):
    """Frames that say at their beginning how long they are."""

    def expect_no_more(self) -> bool:
        """Drop a frame that began and does not end; look at what follows its beginning."""
        self._all_came = bool(self._buffer)
        return self._all_came

    def next_frame(self) -> Frame | None:
        """Give the next whole frame, or None if more bytes are needed.

        Raises:
            FrameError: bytes that are no frame; they are dropped.
        """
        buffer = self._buffer
        if not buffer:
            return None
        sizes = self._sizes(0)
        come = len(buffer)
        more = sizes is None
        for size in sizes or ():
            if size > come:
                more = True
                continue
            frame = self._frame(bytes(buffer[:size]))
            if frame is not None:
                del buffer[:size]
                return frame
        if more and not self._all_came:
            return None
        raise self._no_frame(sizes)

    def _no_frame(self, sizes: tuple[int, ...] | None) -> FrameError:
        """Drop what is no frame up to what could be the beginning of one."""
        drop = self._next_beginning()
        if not sizes:
            return self._dropped(self._noise(), drop)
        whole = [size for size in sizes if size <= len(self._buffer)]
        if not whole:
            return self._dropped("a frame broke off", drop)
        fault = self._fault(bytes(self._buffer[: whole[-1]]))
        if fault.checksum and drop >= whole[-1]:  # nothing within it could begin another: it was one frame
            return self._dropped(fault.message, whole[-1], checksum=True)
        return self._dropped(fault.message, drop)

    def _next_beginning(self) -> int:
        """Where behind the first byte the next frame may begin; the end of all bytes if nowhere."""
        at = 1
        while at < len(self._buffer) and self._sizes(at) == ():
            at += 1
        return at

    def _noise(self) -> str:
        """What is said of a first byte that begins no frame."""
        return "noise outside a frame"

    @abstractmethod
    def _sizes(self, at: int) -> tuple[int, ...] | None:
        """How long a frame that begins here may be, the shortest first; None if too little of it is there."""

    @abstractmethod
    def _frame(self, raw: bytes) -> Frame | None:
        """The frame that bytes of one of these sizes are, or None."""

    @abstractmethod
    def _fault(self, raw: bytes) -> FrameError:
        """Why bytes of one of these sizes are no frame."""
