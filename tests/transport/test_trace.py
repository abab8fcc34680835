"""The record of the wire: what is written reads back the same, and damage is named by its place."""

from __future__ import annotations

import io
import json
import struct
from pathlib import Path
from typing import TYPE_CHECKING, BinaryIO

import jsonschema
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

import fatektool
from fatektool.errors import DataError, TransportClosed, TransportTimeout, UsageError
from fatektool.transport.memory import MemoryTransport
from fatektool.transport.trace import (
    NdjsonTrace,
    PcapTrace,
    TracedTransport,
    TraceWriter,
    open_trace,
    time_text,
)
from fatektool.transport.trace_reader import TraceRecord, read_trace
from tests.rows import each

if TYPE_CHECKING:
    from collections.abc import Callable

T0_NS = 1_795_317_300_123_456_789
T0 = "2026-11-22T03:15:00.123456Z"
ASKS, ANSWERS = b"\x020140C7\x03", b"\x020140029000022\x03"
SCHEMA = json.loads((Path(fatektool.__file__).parent / "schemas/trace.json").read_text("utf-8"))
WRITERS: dict[str, Callable[[BinaryIO], TraceWriter]] = {
    ".ndjson": lambda file: NdjsonTrace(file, "facon"),
    ".pcap": lambda file: PcapTrace(file, "facon"),
}
suffixes = pytest.mark.parametrize("suffix", WRITERS)


class Script:
    """A peer that answers each request with the next pieces of a script."""

    def __init__(self, *answers: list[tuple[float, bytes]]) -> None:
        self._answers = list(answers)

    def receive(self, data: bytes, now: float) -> list[tuple[float, bytes]]:
        del data
        return [(now + after, piece) for after, piece in self._answers.pop(0)]


class Kept(io.BytesIO):
    """A file whose bytes are there after it is closed."""

    kept = b""

    def close(self) -> None:
        if not self.closed:
            self.kept = self.getvalue()
        super().close()


def counting(step_ns: int = 1_000_000_000) -> Callable[[], int]:
    times = iter(range(T0_NS, T0_NS + 1000 * step_ns, step_ns))
    return lambda: next(times)


def traced(path: Path, *answers: list[tuple[float, bytes]]) -> TracedTransport:
    return TracedTransport(MemoryTransport(Script(*answers)), open_trace(path, "facon"), time_ns=counting())


def read_back(path: Path) -> list[tuple[str, bytes]]:
    return [(record.direction, record.data) for record in read_trace(path.read_bytes(), path.name)]


# --- through a transport --------------------------------------------------------------------------


@suffixes
def test_a_conversation(tmp_path: Path, suffix: str) -> None:
    path = tmp_path / f"line{suffix}"
    with traced(path, [(0.1, ANSWERS[:4]), (0.2, ANSWERS[4:])], [], [(0.1, ANSWERS)]) as line:
        line.write(ASKS)
        assert line.read(100, 1.0) == ANSWERS[:4]
        assert line.read(100, 1.0) == ANSWERS[4:]
        line.write(ASKS)
        with pytest.raises(TransportTimeout):
            line.read(100, 1.0)
        line.write(ASKS)
        assert line.read(5, 1.0) + line.read(100, 1.0) == ANSWERS
    assert list(read_trace(path.read_bytes(), path.name)) == [
        TraceRecord(T0, "tx", ASKS, "facon"),
        TraceRecord("2026-11-22T03:15:01.123456Z", "rx", ANSWERS, "facon"),  # the time of its first piece
        TraceRecord("2026-11-22T03:15:02.123456Z", "tx", ASKS, "facon"),
        TraceRecord("2026-11-22T03:15:03.123456Z", "tx", ASKS, "facon"),
        TraceRecord("2026-11-22T03:15:04.123456Z", "rx", ANSWERS, "facon"),
    ]


def test_both_forms_hold_the_same(tmp_path: Path) -> None:
    class Both:
        def __init__(self) -> None:
            self.writers = [open_trace(tmp_path / f"line{suffix}", "facon") for suffix in WRITERS]

        def record(self, time_ns: int, direction: str, data: bytes) -> None:
            for writer in self.writers:
                writer.record(time_ns, direction, data)

        def close(self) -> None:
            for writer in self.writers:
                writer.close()

    inner = MemoryTransport(Script([(0.1, ANSWERS[:4]), (0.2, ANSWERS[4:])], []))
    with TracedTransport(inner, Both(), time_ns=counting(333_333_333)) as line:
        line.write(ASKS)
        line.read(100, 1.0)
        line.read(100, 1.0)
        line.write(ASKS)
    first, second = (
        list(read_trace((tmp_path / f"line{suffix}").read_bytes(), suffix)) for suffix in WRITERS
    )
    assert first == second
    assert [record.direction for record in first] == ["tx", "rx", "tx"]


@suffixes
def test_a_time_out_ends_a_record(tmp_path: Path, suffix: str) -> None:
    path = tmp_path / f"line{suffix}"
    with traced(path, [(0.1, ANSWERS[:4]), (5.0, ANSWERS[4:])]) as line:
        line.write(ASKS)
        line.read(100, 1.0)
        with pytest.raises(TransportTimeout):
            line.read(100, 1.0)
        assert read_back(path) == [("tx", ASKS), ("rx", ANSWERS[:4])]  # on disk already
        line.read(100, 10.0)
        assert read_back(path) == [("tx", ASKS), ("rx", ANSWERS[:4])]
    assert read_back(path) == [("tx", ASKS), ("rx", ANSWERS[:4]), ("rx", ANSWERS[4:])]


@suffixes
def test_what_is_drained_is_recorded(tmp_path: Path, suffix: str) -> None:
    path = tmp_path / f"line{suffix}"
    with traced(path, [(0.0, b"stray")]) as line:
        assert line.drain() == b""
        line.write(ASKS)
        assert line.drain() == b"stray"
    assert read_back(path) == [("tx", ASKS), ("rx", b"stray")]


@suffixes
def test_it_is_the_inner_transport_to_all_others(tmp_path: Path, suffix: str) -> None:
    inner = MemoryTransport(Script(), name="sim:here")
    line = TracedTransport(inner, open_trace(tmp_path / f"line{suffix}", "facon"))
    assert (line.name, line.serial_settings, line.clock) == ("sim:here", None, inner.clock)
    line.renew()
    line.close()
    line.close()
    with pytest.raises(TransportClosed):
        line.read(1, 0.0)


@suffixes
def test_a_babbling_line_makes_records_of_bounded_size(tmp_path: Path, suffix: str) -> None:
    path = tmp_path / f"line{suffix}"
    babble = bytes(range(256)) * 8192  # 2 MiB, and no time-out between
    with traced(path, [(0.0, babble)]) as line:
        line.write(ASKS)
        for _ in range(256):
            line.read(4096, 1.0)
        assert len(line.drain()) == len(babble) // 2
    records = read_back(path)[1:]
    assert b"".join(data for _, data in records) == babble
    assert max(len(data) for _, data in records) < 65535  # what a capture file says is the most


@settings(deadline=None)
@given(st.data())
def test_any_conversation_reads_back(data: st.DataObject) -> None:
    suffix = data.draw(st.sampled_from(sorted(WRITERS)))
    pieces = st.lists(st.binary(min_size=1, max_size=20), max_size=4)
    exchanges = data.draw(st.lists(st.tuples(st.binary(min_size=1, max_size=20), pieces), max_size=5))
    file = Kept()
    line = TracedTransport(
        MemoryTransport(Script(*([(0.0, piece) for piece in answer] for _, answer in exchanges))),
        WRITERS[suffix](file),
    )
    wanted = []
    for asks, answer in exchanges:
        line.write(asks)
        wanted.append(("tx", asks))
        for _ in answer:
            line.read(100, 1.0)
        if answer:
            wanted.append(("rx", b"".join(answer)))
    line.close()
    assert [(record.direction, record.data) for record in read_trace(file.kept, "line")] == wanted


# --- the files ------------------------------------------------------------------------------------


def test_a_line_of_ndjson(tmp_path: Path) -> None:
    path = tmp_path / "line.ndjson"
    with traced(path, [(0.0, ANSWERS)]) as line:
        line.write(ASKS)
        line.read(100, 1.0)
    first, second = path.read_bytes().splitlines(keepends=True)
    assert first == (
        b'{"time": "2026-11-22T03:15:00.123456Z", "protocol": "facon", "direction": "tx",'
        b' "hex": "0230313430433703"}\n'
    )
    for text in (first, second):
        jsonschema.Draft202012Validator(SCHEMA).validate(json.loads(text))


def test_a_packet_of_pcap(tmp_path: Path) -> None:
    path = tmp_path / "LINE.PCAP"
    with traced(path, [(0.0, ANSWERS)]) as line:
        line.write(ASKS)
        line.read(100, 1.0)
    seconds, nanoseconds = divmod(T0_NS, 10**9)
    assert path.read_bytes() == (
        bytes.fromhex("4D3CB2A1 0200 0400 00000000 00000000 FFFF0000 93000000")
        + struct.pack("<IIII", seconds, nanoseconds, 12, 12)
        + b"\x01\x00\x01\x00"
        + ASKS
        + struct.pack("<IIII", seconds + 1, nanoseconds, 19, 19)
        + b"\x01\x01\x01\x00"
        + ANSWERS
    )


def test_pcap_of_a_big_endian_machine() -> None:
    data = struct.pack(">IHHiIII", 0xA1B23C4D, 2, 4, 0, 0, 65535, 147)
    data += struct.pack(">IIII", T0_NS // 10**9, 123456789, 12, 12) + b"\x01\x01\x01\x00" + ASKS
    assert list(read_trace(data, "line.pcap")) == [TraceRecord(T0, "rx", ASKS, "facon")]


@pytest.mark.parametrize(
    ("protocol", "code"),
    [("facon", 1), ("mseries", 2), ("modbus-rtu", 3), ("modbus-ascii", 4), ("modbus-tcp", 5)],
)
def test_pcap_names_the_protocol(protocol: str, code: int) -> None:
    file = io.BytesIO()
    PcapTrace(file, protocol).record(T0_NS, "tx", ASKS)
    assert file.getvalue()[40:44] == bytes([1, 0, code, 0])


@pytest.mark.parametrize(
    ("time_ns", "text"),
    [
        (0, "1970-01-01T00:00:00.000000Z"),
        (999, "1970-01-01T00:00:00.000000Z"),
        (1000, "1970-01-01T00:00:00.000001Z"),
        (T0_NS, T0),
    ],
)
def test_time_text(time_ns: int, text: str) -> None:
    assert time_text(time_ns) == text


def test_the_time_of_a_record_as_a_number() -> None:
    assert TraceRecord("2026-11-22T03:15:00.123456Z", "tx", b"").time_s == pytest.approx(1_795_317_300.123456)


def test_an_empty_trace_has_no_records(tmp_path: Path) -> None:
    for suffix in WRITERS:
        path = tmp_path / f"line{suffix}"
        traced(path).close()
        assert read_back(path) == []
    assert list(read_trace(b"", "x")) == []
    assert list(read_trace(b"\n \n\r\n", "x")) == []


@pytest.mark.parametrize("name", ["line", "line.txt", "line.pcapng", ".pcap/"])
def test_other_names_are_refused(tmp_path: Path, name: str) -> None:
    with pytest.raises(UsageError, match=r"expected a name that ends in \.pcap or \.ndjson"):
        open_trace(tmp_path / name / "x", "facon")


@suffixes
def test_a_file_that_cannot_be_written(tmp_path: Path, suffix: str) -> None:
    with pytest.raises(UsageError, match=r"cannot write the trace .*: No such file or directory"):
        open_trace(tmp_path / "nowhere" / f"line{suffix}", "facon")
    with pytest.raises(UsageError, match=r"cannot write the trace |a file name cannot contain"):
        open_trace(tmp_path / f"a\0b{suffix}", "facon")


class Full(io.BytesIO):
    """A file on a disk that is full from some time on."""

    full = False

    def write(self, data: object) -> int:
        if self.full:
            raise OSError(28, "No space left on device")
        return super().write(data)  # type: ignore[arg-type]

    def close(self) -> None:
        super().close()
        if self.full:
            raise OSError(28, "No space left on device")


@suffixes
def test_a_full_disk_is_said_and_all_is_closed(suffix: str) -> None:
    file = Full()
    inner = MemoryTransport(Script([(0.0, ANSWERS)]))
    line = TracedTransport(inner, WRITERS[suffix](file))
    line.write(ASKS)
    line.read(100, 1.0)
    file.full = True
    with pytest.raises(UsageError, match="cannot write the trace: No space left on device"):
        line.write(ASKS)
    with pytest.raises(UsageError, match="cannot write the trace: No space left on device"):
        line.close()
    assert file.closed
    with pytest.raises(TransportClosed):
        inner.read(1, 0.0)


# --- damage ---------------------------------------------------------------------------------------


def written(suffix: str) -> bytes:
    """A trace of three records."""
    file = io.BytesIO()
    writer = WRITERS[suffix](file)
    for direction, data in (("tx", ASKS), ("rx", ANSWERS), ("tx", ASKS)):
        writer.record(T0_NS, direction, data)
    return file.getvalue()


GOOD_LINE = b'{"time": "2026-11-22T03:15:00Z", "direction": "tx", "hex": "02"}\n'


@pytest.mark.parametrize(
    "line",
    [
        b"{",
        b"[]",
        b"7",
        b"null",
        b'"text"',
        b"{}",
        b"\xff\xfe",
        b"\x00",
        b"[" * 100_000,
        b'{"time": "2026-11-22T03:15:00Z", "direction": "tx"}',
        b'{"time": "2026-11-22T03:15:00Z", "hex": "02"}',
        b'{"direction": "tx", "hex": "02"}',
        b'{"time": "2026-11-22T03:15:00Z", "direction": "tx", "hex": "0"}',
        b'{"time": "2026-11-22T03:15:00Z", "direction": "tx", "hex": "0x02"}',
        b'{"time": "2026-11-22T03:15:00Z", "direction": "tx", "hex": 2}',
        b'{"time": "2026-11-22T03:15:00Z", "direction": "tx", "hex": null}',
        b'{"time": "2026-11-22T03:15:00Z", "direction": "up", "hex": "02"}',
        b'{"time": "2026-11-22T03:15:00Z", "direction": null, "hex": "02"}',
        b'{"time": null, "direction": "tx", "hex": "02"}',
        b'{"time": "", "direction": "tx", "hex": "02"}',
        b'{"time": "2026-13-22T03:15:00Z", "direction": "tx", "hex": "02"}',
        b'{"time": "yesterday", "direction": "tx", "hex": "02"}',
        b'{"time": 1795317300, "direction": "tx", "hex": "02"}',
        b'{"time": "2026-11-22T03:15:00Z", "direction": "tx", "hex": "02"',
        b'{"time": "2026-11-22T03:15:00Z", "direction": "tx", "hex": "02"} x',
    ],
)
def test_a_damaged_line_is_named(line: bytes) -> None:
    records = read_trace(GOOD_LINE + b"\n" + line + b"\n" + GOOD_LINE, "line.ndjson")
    assert next(records).data == b"\x02"
    with pytest.raises(DataError, match=r"^line\.ndjson: line 3: ") as caught:
        next(records)
    assert caught.value.hint


def test_a_last_line_cut_off_is_named() -> None:
    whole = written(".ndjson")
    records = read_trace(whole[:-10], "line.ndjson")
    assert [next(records).data, next(records).data] == [ASKS, ANSWERS]
    with pytest.raises(DataError, match=r"^line\.ndjson: line 3: "):
        next(records)


@each("kept", range(24, len(written(".pcap"))))
def test_a_pcap_cut_off_anywhere(kept: int) -> None:
    ends = [24, 24 + 28, 24 + 28 + 35]
    whole = sum(end <= kept for end in ends) - 1
    records = read_trace(written(".pcap")[:kept], "line.pcap")
    assert [next(records).data for _ in range(whole)] == [ASKS, ANSWERS, ASKS][:whole]
    if kept in ends:
        assert list(records) == []
    else:
        with pytest.raises(DataError, match=rf"^line\.pcap: packet {whole + 1} is cut off"):
            next(records)


@each("kept", range(4, 24))
def test_a_pcap_without_its_header(kept: int) -> None:
    with pytest.raises(DataError, match="expected link type 147"):
        list(read_trace(written(".pcap")[:kept], "line.pcap"))


@each(
    ("at", "byte"),
    [
        (24 + 28 + 8, 3),  # too short for its own header
        (24 + 28 + 8, 0),
        (24 + 28 + 11, 0x7F),  # longer than the file
        (24 + 28 + 16, 2),  # another version
        (24 + 28 + 17, 2),  # neither sent nor received
    ],
)
def test_a_damaged_packet_is_named(at: int, byte: int) -> None:
    data = bytearray(written(".pcap"))
    data[at] = byte
    records = read_trace(bytes(data), "line.pcap")
    assert next(records).data == ASKS
    with pytest.raises(DataError, match=r"^line\.pcap: packet 2 is .*damaged") as caught:
        next(records)
    assert caught.value.exit_code == 5


def test_a_text_of_something_else() -> None:
    for data in (b"root:x:0:0\n", b"{\n", b"[]\n", b'{"time": 1}\n'):
        with pytest.raises(DataError) as caught:
            list(read_trace(data, "x"))
        assert caught.value.message == "x: line 1: not a trace record"
        assert "that --trace wrote" in str(caught.value.hint)


def test_a_capture_of_something_else() -> None:
    data = bytearray(written(".pcap"))
    data[20] = 1  # Ethernet
    with pytest.raises(DataError, match="not a trace of this program: expected link type 147"):
        list(read_trace(bytes(data), "line.pcap"))
    with pytest.raises(DataError, match=r"^x: line 4: not a trace record"):
        list(read_trace(bytes.fromhex("0A0D0D0A 1C000000"), "x"))  # pcapng


@settings(deadline=None)
@given(st.binary(max_size=200), st.sampled_from([b"", *map(written, WRITERS)]), st.integers(0, 200))
def test_any_bytes_are_records_or_data_errors(data: bytes, base: bytes, at: int) -> None:
    try:
        for record in read_trace(base[:at] + data + base[at + len(data) :], "x"):
            assert record.direction in {"tx", "rx"}
            assert record.time.endswith("Z")
    except DataError as error:
        assert error.message.startswith("x: ")  # noqa: PT017  # whatever raises it
