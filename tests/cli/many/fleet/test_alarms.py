"""Who is told what became of the PLCs: the Prometheus file, the commands of the user's own."""

from __future__ import annotations

import json
import os
import re
import shlex
import sys
import time
from pathlib import Path
from typing import TYPE_CHECKING

import pytest
from hypothesis import given
from hypothesis import strategies as st

from fatektool.errors import UsageError
from fatektool.jobs.fleet.alarms import Event, parse_command, run_command
from fatektool.jobs.prometheus import METRICS, exposition, sample, successes
from tests.cli.running import NEW, OLD
from tests.program.samples import changed

if TYPE_CHECKING:
    from tests.cli.many.fleet.gateway import Hall
    from tests.cli.running import Cli

_LINE = re.compile(r'([a-z_]+)\{((?:[a-z]+="(?:[^"\\\n]|\\\\|\\"|\\n)*",?)*)\} (-?[\d.e+]+)')
WRITER = (
    "import json, os; found = {k: v for k, v in os.environ.items() if k.startswith('FATEK_')}; "
    "open('told.ndjson', 'a').write(json.dumps(found) + chr(10)); print('heard')"
)


def samples(text: str) -> dict[str, str]:
    """A file of the text format, by a reader of its own: HELP, TYPE, then samples, no time stamps."""
    found: dict[str, str] = {}
    metric = ""
    lines = text.splitlines()
    assert text.endswith("\n")
    for place, line in enumerate(lines):
        if line.startswith("# HELP "):
            metric = line.split()[2]
            assert lines[place + 1] == f"# TYPE {metric} gauge"
            assert not any(key.startswith(f"{metric}{{") for key in found)  # all of a metric together
        elif not line.startswith("#"):
            match = _LINE.fullmatch(line)
            assert match is not None, line
            assert match[1] == metric
            assert f"{metric}{{{match[2]}}}" not in found
            found[f"{metric}{{{match[2]}}}"] = match[3]
    return found


def told() -> list[dict[str, str]]:
    path = Path("told.ndjson")
    return [json.loads(line) for line in path.read_text().splitlines()] if path.exists() else []


@pytest.fixture
def command(place: Path) -> str:
    """A command that writes down what it is told."""
    script = place / "tell me.py"
    script.write_text(WRITER)
    return shlex.join([sys.executable, str(script)])


# --- Prometheus --------------------------------------------------------------------------------------------


def test_the_file(cli: Cli, plant: Hall) -> None:
    plant.press.running = plant.pump.battery_low = True
    began = int(time.time())
    assert cli("fleet", "status", "--prometheus", "x.prom").code == 0
    found = samples(Path("x.prom").read_text())
    assert found[f'fatek_plc_info{{job="status",plc="pump",station="2",target="{plant.targets[1]}"}}'] == "1"
    assert found['fatek_up{job="status",plc="press"}'] == "1"
    assert found['fatek_running{job="status",plc="press"}'] == "1"
    assert found['fatek_battery_low{job="status",plc="press"}'] == "0"
    assert found['fatek_battery_low{job="status",plc="pump"}'] == "1"
    assert found['fatek_exit_code{job="status",plc="press"}'] == "0"
    stamp = int(found['fatek_last_success_timestamp_seconds{job="status",plc="press"}'])
    assert began <= stamp <= time.time()
    if os.name == "posix":
        assert Path("x.prom").stat().st_mode & 0o004  # the collector is another user
    assert not list(Path().glob(".fatektool*"))


def test_a_run_that_fails_keeps_the_time_of_the_last_success(cli: Cli, plant: Hall) -> None:
    cli("fleet", "backup", "--dir", "backups", "--prometheus", "x.prom")
    text = re.sub(r"(fatek_last_success.*) \d+", r"\1 1000", Path("x.prom").read_text())
    Path("x.prom").write_text(text + 'fatek_last_success_timestamp_seconds{job="backup",plc="gone"} 7\n')
    plant.press.program_commands = False
    assert cli("fleet", "backup", "--dir", "backups", "--prometheus", "x.prom").code == 1
    found = samples(Path("x.prom").read_text())
    success = 'fatek_last_success_timestamp_seconds{{job="backup",plc="{}"}}'
    assert found[success.format("press")] == "1000"
    assert int(found[success.format("oven")]) > 1000
    assert success.format("gone") not in found  # not in the inventory any more
    assert found['fatek_exit_code{job="backup",plc="press"}'] == "4"
    assert found['fatek_up{job="backup",plc="press"}'] == "1"  # it answered: it refused
    assert found['fatek_program_changed{job="backup",plc="oven"}'] == "0"


def test_other_jobs_and_plcs_keep_their_successes(cli: Cli, plant: Hall) -> None:
    assert plant.targets
    cli("fleet", "backup", "--dir", "backups", "--prometheus", "x.prom")
    cli("fleet", "status", "--select", "press", "--prometheus", "x.prom")
    found = samples(Path("x.prom").read_text())
    for job, name in (("backup", "oven"), ("backup", "press"), ("status", "press")):
        assert f'fatek_last_success_timestamp_seconds{{job="{job}",plc="{name}"}}' in found


def test_a_plc_that_is_not_there(cli: Cli, plant: Hall) -> None:
    plant.write(nobody='target = "tcp://127.0.0.1:1"\n', odd='target = "sim:odd.state"\n')
    Path("odd.state").write_text("{}")
    cli("fleet", "status", "--prometheus", "x.prom")
    found = samples(Path("x.prom").read_text())
    assert found['fatek_up{job="status",plc="nobody"}'] == "0"
    assert found['fatek_exit_code{job="status",plc="nobody"}'] == "3"
    assert 'fatek_up{job="status",plc="odd"}' not in found  # nobody was asked


def test_a_single_check(cli: Cli, plant: Hall) -> None:
    plant.press.battery_low = True
    assert cli("check", "-p", "press", "--prometheus", "x.prom").code == 1
    found = samples(Path("x.prom").read_text())
    assert found['fatek_exit_code{job="check",plc="press"}'] == "1"
    assert found['fatek_battery_low{job="check",plc="press"}'] == "1"


@pytest.mark.parametrize("name", ["x.txt", "no/x.prom", "."])
def test_a_place_that_is_none(cli: Cli, plant: Hall, name: str) -> None:
    assert plant.targets
    done = cli("fleet", "status", "--prometheus", name)
    assert (done.code, done.out) == (2, "")


TEXTS = st.text(st.characters(codec="utf-8", exclude_characters="\r\x0b\x0c\x1c\x1d\x1e\x85\u2028\u2029"))


@given(st.dictionaries(st.tuples(TEXTS, st.sampled_from(["backup", "check"])), st.integers(0, 1 << 40)))
def test_any_name_is_escaped_and_read_back(stamps: dict[tuple[str, str], int]) -> None:
    metric = "fatek_last_success_timestamp_seconds"
    text = exposition(sample(metric, when, {"plc": plc, "job": job}) for (plc, job), when in stamps.items())
    assert successes(text) == stamps
    if stamps:
        assert len(samples(text)) == len(stamps)


def test_escapes_as_the_format_has_them() -> None:
    text = exposition([sample("fatek_up", 1, {"plc": 'a"b\\c\nd'})])
    assert text == (
        "# HELP fatek_up 1 if the PLC answered in the last run.\n# TYPE fatek_up gauge\n"
        'fatek_up{plc="a\\"b\\\\c\\nd"} 1\n'
    )
    assert all(re.fullmatch("fatek_[a-z_]+", metric) for metric in METRICS)


# --- commands ----------------------------------------------------------------------------------------------


def test_on_failure(cli: Cli, plant: Hall, command: str) -> None:
    plant.press.program_commands = False
    done = cli("fleet", "backup", "--dir", "backups", "--on-failure", command, "--json")
    assert done.code == 1
    done.document("fleet")  # what the command prints is not among it
    (event,) = told()
    assert event["FATEK_NAME"] == "press"
    assert event["FATEK_TARGET"] == plant.targets[0]
    assert event["FATEK_STATION"] == "1"
    assert (event["FATEK_JOB"], event["FATEK_EVENT"], event["FATEK_EXIT_CODE"]) == ("backup", "failure", "4")
    assert "refused to read program page 0" in event["FATEK_MESSAGE"]
    assert event["FATEK_FILE"] == ""
    assert re.fullmatch(r"\d{4}-\d\d-\d\dT\d\d:\d\d:\d\dZ", event["FATEK_TIME"])


def test_on_change(cli: Cli, plant: Hall, command: str) -> None:
    for _ in range(2):
        assert cli("fleet", "backup", "--dir", "backups", "--on-change", command).code == 0
        assert told() == []  # a first backup is no change
    plant.pump.pages = [*changed(NEW, 3).pages]
    assert cli("fleet", "backup", "--dir", "backups", "--on-change", command).code == 0
    (event,) = told()
    assert (event["FATEK_NAME"], event["FATEK_EVENT"], event["FATEK_EXIT_CODE"]) == ("pump", "change", "0")
    assert event["FATEK_FILE"] == os.path.join("backups", "pump.json")  # noqa: PTH118  # as it was named


def test_verify_and_check_tell_of_a_change(cli: Cli, plant: Hall, command: str) -> None:
    cli("fleet", "backup", "--dir", "backups")
    plant.write(press='reference = "backups/press.json"\n')
    plant.press.pages = [*changed(OLD, 3).pages]
    for number, words in enumerate(("fleet verify --select press", "fleet check", "check -p press"), 1):
        assert cli(*words.split(), "--on-change", command).code in {1, 2}
        assert len(told()) == number
    assert [(event["FATEK_JOB"], event["FATEK_EVENT"]) for event in told()] == [
        ("verify", "change"),
        ("check", "change"),
        ("check", "change"),
    ]


def test_no_shell_reads_what_a_plc_says(cli: Cli, plant: Hall, command: str) -> None:
    plant.write(**{'"Öfen"': 'target = "tcp://$(touch x);`touch y`"\n'})
    done = cli("fleet", "status", "--on-failure", f"{command} $(touch z) ';touch w'")
    assert done.code in {1, 5}
    plant.write(**{'"Öfen"': 'target = "/dev/no $(touch x) | touch y"\n'})
    assert cli("fleet", "status", "--on-failure", f"{command} '$(touch z)' ';touch w'").code == 1
    (event,) = told()
    assert event["FATEK_NAME"] == "Öfen"
    assert not {path.name for path in Path().iterdir()} & set("wxyz")


EVENT = Event("press", "sim:", 1, "check", "failure", 2, "two\nlines\0", "", "2026-11-22T00:00:00Z")


def test_an_event_s_texts_are_on_one_line() -> None:
    assert EVENT.environment()["FATEK_MESSAGE"] == "two lines"
    assert set(EVENT.environment()) == {
        f"FATEK_{word}"
        for word in ("NAME", "TARGET", "STATION", "JOB", "EVENT", "EXIT_CODE", "MESSAGE", "FILE", "TIME")
    }


@pytest.mark.parametrize(
    ("program", "fault"),
    [
        ("pass", None),
        ("raise SystemExit(3)", "ended with exit code 3"),
        ("import os, signal; os.kill(os.getpid(), signal.SIGTERM)", "ended with exit code -15"),
        ("import sys; sys.exit(sys.stdin.read() != '')", None),  # it waits for no input
    ],
)
def test_how_a_command_ends(program: str, fault: str | None) -> None:
    found = run_command([sys.executable, "-c", program], EVENT)
    assert found == (None if fault is None else f"{sys.executable} {fault}")


def test_a_command_that_is_not_there() -> None:
    assert (
        run_command(["no-such-command"], EVENT) == "cannot start no-such-command: No such file or directory"
    )
    assert str(run_command(["a\0b"], EVENT)).startswith("cannot start a\0b: embedded null")


@pytest.mark.skipif(os.name != "posix", reason="a process group")
def test_a_command_that_hangs_is_ended_with_all_it_started(tmp_path: Path) -> None:
    """The child holds a pipe open: that it ends shows when the pipe does."""
    pipe = tmp_path / "alive"
    os.mkfifo(pipe)
    program = f"exec 3>{shlex.quote(str(pipe))}; sleep 1000 & sleep 1000"
    reader = os.open(pipe, os.O_RDONLY | os.O_NONBLOCK)
    assert run_command(["bash", "-c", program], EVENT, time_limit_s=0.3) == (
        "bash did not end within 0.3 s, and was stopped"
    )
    os.set_blocking(reader, True)
    assert os.read(reader, 1) == b""  # the end: nobody has it open any more
    os.close(reader)


def test_a_command_that_fails_is_warned_of_and_no_more(cli: Cli, plant: Hall) -> None:
    plant.write(nobody='target = "tcp://127.0.0.1:1"\n')
    done = cli("fleet", "status", "--on-failure", "no-such-command")
    assert done.code == 1
    assert "warning: --on-failure for nobody: cannot start no-such-command: No such file" in done.err


def test_a_command_that_hangs_is_not_started_for_ever(
    cli: Cli, plant: Hall, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setattr("fatektool.cli.many.alarms.run_command", lambda *_: "hung")
    monkeypatch.setattr("fatektool.cli.many.alarms.TIME_LIMIT_S", 0.0)
    plant.write(**{f"n{number}": 'target = "tcp://127.0.0.1:1"\n' for number in range(5)})
    done = cli("fleet", "status", "--on-failure", "x", "--news", "-q")
    assert done.err.count(": hung") == 3
    assert done.err.count("x is not run: it timed out 3 times") == 2


@pytest.mark.parametrize(
    ("text", "words"), [("a b", ("a", "b")), ("'a b' \"c d\"", ("a b", "c d")), (r"a\ b", ("a b",))]
)
def test_a_command_is_taken_apart(text: str, words: tuple[str, ...]) -> None:
    assert parse_command(text, "--on-change") == words


@pytest.mark.parametrize("text", ["", "  ", "'a", "''"])
def test_a_command_that_is_none(text: str) -> None:
    with pytest.raises(UsageError, match="--on-change"):
        parse_command(text, "--on-change")
