"""``loopback --raw``: texts in the frame of a ladder program, against a program that sends them back."""

from __future__ import annotations

from typing import TYPE_CHECKING

import pytest
from hypothesis import given
from hypothesis import strategies as st

from fatektool.client import Plc
from fatektool.errors import UsageError
from fatektool.jobs.linetest.diagnosis import diagnose
from fatektool.jobs.linetest.finding import Case
from fatektool.jobs.linetest.loopback.data import Pattern, payloads
from fatektool.jobs.linetest.loopback.result import ERRORS, LoopbackPlan, LoopbackResult, usual_sizes
from fatektool.jobs.linetest.loopback.run import run_loopback
from fatektool.jobs.linetest.raw_frame import RawFrame
from fatektool.transport.base import LineSettings
from tests.exchange.peer import Script, linked
from tests.jobs.linetest.framed import FramedReply, framed_on_tcp

if TYPE_CHECKING:
    from pathlib import Path

    from fatektool.transport.memory import Peer
    from tests.cli.running import Cli

STX_ETX = RawFrame(2, 3)


def examined(peer: Peer, frame: RawFrame = STX_ETX, form: str = "7E1", **plan: object) -> LoopbackResult:
    link = linked(peer, line=LineSettings(9600, form))
    sizes = plan.pop("sizes", usual_sizes(frame))
    return run_loopback(Plc(link, "line"), LoopbackPlan(raw=frame, sizes=sizes, **plan))  # type: ignore[arg-type]


def rules(result: LoopbackResult) -> list[str]:
    link = linked(Script())
    return [finding.rule for finding in diagnose(Case(result, LineSettings(), 1, link.codec))]


# --- the frame --------------------------------------------------------------------------------------------


@pytest.mark.parametrize(
    ("text", "start", "end", "wire"),
    [
        ("02,03", 0x02, 0x03, b"\x02OK\x03"),
        ("0x3A, 0D", 0x3A, 0x0D, b":OK\r"),
        ("2,3", 0x02, 0x03, b"\x02OK\x03"),
        ("02H,ffH", 0x02, 0xFF, b"\x02OK\xff"),
        ("none,0D", None, 0x0D, b"OK\r"),
        ("02,none", 0x02, None, b"\x02OK"),
        ("none,NONE", None, None, b"OK"),
        ("00,03", None, 0x03, b"OK\x03"),
    ],
)
def test_a_frame(text: str, start: int | None, end: int | None, wire: bytes) -> None:
    frame = RawFrame.parse(text)
    assert frame == RawFrame(start, end)
    assert frame.wrap(b"OK") == wire
    assert RawFrame.parse(str(frame)) == frame
    assert frame.least + frame.code_count >= 1
    assert len(frame.wrap(b"x" * frame.most)) == 511


@pytest.mark.parametrize("text", ["", "02", "02,", "02,03,04", "x,y", "100,03", "-1,3", "02;03", "STX,ETX"])
def test_what_is_no_frame(text: str) -> None:
    with pytest.raises(UsageError, match="expected START,END as bytes in hex"):
        RawFrame.parse(text)


codes = st.none() | st.integers(1, 127)


@given(codes, codes, st.lists(st.integers(1, 509), min_size=1, max_size=3), st.sampled_from([7, 8]))
def test_no_text_holds_a_code(start: int | None, end: int | None, sizes: list[int], bits: int) -> None:
    frame = RawFrame(start, end)
    characters = frame.characters(bits)
    texts = payloads(sizes, tuple(Pattern), characters, seed=1)
    for _ in range(8 * len(sizes)):
        text = next(texts)
        assert set(text) <= set(characters)
        assert not {start, end} & set(text)
        assert max(text) < 1 << bits


def test_all_characters_of_the_line_are_sent_but_the_codes() -> None:
    program = FramedReply()
    examined(program, count=4, sizes=(509,), patterns=(Pattern.RAMP,))
    assert {byte for sent in program.heard for byte in sent[1:-1]} == set(range(128)) - {2, 3}
    program = FramedReply(baud=None)
    examined(program, form="8N1", count=4, sizes=(509,), patterns=(Pattern.RAMP,))
    assert {byte for sent in program.heard for byte in sent[1:-1]} == set(range(256)) - {2, 3}


def test_patterns_stay_hard_on_the_line_where_their_characters_are_codes() -> None:
    characters = RawFrame(0x55, 0x7F).characters(7)
    texts = payloads((4,), (Pattern.ALTERNATE, Pattern.ONES), characters, seed=0)
    alternate, ones = next(texts), next(texts)
    assert set(alternate) == {0x2A, min(characters, key=lambda byte: (byte ^ 0x55).bit_count())}
    assert {byte.bit_count() for byte in ones} == {6}


# --- what becomes of an exchange ----------------------------------------------------------------------------


@pytest.mark.parametrize("text", ["02,03", "3A,0D", "none,0D", "02,none", "none,none"])
def test_the_papers_reply_program_passes(text: str) -> None:
    frame = RawFrame.parse(text)
    program = FramedReply(frame.start or 0, frame.end or 0)
    result = examined(program, frame, count=48)
    assert (result.total.ok, result.faults) == (48, [])
    assert all(frame.wrap(sent[frame.start is not None : len(sent) - (frame.end is not None)]) == sent
               for sent in program.heard)  # fmt: skip
    wait_ms = 5 if frame.end else 17
    assert result.turnaround.summary_ms()["p50"] == pytest.approx(wait_ms, rel=0.02)
    assert result.bytes_sent == result.bytes_received == sum(map(len, program.heard))
    assert result.echoes is None
    assert rules(result) == []


def test_nothing_but_the_frames_is_sent() -> None:
    program = FramedReply()
    examined(program, count=2, sizes=(2,), patterns=(Pattern.ONES,))
    assert program.heard == [b"\x02\x7f\x7f\x03"] * 2


SENT = b"\x02\x7f\x7f\x7f\x7f\x03"


@pytest.mark.parametrize(
    ("pieces", "kind"),
    [
        ([(0.0, SENT)], None),
        ([(0.0, SENT[:2]), (0.1, SENT[2:])], None),
        ([(0.02 * n, bytes([byte])) for n, byte in enumerate(SENT)], None),
        ([(0.0, b"\x00\xff" + SENT)], None),
        ([(0.0, b"\x02other\x03"), (0.1, SENT)], None),
        ([(0.0, SENT + b"\x00")], None),
        ([], "timeout"),
        ([(0.6, SENT)], "timeout"),
        ([(0.0, SENT[:5])], "garbled"),
        ([(0.0, SENT[1:])], "garbled"),
        ([(0.0, b"\x00\xff\x80")], "garbled"),
        ([(0.0, b"\x02\x7f\x7f\x7e\x7f\x03")], "mismatch"),
        ([(0.0, b"\x02\x7f\x7f\x7f\x03")], "mismatch"),
        ([(0.0, b"\x02\x03")], "mismatch"),
    ],
)
def test_an_exchange_counts_as_what_became_of_it(pieces: list[tuple[float, bytes]], kind: str | None) -> None:
    result = examined(Script(pieces), count=1, sizes=(4,), patterns=(Pattern.ONES,))
    expected = dict.fromkeys(ERRORS, 0) | ({} if kind is None else {kind: 1})
    assert result.total.errors == expected
    assert result.total.ok == (kind is None)
    assert result.bytes_received == sum(len(piece) for due, piece in pieces if due < 0.6)


@pytest.mark.parametrize(
    ("frame", "piece", "kind"),
    [
        (RawFrame(2, None), b"\x02\x7f\x7f\x7f\x7e", "mismatch"),
        (RawFrame(2, None), b"\x02\x7f\x7f", "garbled"),
        (RawFrame(2, None), b"\x7f\x7f\x7f\x7f\x7f", "garbled"),
        (RawFrame(None, None), b"\x7f\x7f\x7f\x7e", "mismatch"),
        (RawFrame(None, None), b"\x7f", "garbled"),
        (RawFrame(None, 3), b"\x03", "mismatch"),
        (RawFrame(None, 3), b"\x7f\x7f\x7f\x7f", "garbled"),
    ],
)
def test_frames_without_a_code(frame: RawFrame, piece: bytes, kind: str) -> None:
    result = examined(Script([(0.0, piece)]), frame, count=1, sizes=(4,), patterns=(Pattern.ONES,))
    assert result.total.errors[kind] == 1


def test_a_late_answer_is_never_taken_for_the_next_one() -> None:
    late = [(0.6, SENT)]
    result = examined(Script(late, late, []), count=3, sizes=(4,), patterns=(Pattern.ONES,))
    assert (result.total.ok, result.total.errors["timeout"]) == (0, 3)
    assert result.heard.late == 2


def test_an_answer_to_another_text_is_stale() -> None:
    script = Script([(0.6, b"\x02\x7f\x03")], [(0.01, b"\x02\x7f\x03")])
    result = examined(script, count=2, sizes=(1, 2), patterns=(Pattern.ONES,))
    assert (result.total.errors["timeout"], result.total.errors["stale"]) == (1, 1)


def test_a_line_that_is_cut_gives_the_figures_so_far() -> None:
    link = linked(FramedReply())

    def cut(result: LoopbackResult) -> None:
        if result.total.sent == 3:
            link.transport.close()

    result = run_loopback(Plc(link, "line"), LoopbackPlan(raw=STX_ETX), cut)
    assert (result.total.sent, result.total.ok, result.ended) == (4, 3, "line lost")


def test_the_time_is_kept() -> None:
    result = examined(FramedReply(), count=None, duration_s=5.0, interval_s=0.7, sizes=(0,))
    assert (result.total.sent, result.total.ok, result.ended) == (8, 8, "duration")


def test_a_line_that_babbles_costs_no_memory() -> None:
    babble = [(0.001 * n, bytes(1000)) for n in range(200)]
    result = examined(Script(babble), count=1, sizes=(4,))
    assert result.bytes_received == 200_000
    assert len(result.heard.noise) <= 64


# --- the diagnosis ------------------------------------------------------------------------------------------


@pytest.mark.parametrize(
    ("program", "expected"),
    [
        (FramedReply(), []),
        (FramedReply(dead=True), ["raw-silence"]),
        (FramedReply(start=5, end=4), ["raw-nothing-right"]),
        (FramedReply(alter={1: 1}), ["raw-nothing-right"]),
        (FramedReply(alter={7: 1}), ["raw-altered"]),
        (FramedReply(dead=True, echo=True), ["raw-echo"]),
        (FramedReply(echo=True), ["raw-twice", "raw-echo"]),
        (FramedReply(twice=True), ["raw-twice"]),
        (FramedReply(scan_s=0.2), ["slow-plc"]),
        (FramedReply(baud=None, scan_s=0.0001), ["raw-echo"]),
    ],
)
def test_what_the_figures_say(program: FramedReply, expected: list[str]) -> None:
    result = examined(program, count=48, sizes=(16, 64, 128))
    assert rules(result) == expected


def test_lost_texts_are_said_to_be_lost() -> None:
    class Forgetful(FramedReply):
        def receive(self, data: bytes, now: float) -> list[tuple[float, bytes]]:
            pieces = super().receive(data, now)
            return pieces if len(self.heard) % 5 else []

    result = examined(Forgetful(), count=40, sizes=(16, 64))
    assert result.total.errors["timeout"] == 8
    assert rules(result) == ["lost-frames"]


# --- the command --------------------------------------------------------------------------------------------


@pytest.mark.parametrize("text", ["02,03", "none,0D"])
def test_the_command(cli: Cli, place: Path, text: str) -> None:
    frame = RawFrame.parse(text)
    with framed_on_tcp(FramedReply(frame.start or 0, frame.end or 0, baud=None)) as target:
        done = cli(
            "loopback",
            "--raw",
            text,
            "-p",
            target,
            "--count",
            24,
            "--timeout",
            "60",
            "--json",
            "--report",
            "x.html",
        )
    assert done.code == 0, done
    found = done.document("loopback")
    assert (found["sent"], found["ok"], found["verdict"]) == (24, 24, "pass")
    assert (found["station"], found["protocol"]) == (None, "raw")
    start, end = (None if code == "none" else code for code in text.split(","))
    assert found["raw"] == {"start": start, "end": end}
    html = (place / "x.html").read_text(encoding="utf-8")
    assert "station" not in html.partition("<table")[0]


def test_the_command_in_words(cli: Cli) -> None:
    with framed_on_tcp(FramedReply(alter={1: 4}, baud=None)) as target:
        done = cli("loopback", "--raw", "02,03", "-p", target, "--count", 2, "--sizes", "400",
                   "--timeout", "5")  # fmt: skip
    assert done.code == 1
    assert "frame       start 02, end 03" in done.out
    assert "2 mismatch" in done.out
    assert "FAULT: bytes are received, but never the text that was sent" in done.out
