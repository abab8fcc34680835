"""What a loopback test says about the line, in words: each rule names its evidence and what to do.

A rule looks at the figures of a test and gives a finding or nothing. The first that speaks of the line as a
whole (nothing heard, nothing but noise, nothing but the own echo) stands alone: figures of a line that does
not work say nothing else.
"""

from __future__ import annotations

from typing import TYPE_CHECKING, Final, TypeAlias

from fatektool.exchange.no_answer import AT_AN_ETHERNET_MODULE, longer_timeout
from fatektool.jobs.linetest.evidence import answers_heard, damaged, framed_with_parity, grows, sample
from fatektool.jobs.linetest.finding import Case, Finding
from fatektool.jobs.linetest.raw_rules import raw_altered, raw_echo, raw_nothing_right, raw_silence, raw_twice

if TYPE_CHECKING:
    from collections.abc import Callable

_SLOW_S: Final = 0.1
SLOW_PLC: Final = "slow-plc"


def diagnose(case: Case) -> list[Finding]:
    """Run the rules; an empty list is a line with nothing to say about."""
    whole, rules = (_WHOLE_LINE, _RULES) if case.result.plan.raw is None else (_RAW_WHOLE_LINE, _RAW_RULES)
    for rule in whole:
        finding = rule(case)
        if finding is not None:
            return [finding]
    return [finding for rule in rules if (finding := rule(case)) is not None]


# --- a line that does not work at all -------------------------------------------------------------------


def _silence(case: Case) -> Finding | None:
    result = case.result
    if not case.silent or result.bytes_received:
        return None
    return Finding(
        "silence",
        fault=True,
        finding="nothing comes back, not a byte",
        evidence=f"{result.total.sent} requests, 0 bytes heard",
        advice=f"is the PLC on, the address right, the station right? {AT_AN_ETHERNET_MODULE}"
        if case.network
        else "is the PLC on, the cable in, A and B the right way round, the port the right one? If so, "
        "another station, speed or format: 'fatektool scan' finds it",
    )


def _only_echo(case: Case) -> Finding | None:
    result = case.result
    if not case.silent or not result.echoes or result.heard.noise_bytes or answers_heard(result):
        return None
    return Finding(
        "echo-only",
        fault=True,
        finding="only its own requests come back: the line echoes, and no PLC answers",
        evidence=f"{result.total.sent} requests, {result.bytes_received} bytes heard, all of them requests",
        advice="the converter works; is the PLC on, the station right, are A and B the right way round?",
    )


def _wrong_format(case: Case) -> Finding | None:
    result = case.result
    if not case.silent or not framed_with_parity(case):
        return None
    return Finding(
        "wrong-format",
        fault=True,
        finding=f"the PLC sends 7 bits and parity; this line is set to {case.line.format}",
        evidence=f"frames appear when the eighth bit is left out: {sample(result)}",
        advice="try --format 7E1 (the factory setting), or 7O1",
    )


def _wrong_line(case: Case) -> Finding | None:
    result = case.result
    if not case.silent or not result.heard.noise_bytes or answers_heard(result):
        return None
    return Finding(
        "wrong-line",
        fault=True,
        finding="something answers, but not one frame can be read: speed, format or protocol is another",
        evidence=f"{result.total.sent} requests, {result.bytes_received} bytes heard, no frame: "
        f"{sample(result)}",
        advice=f"this line is set to {case.line} {case.codec.name}; "
        "'fatektool scan --bauds … --formats …' tries others",
    )


# --- a line that works more or less -------------------------------------------------------------------


def _refused(case: Case) -> Finding | None:
    refused = case.result.total.errors["refused"]
    if not refused:
        return None
    return Finding(
        "refused",
        fault=True,
        finding="the PLC answers loopbacks with an error code",
        evidence=f"{refused} of {case.result.total.sent} requests",
        advice="the line is good; smaller --sizes may pass, if the PLC's buffer is small",
    )


def _foreign(case: Case) -> Finding | None:
    foreign = case.result.heard.foreign
    if not foreign:
        return None
    stations = ", ".join(map(str, sorted(foreign)[:5])) + (", …" if len(foreign) > 5 else "")
    return Finding(
        "foreign-station",
        fault=True,
        finding=f"other stations answer what station {case.station} is asked",
        evidence=f"{sum(foreign.values())} answers of station {stations}",
        advice="another master may ask on this line at the same time, or a gateway mixes answers up",
    )


def _twins(case: Case) -> Finding | None:
    heard, total = case.result.heard, case.result.total
    if heard.twice < 3 or heard.twice < total.sent / 50:
        return None
    return Finding(
        "two-on-one-station",
        fault=True,
        finding=f"answers come twice: two PLCs have station {case.station}, or a gateway repeats",
        evidence=f"{heard.twice} answers came a second time, "
        f"{total.errors['checksum'] + total.errors['garbled']} were damaged",
        advice="switch off one PLC after the other and run this again; then give one of them another station",
    )


def _echo(case: Case) -> Finding | None:
    if not case.result.echoes:
        return None
    return Finding(
        "echo",
        fault=False,
        finding="the line gives back each request: a two-wire converter that does not mute itself",
        evidence=f"{case.result.bytes_received} bytes heard for {case.result.bytes_sent} sent",
        advice="fatektool copes; other programs may not: switch the converter's echo off if it can be",
    )


def _errors_by_size(case: Case) -> Finding | None:
    if not damaged(case.result.total) or not grows(case.result.by_size):
        return None
    shares = ", ".join(
        f"{size}: {tally.error_rate:.1%}" for size, tally in sorted(case.result.by_size.items())
    )
    return Finding(
        "errors-grow-with-size",
        fault=True,
        finding="the longer a frame, the more errors: single bits are hit, as by noise or a bad termination",
        evidence=f"errors by size {shares}",
        advice="check termination at both ends, shield and its earth, cables beside drives; "
        "a lower baud helps",
    )


def _damage(case: Case) -> Finding | None:
    total = case.result.total
    count = damaged(total)
    if not count or grows(case.result.by_size) or _twins(case):
        return None
    return Finding(
        "damaged-frames",
        fault=True,
        finding="answers come damaged, and not clearly the longer ones more often",
        evidence=f"{count} of {total.sent}, {case.result.heard.noise_bytes} bytes that were no frame",
        advice="a loose contact, two masters on the line, or a converter that switches its direction "
        "too early",
    )


def _slow(case: Case) -> Finding | None:
    result = case.result
    p50_ms = result.turnaround.summary_ms()["p50"]
    late = result.heard.late
    if result.heard.steps.seen or (not late and (p50_ms is None or p50_ms < _SLOW_S * 1000)):
        return None
    heard = f"half of the answers take {p50_ms:.4g} ms or more beside wire time" if p50_ms is not None else ""
    if late:
        latest = f", the latest took {result.heard.late_s:.2g} s" if result.heard.late_s else ""
        heard += f"{'; ' if heard else ''}{late} came after --timeout {result.timeout_s:g}{latest}"
    return Finding(
        SLOW_PLC,
        fault=late > 0,
        finding="the PLC answers late" if late else "the PLC takes its time: a long scan, or a slow gateway",
        evidence=heard,
        advice=_longer(result.heard.late_s) if late else "nothing need be done; the PLC answers once a scan",
    )


def _longer(late_s: float) -> str:
    return (
        f"give --timeout {longer_timeout(late_s):g} with every command"
        if late_s
        else "give a longer --timeout"
    )


def _slow_if_paced(case: Case) -> Finding | None:
    """What comes sooner than a line carries it may be an echo, whose times are the wire's."""
    return _slow(case) if case.result.paced else None


def _usb_steps(case: Case) -> Finding | None:
    if not case.result.heard.steps.seen:
        return None
    return Finding(
        "usb-latency",
        fault=False,
        finding="answers come in steps of 16 ms: the USB adapter holds received bytes back",
        evidence=f"{case.result.heard.steps.latency.alignment:.0%} of the times fall on the steps",
        advice="set its latency timer to 1 ms: on Linux in "
        "/sys/bus/usb-serial/devices/ttyUSB0/latency_timer, on Windows in the port's advanced settings",
    )


def _lost(case: Case) -> Finding | None:
    total, heard = case.result.total, case.result.heard
    lost = total.errors["timeout"] - heard.late
    if case.silent or lost <= 0:
        return None
    return Finding(
        "lost-frames",
        fault=True,
        finding="some requests find no answer",
        evidence=f"{lost} of {total.sent}, with nothing heard in their place",
        advice="a loose contact, another master on the line, or a PLC that is busy: "
        "watch which sizes are hit",
    )


def _no_such_line(case: Case) -> Finding | None:
    if case.result.paced or case.silent:
        return None
    return Finding(
        "faster-than-line",
        fault=False,
        finding=f"answers come sooner than {case.line} allows: no serial line of that speed is in between",
        evidence=f"{case.result.heard.faster_than_wire} of {case.result.total.ok} answers",
        advice="nothing need be done; wire times are left out of the figures",
    )


_Rules: TypeAlias = "tuple[Callable[[Case], Finding | None], ...]"

_WHOLE_LINE: Final[_Rules] = (
    _silence,
    _only_echo,
    _wrong_format,
    _wrong_line,
)
_RULES: Final[_Rules] = (
    _refused,
    _foreign,
    _twins,
    _errors_by_size,
    _damage,
    _lost,
    _slow,
    _usb_steps,
    _echo,
    _no_such_line,
)
_RAW_WHOLE_LINE: Final[_Rules] = (raw_silence, raw_nothing_right)
_RAW_RULES: Final[_Rules] = (raw_twice, raw_altered, _lost, _slow_if_paced, _usb_steps, raw_echo)
