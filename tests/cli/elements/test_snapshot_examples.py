"""The examples of snapshots: specification, crontab, systemd units. And docs/snapshots.md, word by word."""

from __future__ import annotations

import configparser
import os
import re
import shlex
import shutil
import subprocess
import sys
import tomllib
from typing import TYPE_CHECKING, Any

import pytest

from fatektool.jobs.snapshots.spec import parse_spec
from tests.forks.shell import path as shell_path
from tests.platforms import posix
from tests.root import EXAMPLES, ROOT

if TYPE_CHECKING:
    from pathlib import Path

    from tests.plant import Plant

DOCS = (ROOT / "docs" / "snapshots.md").read_text(encoding="utf-8")
UNITS = EXAMPLES / "systemd"


def shell(place: Path, script: str, **more: str) -> subprocess.CompletedProcess[str]:
    """Run a script as a user's shell would, with this fatektool in front."""
    environment = os.environ | {"PATH": shell_path(), "PYTHONUTF8": "1", "LC_ALL": "C.UTF-8"} | more
    return subprocess.run(
        ["bash", "-c", script], cwd=place, env=environment, capture_output=True, text=True, check=False
    )


def test_every_example_is_listed() -> None:
    listed = (EXAMPLES / "README.md").read_text(encoding="utf-8")
    for path in (EXAMPLES / "press.toml", EXAMPLES / "crontab", *UNITS.iterdir()):
        assert f"`{path.relative_to(EXAMPLES).as_posix()}`" in listed


def test_press(plant: Plant) -> None:
    plant.write("R12=714", "D4:f32=41.5", "DRC200=70000", "Y1=on", "R100=0xBEEF")
    document = plant.json("snapshot", "snapshot", "--spec", EXAMPLES / "press.toml")
    assert document["values"]["pressure"] == 51.4
    assert document["values"]["oil temperature"] == 41.5
    assert document["values"]["strokes"] == 70000
    assert document["values"]["valve[1]"] is True
    assert document["values"]["R100"] == "BEEF"
    daily = plant.json("snapshot", "snapshot", "--spec", EXAMPLES / "press.toml", "--group", "daily")
    assert list(daily["values"]) == ["pressure", "strokes"]


def cron_jobs() -> tuple[dict[str, str], list[tuple[list[str], str]]]:
    """What a crontab sets, and its times and commands: an unescaped % ends a command."""
    settings, jobs = {}, []
    for line in (EXAMPLES / "crontab").read_text(encoding="utf-8").splitlines():
        if not line or line.startswith("#"):
            continue
        if match := re.fullmatch(r"([A-Z_]+)=(.*)", line):
            settings[match[1]] = match[2]
            continue
        *times, command = line.split(None, 5)
        assert not re.search(r"(?<!\\)%", command)
        jobs.append((times, command.replace("\\%", "%")))
    return settings, jobs


@pytest.mark.skipif(shutil.which("bash") is None, reason="cron starts a shell")
def test_crontab(plant: Plant, place: Path) -> None:
    settings, jobs = cron_jobs()
    assert len(jobs) == 2
    (place / "press").mkdir()
    shutil.copy(EXAMPLES / "press.toml", place)
    for times, command in jobs:
        assert all(re.fullmatch(r"\*|\d+|\*/\d+", time) for time in times)
        here = command.replace("/etc/fatektool/", f"{place}/").replace("/var/lib/fatektool/", f"{place}/")
        for _ in range(2):
            done = shell(place, here, FATEKTOOL_PORT=plant.target)
            assert (done.returncode, done.stdout, done.stderr) == (0, "", "")  # cron mails nothing
    assert settings["FATEKTOOL_PORT"].startswith("/dev/")
    assert len((place / "press.ndjson").read_text().splitlines()) == 2
    assert len(list((place / "press").iterdir())) == 2


def unit(name: str) -> dict[str, dict[str, str]]:
    parser = configparser.RawConfigParser(strict=True)
    parser.optionxform = str  # type: ignore[assignment, method-assign]  # systemd's keys have capitals
    parser.read(UNITS / name, encoding="utf-8")
    return {section: dict(parser[section]) for section in parser.sections()}


@posix("systemd")
def test_systemd_service(plant: Plant, place: Path) -> None:
    service = unit("fatektool-snapshot.service")["Service"]
    assert service["Type"] == "oneshot"
    program, *words = shlex.split(service["ExecStart"].replace("%S", str(place)))
    assert program == "/usr/local/bin/fatektool"
    for folder in service["StateDirectory"].split():
        (place / folder).mkdir()
    done = plant.cli(*words)
    assert (done.code, done.out, done.err) == (0, "", "")
    (kept,) = (place / "fatektool" / "press").iterdir()
    assert re.fullmatch(r"snapshot-st01-\d{8}T\d{6}Z\.json", kept.name)
    assert service["Environment"].startswith("FATEKTOOL_PORT=")
    assert "/run/lock" in service["ReadWritePaths"]


def test_systemd_timer() -> None:
    timer = unit("fatektool-snapshot.timer")
    assert timer["Timer"]["RandomizedDelaySec"]
    assert timer["Timer"]["OnCalendar"]
    assert timer["Install"]["WantedBy"] == "timers.target"
    assert {path.name for path in UNITS.iterdir()} >= {
        "fatektool-snapshot.service",
        "fatektool-snapshot.timer",
    }


@pytest.mark.skipif(shutil.which("systemd-analyze") is None, reason="no systemd here")
def test_systemd_itself_finds_nothing(place: Path) -> None:
    units = [path for path in UNITS.iterdir() if path.suffix != ".conf"]
    for path in units:
        text = path.read_text(encoding="utf-8").replace("/usr/local/bin/fatektool", sys.executable)
        (place / path.name).write_text(text, encoding="utf-8")
    names = [str(place / path.name) for path in units]
    done = subprocess.run(["systemd-analyze", "verify", *names], capture_output=True, text=True, check=False)
    assert (done.returncode, done.stderr) == (0, "")


def plain(text: str) -> str:
    """Without what differs from run to run."""
    text = re.sub(r"\d{8}T\d{6}Z|\d{4}-\d\d-\d\dT\d\d:\d\d:\d\dZ", "TIME", text)
    text = re.sub(r"took (under 1 s|\d+ (s|min))( of simulated time)?\n", "took T\n", text)
    text = re.sub(r"\b\d{19}\b", "NANOSECONDS", text)
    return re.sub(r"\b\d{10}\b", "SECONDS", text)


@pytest.mark.skipif(shutil.which("bash") is None, reason="the page is for a POSIX shell")
def test_the_page_gives_what_it_shows(place: Path) -> None:
    steps: list[tuple[str, str]] = []
    for block in re.findall(r"```console\n(.*?)```", DOCS, re.DOTALL):
        for step in re.split(r"^\$ ", block, flags=re.MULTILINE)[1:]:
            command, _, output = step.partition("\n")
            steps.append((command, output))
    shutil.copy(EXAMPLES / "press.toml", place)
    script = "\n".join(f"echo '<<{number}>>'\n{command} 2>&1" for number, (command, _) in enumerate(steps))
    done = shell(place, script)
    pieces = re.split(r"^<<\d+>>\n", done.stdout, flags=re.MULTILINE)[1:]
    assert len(pieces) == len(steps) > 12
    for (command, expected), got in zip(steps, pieces, strict=True):
        assert plain(got) == plain(expected), command


def test_the_page_s_specification_is_one() -> None:
    (text,) = re.findall(r"```toml\n(.*?)```", DOCS, re.DOTALL)
    document: dict[str, Any] = tomllib.loads(text)
    assert set(document["item"][0]) | {"group"} == {
        "element", "name", "type", "scale", "offset", "unit", "group", "groups",
    }  # fmt: skip
    assert parse_spec(text.encode(), "docs").items[0].item.key == "pressure"


def test_the_page_names_every_option() -> None:
    options = (
        "--spec --all --group --append --keep --format --only --dry-run --yes --safety-dir --ignore "
        "--tolerance --lock-wait"
    )
    for option in (*options.split(), "-o DIR/", "-o FILE"):
        assert option in DOCS
