"""Splits a stream of bytes into frames, and finds the next frame after bytes that are not a frame.

::

    Delimited    begin ... end               FACON, Modbus ASCII
    Measured     a beginning that has    M-series, Modbus RTU and TCP
                 the frame's length

As little as possible is dropped, so that a valid frame after an invalid one is found. If a byte always begins
a frame, a second one before the end begins another frame, and the bytes before it are dropped. If only the
length gives the end of a frame, bytes are accepted as a frame if everything that is known of its beginning is
valid. If they are not a frame after all, they are dropped up to the next possible beginning, even one within
their length. A frame that is incomplete when its time is over is dropped in the same way
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
    """The bytes that were not yet returned as frames: a ``Decoder`` without ``next_frame``."""

    def __init__(self) -> None:
        self._buffer = bytearray()
        self._all_came = False

    def feed(self, data: bytes) -> None:
        """Add received bytes; of more than 64 KiB, the oldest are dropped."""
        self._all_came = False
        self._buffer += data
        if len(self._buffer) > _MAX_BUFFER:
            del self._buffer[:-_MAX_BUFFER]

    def clear(self) -> int:
        """Drop all bytes that were not returned as frames; return their number."""
        left = len(self._buffer)
        self._buffer.clear()
        return left

    @abstractmethod
    def expect_no_more(self) -> bool:
        """Note that no more bytes are expected; True if ``next_frame`` may find something now."""

    @abstractmethod
    def next_frame(self) -> Frame | None:
        """The next complete frame, or None if more bytes are needed.

        Raises:
            FrameError: bytes that are not a frame; they are dropped.
        """

    def _dropped(self, message: str, count: int, *, checksum: bool = False) -> FrameError:
        """Drop a number of bytes; returns the error with the reason."""
        raw = bytes(self._buffer[:count])
        del self._buffer[:count]
        return FrameError(message, raw=raw, checksum=checksum)


class Delimited(Resync):
    """Frames from a beginning to an end, neither of which can be inside a frame.

    Attributes:
        begin: the byte that begins a frame.
        end: the bytes that end it.
        longest: the most bytes of a frame.
    """

    begin: ClassVar[bytes]
    end: ClassVar[bytes]
    longest: ClassVar[int]

    def expect_no_more(self) -> bool:
        """False: after an incomplete frame there is no other beginning."""
        return False

    def next_frame(self) -> Frame | None:
        """The next complete frame, or None if more bytes are needed.

        Raises:
            FrameError: bytes that are not a frame; they are dropped.
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
            raise self._dropped("an incomplete frame, then another beginning", again)
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
            FrameError: a wrong checksum, or not a frame.
        """


class Measured(Resync):
    """Frames with their length at the beginning."""

    def expect_no_more(self) -> bool:
        """Drop an incomplete frame; look at the bytes after its beginning."""
        self._all_came = bool(self._buffer)
        return self._all_came

    def next_frame(self) -> Frame | None:
        """The next complete frame, or None if more bytes are needed.

        Raises:
            FrameError: bytes that are not a frame; they are dropped.
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
        """Drop bytes up to the next possible beginning of a frame."""
        drop = self._next_beginning()
        if not sizes:
            return self._dropped(self._noise(), drop)
        whole = [size for size in sizes if size <= len(self._buffer)]
        if not whole:
            return self._dropped("an incomplete frame", drop)
        fault = self._fault(bytes(self._buffer[: whole[-1]]))
        if fault.checksum and drop >= whole[-1]:  # no other beginning within it: it was one frame
            return self._dropped(fault.message, whole[-1], checksum=True)
        return self._dropped(fault.message, drop)

    def _next_beginning(self) -> int:
        """The next possible beginning of a frame after the first byte; the end of all bytes if none."""
        at = 1
        while at < len(self._buffer) and self._sizes(at) == ():
            at += 1
        return at

    def _noise(self) -> str:
        """The message for a first byte that begins no frame."""
        return "noise outside a frame"

    @abstractmethod
    def _sizes(self, at: int) -> tuple[int, ...] | None:
        """The possible lengths of a frame that begins here, the shortest first; None if not known yet."""

    @abstractmethod
    def _frame(self, raw: bytes) -> Frame | None:
        """The frame in bytes of one of these sizes, or None."""

    @abstractmethod
    def _fault(self, raw: bytes) -> FrameError:
        """The reason why bytes of one of these sizes are not a frame."""
