"""``--prometheus``, ``--on-change``, ``--on-failure``: metrics and commands for the outcome of each PLC."""

from __future__ import annotations

import contextlib
import time
from dataclasses import dataclass, field
from functools import wraps
from typing import TYPE_CHECKING, Any, Final, TypeVar

import click

from fatektool.cli.shared.options import PATH
from fatektool.errors import FatektoolError, UsageError
from fatektool.files.atomic import read_bounded, require_place, write_whole
from fatektool.files.times import utc
from fatektool.jobs.fleet.alarms import TIME_LIMIT_S, Event, parse_command, run_command
from fatektool.jobs.prometheus import Sample, doubled, exposition, sample, successes
from fatektool.system.shell import program_of

if TYPE_CHECKING:
    from collections.abc import Callable, Iterator
    from pathlib import Path

    from fatektool.cli.many.outcome import Outcome
    from fatektool.cli.shared.output import Voice

F = TypeVar("F", bound="Callable[..., Any]")

_MAX_FILE: Final = 64 << 20
_MODE: Final = 0o644  # the collector is another user
_MOST_HANGS: Final = 3
_FLAGS: Final = ("running", "battery_low", "ladder_checksum_error", "watchdog_timeout", "emergency_stop")


@dataclass(slots=True)
class Alarms:
    """The metrics file and the commands.

    Attributes:
        prometheus: the file for the textfile collector.
        on_change: the command for a changed program.
        on_failure: the command for a failure.
        lost: why the file could not be written; None if it was.
    """

    prometheus: Path | None
    on_change: str | tuple[str, ...] | None
    on_failure: str | tuple[str, ...] | None
    lost: FatektoolError | None = field(init=False, default=None)
    _outcomes: list[tuple[str, Outcome]] = field(init=False, default_factory=list)
    _hangs: int = field(init=False, default=0)

    def notify(self, job: str, outcome: Outcome, voice: Voice) -> None:
        """One PLC has ended: run the commands for its outcome."""
        if self.prometheus is not None:
            self._outcomes.append((job, outcome))
        if self.on_change is not None and outcome.result.changed:
            self._run(self.on_change, "change", job, outcome, voice)
        if self.on_failure is not None and outcome.result.exit_code:
            self._run(self.on_failure, "failure", job, outcome, voice)

    def write(self, known: set[str], voice: Voice) -> None:
        """Write the Prometheus file, whole or not at all; ``lost`` is why, if it cannot be.

        That is no error here: the outcomes are still to be printed.

        Args:
            known: the PLCs whose last success is taken over from the former file.
            voice: warns of other files that the collector would not accept together with this one.
        """
        if self.prometheus is not None:
            try:
                self._write(self.prometheus, known, voice)
            except FatektoolError as error:
                self.lost = error

    def _write(self, prometheus: Path, known: set[str], voice: Voice) -> None:
        former: dict[tuple[str, str], float] = {}
        if prometheus.is_file():
            text = read_bounded(prometheus, _MAX_FILE).decode(errors="replace")
            former = {key: when for key, when in successes(text).items() if key[0] in known}
        text = exposition(_samples(self._outcomes, former, time.time()))
        write_whole(prometheus, text.encode(errors="backslashreplace"), overwrite=True, mode=_MODE)
        for name, series in doubled(text, _beside(prometheus)).items():
            voice.warn(
                f"{prometheus.name} and {name} both have {series}: the node exporter accepts neither; "
                f"remove {name} if it is no longer used, or let one command write both"
            )

    def _run(
        self, command: str | tuple[str, ...], event: str, job: str, outcome: Outcome, voice: Voice
    ) -> None:
        if self._hangs >= _MOST_HANGS:
            voice.warn(f"{outcome.name}: {program_of(command)} is not run: it timed out {_MOST_HANGS} times")
            return
        result = outcome.result
        happened = Event(
            outcome.name,
            outcome.target,
            outcome.station,
            job,
            event,
            result.exit_code,
            result.words,
            "" if result.file is None else str(result.file),
            utc(),
        )
        began = time.perf_counter()
        fault = run_command(command, happened)
        if fault is not None:
            voice.warn(f"--on-{event} for {outcome.name}: {fault}")
        self._hangs += time.perf_counter() - began >= TIME_LIMIT_S


def _beside(prometheus: Path) -> dict[str, str]:
    """The other files of the collector's folder, as far as they can be read."""
    found = {}
    with contextlib.suppress(OSError):
        for path in sorted(prometheus.absolute().parent.glob("*.prom")):
            with contextlib.suppress(FatektoolError):
                if path.name != prometheus.name:
                    found[path.name] = read_bounded(path, _MAX_FILE).decode(errors="replace")
    return found


def _samples(
    outcomes: list[tuple[str, Outcome]], former: dict[tuple[str, str], float], now: float
) -> Iterator[Sample]:
    for job, each in outcomes:
        result = each.result
        of_job = {"plc": each.name, "job": job}
        place = of_job | {"target": each.target, "station": each.station}
        yield sample("fatek_plc_info", 1, place)
        if result.up is not None:
            yield sample("fatek_up", result.up, of_job)
        yield sample("fatek_exit_code", result.exit_code, of_job)
        yield sample("fatek_last_run_timestamp_seconds", int(now), of_job)
        yield sample("fatek_duration_seconds", round(each.duration_s, 3), of_job)
        if result.exit_code == 0:
            former[each.name, job] = int(now)
        if result.changed is not None:
            yield sample("fatek_program_changed", result.changed, of_job)
        if result.flags is not None:
            for flag in _FLAGS:
                yield sample(f"fatek_{flag}", getattr(result.flags, flag), of_job)
    for (name, job), when in sorted(former.items()):
        yield sample("fatek_last_success_timestamp_seconds", when, {"plc": name, "job": job})


def alarm_options(*, changes: bool, place_first: bool = True) -> Callable[[F], F]:
    """The options; the command gets ``alarms``.

    Args:
        changes: False for a job that compares no programs, and has no ``--on-change``.
        place_first: False for a monitoring plugin, which checks the PLC even if its file cannot be written.
    """

    def decorated(function: F) -> F:
        @click.option(
            "--prometheus",
            type=PATH,
            metavar="FILE.prom",
            help="Also write metrics for the textfile collector of the node exporter.",
        )
        @click.option(
            "--on-failure",
            metavar="CMD",
            help="Run CMD for each PLC that failed or differs; FATEK_NAME, FATEK_MESSAGE … are set.",
        )
        @wraps(function)
        def with_alarms(
            *args: Any,
            prometheus: Path | None,
            on_failure: str | None,
            on_change: str | None = None,
            **rest: Any,
        ) -> Any:
            alarms = Alarms(
                prometheus,
                None if on_change is None else parse_command(on_change, "--on-change"),
                None if on_failure is None else parse_command(on_failure, "--on-failure"),
            )
            if prometheus is not None:
                if prometheus.suffix != ".prom":
                    raise UsageError(f"--prometheus {prometheus}: expected a name that ends in .prom")
                if place_first:
                    require_place(prometheus, overwrite=True)
            return function(*args, alarms=alarms, **rest)

        if changes:
            with_alarms = click.option(
                "--on-change",
                metavar="CMD",
                help="Run CMD for each PLC whose program has changed.",
            )(with_alarms)
        return with_alarms  # type: ignore[return-value]  # click's decorators hand back what they get

    return decorated
