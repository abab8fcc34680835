"""Reading of traces, ``.ndjson`` or ``.pcap``, damaged ones too."""

from __future__ import annotations

import json
import re
import struct
from dataclasses import dataclass
from datetime import datetime
from typing import TYPE_CHECKING, Final

from fatektool.errors import DataError
from fatektool.files.plain_text import EncodingError, plain_text
from fatektool.protocols import PROTOCOLS
from fatektool.transport.trace import LINK_TYPE, PCAP_MAGIC, RECEIVED, SENT, time_text

if TYPE_CHECKING:
    from collections.abc import Iterator

_GLOBAL: Final = 24
_RECORD: Final = 16
_PSEUDO_HEADER: Final = 4
_DIRECTIONS: Final = {b"\x01\x00": SENT, b"\x01\x01": RECEIVED}
"""A pseudo-header's first two bytes, version and direction."""
_PROTOCOLS: Final = {parts.trace_code: name for name, parts in PROTOCOLS.items()}
_MAX_PACKET: Final = 1 << 20
_TIME: Final = re.compile(r"\d{4}-\d\d-\d\dT\d\d:\d\d:\d\d(\.\d+)?Z", re.ASCII)
_HINT: Final = "expected a .ndjson or .pcap file that --trace wrote"


@dataclass(frozen=True, slots=True)
class TraceRecord:
    """One piece of a conversation.

    Attributes:
        time: UTC, RFC 3339.
        direction: ``tx`` sent, ``rx`` received.
        data: the bytes.
        protocol: the name of ``--protocol``; empty if the trace does not have it.
    """

    time: str
    direction: str
    data: bytes
    protocol: str = ""

    @property
    def time_s(self) -> float:
        """The time in seconds since 1970."""
        return datetime.fromisoformat(self.time).timestamp()


def read_trace(data: bytes, name: str) -> Iterator[TraceRecord]:
    """Read a trace file's bytes.

    Args:
        data: the bytes.
        name: the file's name, for messages.

    Raises:
        DataError: no trace, or a damaged one; the records before the damage are returned first.
    """
    if data[:4] in {struct.pack("<I", PCAP_MAGIC), struct.pack(">I", PCAP_MAGIC)}:
        return _read_pcap(data, name)
    return _read_ndjson(data, name)


def _read_ndjson(data: bytes, name: str) -> Iterator[TraceRecord]:
    for number, line in enumerate(data.splitlines(), 1):
        if not line.strip():
            continue
        try:
            entry = json.loads(plain_text(line))
            record = TraceRecord(
                str(entry["time"]),
                str(entry["direction"]),
                bytes.fromhex(entry["hex"]),
                str(entry.get("protocol", "")),
            )
        except (ValueError, KeyError, TypeError, AttributeError, RecursionError) as error:
            reason = f": {error}" if isinstance(error, EncodingError) else ""
            raise DataError(f"{name}: line {number}: not a trace record{reason}", hint=_HINT) from error
        if record.direction not in {SENT, RECEIVED}:
            raise DataError(f"{name}: line {number}: expected direction tx or rx", hint=_HINT)
        if not _is_time(record.time):
            raise DataError(f"{name}: line {number}: expected a time such as {time_text(0)}", hint=_HINT)
        yield record


def _is_time(text: str) -> bool:
    try:
        return _TIME.fullmatch(text) is not None and datetime.fromisoformat(text) is not None
    except ValueError:  # the 13th month
        return False


def _read_pcap(data: bytes, name: str) -> Iterator[TraceRecord]:
    order = "<" if data[:4] == struct.pack("<I", PCAP_MAGIC) else ">"
    if len(data) < _GLOBAL or struct.unpack_from(order + "I", data, 20)[0] != LINK_TYPE:
        raise DataError(f"{name}: not a trace of this program: expected link type {LINK_TYPE}")
    at = _GLOBAL
    number = 0
    while at < len(data):
        number += 1
        if len(data) - at < _RECORD:
            raise DataError(f"{name}: packet {number} is cut off")
        seconds, nanoseconds, size, _ = struct.unpack_from(order + "IIII", data, at)
        packet = data[at + _RECORD : at + _RECORD + size]
        direction = _DIRECTIONS.get(packet[:2])
        if not _PSEUDO_HEADER <= size <= _MAX_PACKET or len(packet) != size or direction is None:
            raise DataError(f"{name}: packet {number} is cut off or damaged")
        yield TraceRecord(
            time_text(seconds * 1_000_000_000 + nanoseconds),
            direction,
            packet[_PSEUDO_HEADER:],
            _PROTOCOLS.get(packet[2], ""),
        )
        at += _RECORD + size
