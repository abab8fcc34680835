"""What ``--trace`` writes, seen by tshark: the same as the command read, and the same as ``decode`` says."""

from __future__ import annotations

from random import Random
from typing import TYPE_CHECKING, Any

from fatektool.cli import run
from fatektool.program.archive import load_backup
from fatektool.protocol.explain import FrameRole
from fatektool.protocol.registry import new_explainer
from tests.cli.running import served
from tests.wireshark.capture import FACON, INFO, MSERIES, RECEIVED, SCRIPT, SENT, capture, traced

if TYPE_CHECKING:
    from pathlib import Path

    import pytest

    from tests.wireshark.capture import Packet, Tshark


def values(packets: list[Packet], name: str) -> list[str]:
    """All values of a field, in order."""
    return [value for packet in packets for value in packet[f"fatek.{name}"].split("|") if value]


def test_a_backup(tshark: Tshark, tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setenv("FATEKTOOL_LOCK_DIR", str(tmp_path))
    trace, file = tmp_path / "line.pcap", tmp_path / "plc.json"
    assert run(["backup", str(file), "-p", "sim:", "--trace", str(trace), "--quiet"]) == 0
    pages = load_backup(file).program.pages
    packets = tshark(trace)
    assert {packet["fatek.direction"] for packet in packets} == {"0", "1"}
    asked = [int(page) for page in values(packets, "page")]
    assert asked == [*range(len(pages))] * 2
    assert [bytes.fromhex(page) for page in values(packets, "page_data")] == [*pages, *pages]
    assert set(values(packets, "checksum.status")) == {"1"}
    assert not values(packets, "noise")
    answers = [packet for packet in packets if packet["fatek.direction"] == "1"]
    assert all(packet["fatek.answer_to"] for packet in answers)
    assert values(packets, "ladder_words")[0] == "13184"


def test_a_script_that_is_given_twice(tshark: Tshark) -> None:
    """As one in the plugin folder that is named on the command line too: loaded once, without a word."""
    file = capture([traced(FACON, SENT, b"\x020140C7\x03")])
    once = tshark(file)
    assert tshark(file, "-X", f"lua_script:{SCRIPT}") == once
    assert once[0]["fatek.command"] == "0x40"


def test_a_line_with_faults(tshark: Tshark, tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setenv("FATEKTOOL_LOCK_DIR", str(tmp_path))
    trace = tmp_path / "line.pcap"
    words = ["--trace", str(trace), "--timeout", "0.3", "--retries", "20", "--quiet"]
    with served(faults=["flip=0.1", "noise=0.1", "truncate=0.05"], seed=5) as door:
        assert run(["backup", str(tmp_path / "plc.json"), "-p", door.target, *words]) == 0
    packets = tshark(trace)
    assert {"0", "1"} == set(values(packets, "checksum.status"))
    assert values(packets, "noise")
    assert any("[bad checksum]" in packet[INFO] for packet in packets)


def seen_by_decode(data: bytes, role: FrameRole) -> dict[str, Any]:
    """A record as ``decode`` explains it: noise, and of each frame station, command and checksum."""
    frames = list(new_explainer("facon").explain(data, role))
    return {
        "noise": [frame.raw.hex() for frame in frames if frame.command is None],
        "station": [str(frame.station) for frame in frames if frame.command is not None],
        "command": [f"0x{frame.command:02x}" for frame in frames if frame.command is not None],
        "checksum.status": [
            str(int(bool(frame.checksum_ok))) for frame in frames if frame.command is not None
        ],
    }


def records_of(frames: list[bytes], specials: list[bytes], random: Random) -> list[tuple[int, bytes]]:
    """Records of frames and noise, many of them spoilt."""
    records = []
    for _ in range(400):
        data = b"".join(
            random.choice([*frames, random.randbytes(3), *specials]) for _ in range(random.randrange(4))
        )
        for _ in range(random.randrange(3)):
            place = random.randrange(len(data) + 1)
            spoilt = random.choice([b"", b"0", b"\xff", *specials])
            data = data[:place] + spoilt + data[place + random.randrange(3) :]
        records.append((random.choice([SENT, RECEIVED]), data))
    return records


def test_it_cuts_any_bytes_as_decode_does(tshark: Tshark) -> None:
    """The two were written apart: a disagreement is a misreading of one of them."""
    frames = [
        b"\x02014603R0001275\x03",
        b"\x020146010A57FC4000189\x03",
        b"\x02FE4604321F1\x03",
        b"\x020140C7\x03",
        b"\x020199xyz40\x03",
        b"\x02014E" + b"A" * 256 + b"37\x03",
    ]
    records = records_of(frames, [b"\x02", b"\x03"], Random(147))  # noqa: S311  # the same bytes every time
    packets = tshark(capture(traced(FACON, direction, data) for direction, data in records))
    assert len(packets) == len(records)
    for (direction, data), packet in zip(records, packets, strict=True):
        wanted = seen_by_decode(data, FrameRole.REQUEST if direction == SENT else FrameRole.ANSWER)
        assert {name: values([packet], name) for name in wanted} == wanted, data


def test_it_finds_the_good_mseries_frames_that_decode_finds(tshark: Tshark) -> None:
    """Where a broken one ends, without its length, is anybody's guess; the good ones behind it are not."""
    frames = [
        bytes.fromhex(text)
        for text in (
            "511000060146025200000E7C55AA",
            "52100007014600FF55FF4B74B355AA",
            "52100003014700467455AA",
            "5110000601 4E 55AA 55AA C117 55AA",
        )
    ]
    specials = [b"\x51\x10", b"\x52\x10", b"\x55\xaa"]
    records = records_of(frames, specials, Random(148))  # noqa: S311  # the same bytes every time
    packets = tshark(capture(traced(MSERIES, direction, data) for direction, data in records))
    for (_, data), packet in zip(records, packets, strict=True):
        found = zip(values([packet], "command"), values([packet], "checksum.status"), strict=True)
        good = [command for command, checksum in found if checksum == "1"]
        explained = new_explainer("mseries").explain(data, FrameRole.EITHER)
        assert good == [f"0x{frame.command:02x}" for frame in explained if frame.checksum_ok], data
