"""Trace files: records up to the damage, each of which can be shown, written again and replayed."""

from __future__ import annotations

import io

from fatektool.errors import DataError
from fatektool.simulator.replay import Recorded, Replay
from fatektool.transport.trace import SENT, NdjsonTrace
from fatektool.transport.trace_reader import TraceRecord, read_trace
from fuzz.words import require_plain
from tests.protocol.decoding import framed


def one_input(data: bytes) -> None:
    """Read; write what was read, and read that."""
    records: list[TraceRecord] = []
    try:
        for record in read_trace(data, "line.pcap"):
            records.append(record)  # noqa: PERF402  # so that what came before an error is kept
    except DataError as error:
        require_plain(error)
    file = io.BytesIO()
    writer = NdjsonTrace(file, "facon")
    for record in records:
        assert record.time_s >= 0 or record.time < "1970"
        writer.record(int(record.time_s), record.direction, record.data)
    again = list(read_trace(file.getvalue(), "again.ndjson"))
    assert [(record.direction, record.data) for record in again] == [
        (record.direction, record.data) for record in records
    ]
    _replay(records)


def _replay(records: list[TraceRecord]) -> None:
    recorded = [Recorded(record.time_s, record.direction == SENT, record.data) for record in records]
    for protocol in ("facon", "mseries"):
        try:
            line = Replay(recorded, protocol).line()
        except DataError as error:
            require_plain(error)
            continue
        line.receive(framed(b"014E" + b"0123"), 0.0)
        for record in recorded:
            if record.sent:
                assert all(due >= 1.0 for due, _ in line.receive(record.data, 1.0))
