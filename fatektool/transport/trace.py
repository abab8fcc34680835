r"""Recording of all bytes sent and received, with their times.

``.ndjson``, one line a record::

    {"time": "2026-11-22T03:15:00.123456Z", "protocol": "facon", "direction": "tx", "hex": "0230313430433703"}

``.pcap``, for Wireshark: link type 147 (user 0), nanosecond time stamps; a pseudo-header of four bytes before
the bytes of each record::

    version 01 · direction 00 sent, 01 received · protocol (``trace_code`` in ``protocols.py``) · 00

Bytes received in pieces are one record, up to the next request or time-out, so that a frame is seldom split;
a record has at most 32 KiB. A record is written when it is complete: if the program is killed, only the last
one is lost.
"""

from __future__ import annotations

import json
import os
import struct
import time
from contextlib import contextmanager
from typing import TYPE_CHECKING, BinaryIO, Final, Protocol

from fatektool.errors import TransportError, UsageError
from fatektool.files.portable_name import require_file_name
from fatektool.protocols import PROTOCOLS
from fatektool.transport.base import WrappedTransport

if TYPE_CHECKING:
    from collections.abc import Callable, Iterator
    from pathlib import Path

    from fatektool.transport.base import LineSettings, Transport

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
        """Close the file; may be called again."""


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
    """Create a trace file, ``.pcap`` or ``.ndjson`` by its name.

    Raises:
        UsageError: another suffix, or the file cannot be written.
    """
    suffix = path.suffix.lower()
    if suffix not in {".pcap", ".ndjson"}:
        raise UsageError(f"trace {path}: expected a name that ends in .pcap or .ndjson")
    require_file_name(str(path))
    try:
        file = open(path, "wb", opener=_private)  # noqa: SIM115  # the writer closes it
    except (OSError, ValueError) as error:
        reason = getattr(error, "strerror", None) or error
        raise UsageError(f"cannot write the trace {path}: {reason}") from error
    return PcapTrace(file, protocol) if suffix == ".pcap" else NdjsonTrace(file, protocol)


def _private(path: str, flags: int) -> int:
    """A trace may contain a program: only owner and group can read it, as a backup."""
    return os.open(path, flags, 0o640)


def time_text(time_ns: int) -> str:
    """A time stamp as RFC 3339, UTC, with microseconds."""
    seconds, nanoseconds = divmod(time_ns, 1_000_000_000)
    return time.strftime("%Y-%m-%dT%H:%M:%S", time.gmtime(seconds)) + f".{nanoseconds // 1000:06d}Z"


class TracedTransport(WrappedTransport):
    """A transport whose bytes are recorded.

    Args:
        inner: the medium.
        writer: gets the records.
        time_ns: the time of day; for tests.
    """

    def __init__(
        self, inner: Transport, writer: TraceWriter, *, time_ns: Callable[[], int] = time.time_ns
    ) -> None:
        super().__init__(inner)
        self._writer = writer
        self._time_ns = time_ns
        self._received = bytearray()
        self._received_at = 0

    def read(self, max_bytes: int, timeout_s: float) -> bytes:
        """Read, and keep the bytes for their record."""
        try:
            data = super().read(max_bytes, timeout_s)
        except TransportError:
            self._flush()
            raise
        self._keep(data)
        return data

    def write(self, data: bytes) -> None:
        """Record what was received before, then ``data``, and write it."""
        self._flush()
        self._record(self._time_ns(), SENT, data)
        super().write(data)

    def drain(self) -> bytes:
        """Drain, and keep the bytes for their record."""
        data = super().drain()
        if data:
            self._keep(data)
        return data

    def configure(self, settings: LineSettings) -> None:
        """Set speed and format; the bytes before are a record of their own."""
        self._flush()
        super().configure(settings)

    def close(self) -> None:
        """Write the last record and close both, even if the record cannot be written."""
        try:
            self._flush()
        finally:
            super().close()
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
