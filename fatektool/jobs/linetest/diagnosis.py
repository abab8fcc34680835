"""The diagnosis of a loopback test: each rule gives a finding with its evidence and what to do, or nothing.

The rules for a line that does not work at all (nothing received, only noise, only the echo) come first. The
first of these that applies is the only finding: the other figures of such a line mean nothing.
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
    """Run the rules; the list is empty if there is nothing to report."""
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
        finding="no bytes received",
        evidence=f"{result.total.sent} requests, 0 bytes received",
        advice=f"check that the PLC is on, its address and its station; {AT_AN_ETHERNET_MODULE}"
        if case.network
        else "check that the PLC is on, the cable, wires A and B, and the port; if these are right, the "
        "station, baud rate or format is wrong: run 'fatektool scan'",
    )


def _only_echo(case: Case) -> Finding | None:
    result = case.result
    if not case.silent or not result.echoes or result.heard.noise_bytes or answers_heard(result):
        return None
    return Finding(
        "echo-only",
        fault=True,
        finding="only the echo of the requests is received: no PLC answers",
        evidence=f"{result.total.sent} requests, {result.bytes_received} bytes received, all of them echo",
        advice="the gateway returns each request; check that the PLC is on, and its station"
        if case.network
        else "the converter works; check that the PLC is on, the station, and wires A and B",
    )


def _wrong_format(case: Case) -> Finding | None:
    result = case.result
    if not case.silent or not framed_with_parity(case):
        return None
    return Finding(
        "wrong-format",
        fault=True,
        finding=f"the PLC sends 7 bits and parity; this line is set to {case.line.format}",
        evidence=f"the bytes are frames if bit 8 is ignored: {sample(result)}",
        advice="try --line 7E1 (the factory setting), or 7O1",
    )


def _wrong_line(case: Case) -> Finding | None:
    result = case.result
    if not case.silent or not result.heard.noise_bytes or answers_heard(result):
        return None
    return Finding(
        "wrong-line",
        fault=True,
        finding="bytes are received, but no valid frame: wrong baud rate, format or protocol",
        evidence=f"{result.total.sent} requests, {result.bytes_received} bytes received, no valid frame: "
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
        finding=f"other stations answer requests to station {case.station}",
        evidence=f"{sum(foreign.values())} answers from station {stations}",
        advice="look for a second master on this line, or a gateway that confuses answers",
    )


def _twins(case: Case) -> Finding | None:
    heard, total = case.result.heard, case.result.total
    if heard.twice < 3 or heard.twice < total.sent / 50:
        return None
    return Finding(
        "two-on-one-station",
        fault=True,
        finding=f"answers are received twice: two PLCs have station {case.station}, or a gateway repeats",
        evidence=f"{heard.twice} answers were received twice, "
        f"{total.errors['checksum'] + total.errors['garbled']} were damaged",
        advice="switch off one PLC after the other and run this again; then give one of them another station",
    )


def _echo(case: Case) -> Finding | None:
    if not case.result.echoes:
        return None
    return Finding(
        "echo",
        fault=False,
        finding="the line echoes each request: a two-wire converter that receives while it sends",
        evidence=f"{case.result.bytes_received} bytes received for {case.result.bytes_sent} sent",
        advice="fatektool ignores the echo, other programs may not: disable it in the converter if possible",
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
        finding="longer frames have more errors: single bits are damaged, as by noise or a wrong termination",
        evidence=f"error rate by size {shares}",
        advice="check the termination at both ends, the shield and its earth, and cables next to drives; "
        "use a lower baud rate",
    )


def _damage(case: Case) -> Finding | None:
    total = case.result.total
    count = damaged(total)
    if not count or grows(case.result.by_size) or _twins(case):
        return None
    return Finding(
        "damaged-frames",
        fault=True,
        finding="answers are damaged, short ones as well as long ones",
        evidence=f"{count} of {total.sent}, {case.result.heard.noise_bytes} bytes that are no valid frame",
        advice="look for a loose contact, a second master on the line, or a converter that changes its "
        "direction too early",
    )


def _slow(case: Case) -> Finding | None:
    result = case.result
    p50_ms = result.turnaround.summary_ms()["p50"]
    late = result.heard.late
    if result.heard.steps.seen or (not late and (p50_ms is None or p50_ms < _SLOW_S * 1000)):
        return None
    heard = (
        f"half of the answers take {p50_ms:.4g} ms or more, wire time not included"
        if p50_ms is not None
        else ""
    )
    if late:
        latest = f", the slowest took {result.heard.late_s:.2g} s" if result.heard.late_s else ""
        heard += f"{'; ' if heard else ''}{late} were received after --timeout {result.timeout_s:g}{latest}"
    return Finding(
        SLOW_PLC,
        fault=late > 0,
        finding="the PLC answers late"
        if late
        else "the PLC answers slowly: a long scan time, or a slow gateway",
        evidence=heard,
        advice=_longer(result.heard.late_s) if late else "no action needed: a PLC answers once per scan",
    )


def _longer(late_s: float) -> str:
    return (
        f"give --timeout {longer_timeout(late_s):g} with every command"
        if late_s
        else "give a longer --timeout"
    )


def _slow_if_paced(case: Case) -> Finding | None:
    """Not for answers that arrive faster than the line allows: they may be an echo."""
    return _slow(case) if case.result.paced else None


def _usb_steps(case: Case) -> Finding | None:
    if not case.result.heard.steps.seen:
        return None
    return Finding(
        "usb-latency",
        fault=False,
        finding="answers arrive in steps of 16 ms: the USB adapter delays received bytes",
        evidence=f"{case.result.heard.steps.latency.alignment:.0%} of the times are on these steps",
        advice="set the latency timer of the adapter to 1 ms: on Linux in "
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
        finding="some requests get no answer",
        evidence=f"{lost} of {total.sent}, and nothing was received in their place",
        advice="look for a loose contact, a second master on the line, or a busy PLC; "
        "'fatektool loopback' shows which sizes are affected",
    )


def _no_such_line(case: Case) -> Finding | None:
    if case.result.paced or case.silent:
        return None
    return Finding(
        "faster-than-line",
        fault=False,
        finding=f"answers arrive faster than {case.line} allows: there is no serial line of this baud rate",
        evidence=f"{case.result.heard.faster_than_wire} of {case.result.total.ok} answers",
        advice="no action needed; the figures are without wire times",
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
