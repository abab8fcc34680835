"""What the decoders of the Modbus framings have in common: the buffer, and frames that say their length.

Something is a frame if all that can be known of its beginning holds. If not, as little as possible is
dropped, up to what could be the beginning of the next. So a good frame behind a bad one is found. One that
began and has not ended when its time is over is dropped in the same way (``expect_no_more``).
"""

from __future__ import annotations

from abc import ABC, abstractmethod
from typing import TYPE_CHECKING, Final

from fatektool.errors import FrameError

if TYPE_CHECKING:
    from fatektool.protocol.codec import Frame

_MAX_BUFFER: Final = 1 << 16


class Buffer(ABC):
    """Bytes from the wire, not yet given as frames."""

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
    def next_frame(self) -> Frame | None:
        """Give the next whole frame, or None if more bytes are needed."""

    def _take(self, count: int) -> bytes:
        taken = bytes(self._buffer[:count])
        del self._buffer[:count]
        return taken


class ByLength(Buffer):
    """A decoder of frames that tell their length at their beginning."""

    def expect_no_more(self) -> bool:
        """Let go of a frame that began and does not end, and look at what stands behind its beginning."""
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
        sizes = self._sizes(buffer, 0)
        if sizes is not None:
            for size in sizes:
                if size <= len(buffer):
                    frame = self._whole(bytes(buffer[:size]))
                    if frame is not None:
                        del buffer[:size]
                        return frame
        if not self._all_came and (sizes is None or any(size > len(buffer) for size in sizes)):
            return None
        raise self._error(sizes)

    def _error(self, sizes: tuple[int, ...] | None) -> FrameError:
        """Drop what is no frame up to what could be the beginning of one."""
        drop = 1
        while drop < len(self._buffer) and self._sizes(self._buffer, drop) == ():
            drop += 1
        if not sizes:
            return FrameError("noise outside a frame", raw=self._take(drop))
        whole = [size for size in sizes if size <= len(self._buffer)]
        if not whole:
            return FrameError("a frame broke off", raw=self._take(drop))
        damaged = drop >= whole[-1]  # nothing within it could begin another: it was one frame
        return FrameError("checksum: the CRC does not hold", raw=self._take(drop), checksum=damaged)

    @abstractmethod
    def _sizes(self, buffer: bytearray, at: int) -> tuple[int, ...] | None:
        """How long a frame that begins here may be, the shortest first; None if too little of it is there."""

    @abstractmethod
    def _whole(self, raw: bytes) -> Frame | None:
        """The frame that these bytes are, or None."""
