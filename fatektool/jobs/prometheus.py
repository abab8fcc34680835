r"""Figures of PLCs as files for the textfile collector of Prometheus's node exporter.

The collector reads all files of a folder as one: it refuses both files if a series is in two of them, and a
metric has one help text in all. So each series has the label of its job, and that of a snapshot the name of
its file or specification. ``fatek_last_run_timestamp_seconds`` shows which of two jobs ran last.

The collector refuses time stamps on samples, so the time of the last success is a value: the age is
``time() - fatek_last_success_timestamp_seconds``. The values of the former file are kept, as a run that fails
must not remove the time of the last success.

Source: Prometheus, "Exposition formats", text-based format: in a label's value ``\``, ``"`` and a line feed
are written ``\\``, ``\"`` and ``\n``.
"""

from __future__ import annotations

import re
from dataclasses import dataclass
from typing import TYPE_CHECKING, Final

if TYPE_CHECKING:
    from collections.abc import Iterable, Iterator, Mapping

METRICS: Final = {
    "fatek_plc_info": "Always 1; where the PLC is.",
    "fatek_up": "1 if the PLC answered in the last run.",
    "fatek_exit_code": "Exit code of the last run of a job: 0 is well.",
    "fatek_last_run_timestamp_seconds": "When a job ran last.",
    "fatek_last_success_timestamp_seconds": "When a job ended well last.",
    "fatek_duration_seconds": "How long the last run of a job took.",
    "fatek_program_changed": "1 if the program was not the one expected or kept before.",
    "fatek_running": "1 if the PLC is in RUN.",
    "fatek_battery_low": "1 if the PLC's battery is low.",
    "fatek_ladder_checksum_error": "1 if the PLC's program has a wrong checksum.",
    "fatek_watchdog_timeout": "1 if the PLC's watchdog timed out.",
    "fatek_emergency_stop": "1 if the PLC's emergency stop is active.",
    "fatek_snapshot_timestamp_seconds": "When the values were read.",
    "fatek_value": "Value of an element.",
}
"""Each metric, a gauge, with its help, in the file's order."""

_PLAIN_BELOW: Final = 10**15
_SUCCESS: Final = "fatek_last_success_timestamp_seconds"
_SAMPLE: Final = re.compile(_SUCCESS + r'\{job="([^"\\]*)",plc="((?:[^"\\]|\\.)*)"\} ([0-9.e+]+)', re.ASCII)
_ESCAPES: Final = {"\\": "\\\\", '"': '\\"', "\n": "\\n"}
_UNESCAPES: Final = {"\\\\": "\\", '\\"': '"', "\\n": "\n"}


@dataclass(frozen=True, slots=True)
class Sample:
    """One value of one metric.

    Attributes:
        metric: its name, one of ``METRICS``.
        labels: in the order of the file.
        value: the value.
    """

    metric: str
    labels: tuple[tuple[str, str], ...]
    value: float


def sample(metric: str, value: float, labels: Mapping[str, object]) -> Sample:
    """One value, its labels in alphabetical order."""
    return Sample(metric, tuple(sorted((name, str(text)) for name, text in labels.items())), value)


def exposition(samples: Iterable[Sample]) -> str:
    """The file: samples by metric, each metric with HELP and TYPE."""
    by_metric: dict[str, list[Sample]] = {}
    for each in samples:
        by_metric.setdefault(each.metric, []).append(each)
    return "".join(f"{line}\n" for metric in METRICS for line in _lines(metric, by_metric.get(metric, [])))


def _lines(metric: str, samples: list[Sample]) -> Iterator[str]:
    if not samples:
        return
    yield f"# HELP {metric} {METRICS[metric]}"
    yield f"# TYPE {metric} gauge"
    for each in samples:
        labels = ",".join(f'{name}="{_escaped(text)}"' for name, text in each.labels)
        yield f"{metric}{{{labels}}} {_number(each.value)}"


def successes(text: str) -> dict[tuple[str, str], float]:
    """When each job of each PLC ended well last, by a former file: ``{(plc, job): seconds}``."""
    found = {}
    for line in text.splitlines():
        match = _SAMPLE.fullmatch(line)
        if match is not None:
            plc = re.sub(r"\\.", lambda escape: _UNESCAPES.get(escape[0], escape[0]), match[2])
            found[plc, match[1]] = float(match[3])
    return found


def _number(value: float) -> str:
    """As short as it can be without being another one."""
    return str(int(value)) if value == int(value) and abs(value) < _PLAIN_BELOW else repr(value)


def doubled(text: str, others: Mapping[str, str]) -> dict[str, str]:
    """Which files have a series that this one has too; the collector would refuse both.

    Args:
        text: of this file.
        others: the other files of its folder, by name.

    Returns:
        A series of each such file.
    """
    own = _series(text)
    shared = {name: own & _series(other) for name, other in others.items()}
    return {name: min(found) for name, found in shared.items() if found}


def _series(text: str) -> set[str]:
    return {line.rpartition(" ")[0] for line in text.splitlines() if line.startswith("fatek_")}


def _escaped(text: str) -> str:
    return re.sub(r'[\\"\n]', lambda found: _ESCAPES[found[0]], text)
