r"""A record of the wire: what went out and what came in, with the time of each.

``.ndjson``, one line a record::

    {"time": "2026-11-22T03:15:00.123456Z", "protocol": "facon", "direction": "tx", "hex": "0230313430433703"}

``.pcap``, for Wireshark: link type 147 (user 0), nanosecond time stamps; before the bytes of each record
stands a pseudo-header of four bytes::

    version 01 · direction 00 sent, 01 received · protocol (``trace_code`` in ``protocols.py``) · 00

Bytes that came in pieces make one record up to the next request or time-out, so that a frame is seldom split;
of a line that babbles on, a record holds 32 KiB.
A record is written when it is complete: a program that dies keeps all but the last.
"""

from __future__ import annotations

import json
import os
import struct
import time
from contextlib import contextmanager
from typing import TYPE_CHECKING, BinaryIO, Final, Protocol

from fatektool.errors import TransportError, UsageError
from fatektool.protocols import PROTOCOLS
from fatektool.transport.base import Transport

if TYPE_CHECKING:
    from collections.abc import Callable, Iterator
    from pathlib import Path

    from fatektool.transport.base import LineSettings

LINK_TYPE: Final = 147
PCAP_MAGIC: Final = 0xA1B23C4D  # nanoseconds, in the writer's byte order
SENT: Final = "tx"
RECEIVED: Final = "rx"
_MAX_RECORD: Final = 1 << 15
_PCAP_HEADER: Final = struct.Struct("<IHHiIII")
_RECORD_HEADER: Final = struct.Struct("<IIII")


class TraceWriter(Protocol):
    """Writes records to a file."""

    def record(self, time_ns: int, direction: str, data: bytes) -> None:
        """Write one record."""

    def close(self) -> None:
        """Close the file; again is fine."""


class NdjsonTrace:
    """One JSON line a record."""

    def __init__(self, file: BinaryIO, protocol: str) -> None:
        self._file = file
        self._protocol = protocol

    def record(self, time_ns: int, direction: str, data: bytes) -> None:
        """Write one record."""
        entry = {
            "time": time_text(time_ns),
            "protocol": self._protocol,
            "direction": direction,
            "hex": data.hex().upper(),
        }
        self._file.write(json.dumps(entry).encode() + b"\n")
        self._file.flush()

    def close(self) -> None:
        """Close the file."""
        self._file.close()


class PcapTrace:
    """A capture file for Wireshark."""

    def __init__(self, file: BinaryIO, protocol: str) -> None:
        self._file = file
        self._protocol = PROTOCOLS[protocol].trace_code
        file.write(_PCAP_HEADER.pack(PCAP_MAGIC, 2, 4, 0, 0, 65535, LINK_TYPE))
        file.flush()

    def record(self, time_ns: int, direction: str, data: bytes) -> None:
        """Write one record."""
        packet = bytes([1, direction == RECEIVED, self._protocol, 0]) + data
        seconds, nanoseconds = divmod(time_ns, 1_000_000_000)
        self._file.write(_RECORD_HEADER.pack(seconds, nanoseconds, len(packet), len(packet)) + packet)
        self._file.flush()

    def close(self) -> None:
        """Close the file."""
        self._file.close()


def open_trace(path: Path, protocol: str) -> TraceWriter:
    """Begin a trace file, ``.pcap`` or ``.ndjson`` by its name.

    Raises:
        UsageError: another ending, or a file that cannot be written.
    """
    suffix = path.suffix.lower()
    if suffix not in {".pcap", ".ndjson"}:
        raise UsageError(f"trace {path}: expected a name that ends in .pcap or .ndjson")
    try:
        file = open(path, "wb", opener=_private)  # noqa: SIM115  # the writer closes it
    except (OSError, ValueError) as error:
        reason = getattr(error, "strerror", None) or error
        raise UsageError(f"cannot write the trace {path}: {reason}") from error
    return PcapTrace(file, protocol) if suffix == ".pcap" else NdjsonTrace(file, protocol)


def _private(path: str, flags: int) -> int:
    """A program may be read in a trace: it is for its owner and the group, as backups are."""
    return os.open(path, flags, 0o640)


def time_text(time_ns: int) -> str:
    """A time stamp as RFC 3339, UTC, with microseconds."""
    seconds, nanoseconds = divmod(time_ns, 1_000_000_000)
    return time.strftime("%Y-%m-%dT%H:%M:%S", time.gmtime(seconds)) + f".{nanoseconds // 1000:06d}Z"


class TracedTransport(Transport):
    """A transport whose traffic is recorded.

    Args:
        inner: the medium.
        writer: where to.
        time_ns: the time of day; for tests.
    """

    def __init__(
        self, inner: Transport, writer: TraceWriter, *, time_ns: Callable[[], int] = time.time_ns
    ) -> None:
        self._inner = inner
        self._writer = writer
        self._time_ns = time_ns
        self._received = bytearray()
        self._received_at = 0
        self.name = inner.name
        self.line = inner.line
        self.clock = inner.clock

    def read(self, max_bytes: int, timeout_s: float) -> bytes:
        """Read, and keep what came for its record."""
        try:
            data = self._inner.read(max_bytes, timeout_s)
        except TransportError:
            self._flush()
            raise
        self._keep(data)
        return data

    def write(self, data: bytes) -> None:
        """Record what came before, then what goes out."""
        self._flush()
        self._record(self._time_ns(), SENT, data)
        self._inner.write(data)

    def drain(self) -> bytes:
        """Take what is there, and keep it for its record."""
        data = self._inner.drain()
        if data:
            self._keep(data)
        return data

    def set_line(self, line: LineSettings) -> None:
        """Take another speed and format."""
        self._flush()
        self._inner.set_line(line)
        self.line = self._inner.line

    def renew(self) -> None:
        """Start afresh."""
        self._inner.renew()

    def close(self) -> None:
        """Write the last record and close both, whatever becomes of the record."""
        try:
            self._flush()
        finally:
            self._inner.close()
            with _writing():
                self._writer.close()

    def _keep(self, data: bytes) -> None:
        if not self._received:
            self._received_at = self._time_ns()
        self._received += data
        if len(self._received) >= _MAX_RECORD:
            self._flush()

    def _flush(self) -> None:
        data = bytes(self._received)
        self._received.clear()
        for at in range(0, len(data), _MAX_RECORD):
            self._record(self._received_at, RECEIVED, data[at : at + _MAX_RECORD])

    def _record(self, time_ns: int, direction: str, data: bytes) -> None:
        with _writing():
            self._writer.record(time_ns, direction, data)


@contextmanager
def _writing() -> Iterator[None]:
    """The operating system's errors in the project's words."""
    try:
        yield
    except (OSError, ValueError) as error:
        raise UsageError(f"cannot write the trace: {getattr(error, 'strerror', None) or error}") from error
