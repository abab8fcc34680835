"""The diagnosis of a PLC and its line: each fault with its evidence and what to do.

A short loopback test comes first, with the rules of ``diagnosis``. If the line works, the PLC's own faults
follow: those of its brief status (40), and of an FBs those of its high-speed link (``high_speed``). If there
is no answer, other stations, baud rates and formats are tried (``search``): a PLC that answers there explains
why there is none here.
"""

from __future__ import annotations

from dataclasses import dataclass, field, replace
from typing import TYPE_CHECKING, Final

from fatektool.errors import LineError, PlcError, TransportClosed
from fatektool.jobs.linetest.diagnosis import SLOW_PLC, diagnose
from fatektool.jobs.linetest.enough_time import EnoughTime, find_enough_time
from fatektool.jobs.linetest.finding import Case, Finding
from fatektool.jobs.linetest.high_speed import high_speed_findings
from fatektool.jobs.linetest.loopback.result import LoopbackPlan
from fatektool.jobs.linetest.loopback.run import run_loopback
from fatektool.jobs.linetest.search import answers_elsewhere, search

if TYPE_CHECKING:
    from collections.abc import Callable

    from fatektool.client import Plc
    from fatektool.jobs.linetest.loopback.result import LoopbackResult
    from fatektool.jobs.linetest.scan_result import ScanResult, Station
    from fatektool.protocol.status import BriefStatus

FIRST_LOOK: Final = LoopbackPlan(count=6, max_error_rate=1.0)
_USE_IT: Final = "use the station and the settings at which it answers"
SHORT_TEST: Final = LoopbackPlan(count=120, duration_s=10.0)


@dataclass(slots=True)
class Examination:
    """What was found.

    Attributes:
        loopback: the test's figures.
        brief: the PLC's brief status; None if it gave none.
        findings: what the rules say.
        searched: the search at other baud rates, formats and stations; None if it was not needed.
        enough: the time-out that a PLC with late answers needs; None if none were late.
    """

    loopback: LoopbackResult
    brief: BriefStatus | None = None
    findings: list[Finding] = field(default_factory=list)
    searched: ScanResult | None = None
    enough: EnoughTime | None = None

    @property
    def elsewhere(self) -> list[Station]:
        """The stations that the search found."""
        return [] if self.searched is None else self.searched.found

    @property
    def healthy(self) -> bool:
        """True if no finding is a fault."""
        return not any(finding.fault for finding in self.findings)


def examine(plc: Plc, on_step: Callable[[str, int, int], object] = lambda *_: None) -> Examination:
    """Diagnose a PLC and its line.

    Args:
        plc: the PLC.
        on_step: gets the step, how much of it is done, and of how much.

    Raises:
        LineError: the line was lost.
    """
    link = plc.link
    result = run_loopback(plc, FIRST_LOOK, _told(on_step, FIRST_LOOK))
    enough, late = None, []
    if result.heard.late_s and result.ended == "count":
        given_s = link.timeout_s
        on_step("longer time-out", 0, 1)
        enough = find_enough_time(plc, result.heard.late_s)
        late.append(_answers_late(enough, result, given_s))
    if (result.total.ok or (enough and enough.ok)) and result.ended == "count":
        result = run_loopback(plc, SHORT_TEST, _told(on_step, SHORT_TEST))
    if result.ended == "interrupted":
        raise KeyboardInterrupt
    if result.lost is not None:
        raise TransportClosed(result.lost)
    said = diagnose(Case.of(result, link))
    if enough is not None:  # it says more
        said = late + [each for each in said if each.rule != SLOW_PLC]
    found = Examination(result, findings=said, enough=enough)
    if result.total.ok:
        try:
            found.brief = plc.brief_status()
        except (LineError, PlcError) as error:
            found.findings.append(
                Finding(
                    "no-status",
                    fault=True,
                    finding="the PLC does not give its status",
                    evidence=error.message,
                    advice=error.hint or "run again",
                )
            )
        else:
            found.findings += _of_flags(found.brief)
            found.findings += high_speed_findings(plc)
    else:
        found.searched = search(plc, on_step)
        if found.elsewhere:
            found.findings = [replace(each, advice=_USE_IT) for each in found.findings]
        found.findings += [answers_elsewhere(plc, station) for station in found.elsewhere]
    return found


def _told(
    on_step: Callable[[str, int, int], object], plan: LoopbackPlan
) -> Callable[[LoopbackResult], object]:
    return lambda result: on_step("loopback", result.total.sent, plan.count or 0)


def _answers_late(enough: EnoughTime, seen: LoopbackResult, given_s: float) -> Finding:
    advice = f"give --timeout {enough.timeout_s:g} with every command"
    if not enough.proven:
        advice = (
            f"even with --timeout {enough.timeout_s:g} only {enough.ok} of {enough.sent} were answered: "
            "find out what delays the PLC or the gateway"
        )
    return Finding(
        SLOW_PLC,
        fault=True,
        finding="the PLC answers late",
        evidence=f"{seen.heard.late} answers were after --timeout {given_s:g}; with {enough.timeout_s:g} s "
        f"{enough.ok} of {enough.sent} were answered, the slowest after {enough.slowest_s:.2f} s",
        advice=advice,
    )


# No paper says more of these bits than their names: [E:battery], [E:watchdog].
_FLAGS: Final = (
    (
        "battery_low",
        "the battery is low",
        "take a backup and a snapshot now, then replace the battery as the manual of this PLC says",
    ),
    (
        "ladder_checksum_error",
        "the ladder program is damaged",
        "take a backup, then restore a good one: 'fatektool restore'",
    ),
    (
        "watchdog_timeout",
        "a watchdog time-out occurred",
        "a scan of the program may take too long: look for loops; 'fatektool status' shows the mode",
    ),
    ("emergency_stop", "the emergency stop is active", "make the machine safe, then release it"),
)


def _of_flags(brief: BriefStatus) -> list[Finding]:
    """The faults that the PLC itself reports."""
    return [
        Finding(
            name.replace("_", "-"),
            fault=True,
            finding=words,
            evidence=f"flag {name} of its status (40)",
            advice=advice,
        )
        for name, words, advice in _FLAGS
        if getattr(brief.flags, name)
    ]
