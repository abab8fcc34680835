"""docs/operations.md gives what it shows; the examples that it names run"""

from __future__ import annotations

import configparser
import os
import re
import shlex
import shutil
import socket
import subprocess
import tomllib
from pathlib import Path
from typing import TYPE_CHECKING

import pytest

from fatektool.inventory.entries import parse_inventory
from fatektool.inventory.values import KEYS_OF_ALL
from tests.forks.shell import path as shell_path
from tests.root import EXAMPLES, ROOT

if TYPE_CHECKING:
    from tests.cli.many.fleet.gateway import Hall
    from tests.cli.running import Cli

PAGE = (ROOT / "docs" / "operations.md").read_text(encoding="utf-8")

PLAIN = (
    (r"\d+\.\d s\b", "N s"),
    (r"slowest [\w-]+", "slowest PLC"),
    (r"backup \d+ s old", "backup N s old"),
    (r"\d{4}-\d\d-\d\d[T ]\d\d:\d\d(:\d\d)?Z?", "TIME"),
    (r"\b[0-9a-f]{10}\b", "REVISION"),
)


def plain(text: str) -> list[str]:
    """Lines without what differs from run to run, in any order: PLCs end when they end."""
    for pattern, word in PLAIN:
        text = re.sub(pattern, word, text)
    # A free port may have more digits than the page's, and a column with it is wider then.
    return sorted(re.sub(r"  +", "  ", line.rstrip()) for line in text.splitlines())


def shell(script: str, **more: str) -> subprocess.CompletedProcess[str]:
    """Run a script as a user's shell would, with this fatektool in front."""
    environment = os.environ | {"PATH": shell_path(), "PYTHONUTF8": "1", "LC_ALL": "C.UTF-8"} | more
    environment.pop("PYTEST_ADDOPTS", None)
    return subprocess.run(
        ["bash", "-c", script], env=environment, capture_output=True, text=True, check=False
    )


def free_port() -> str:
    with socket.socket() as probe:
        probe.bind(("127.0.0.1", 0))
        return str(probe.getsockname()[1])


@pytest.mark.skipif(
    not all(map(shutil.which, ("bash", "git", "sed"))), reason="the page is for a POSIX shell with git"
)
@pytest.mark.usefixtures("place")
def test_the_page_gives_what_it_shows() -> None:
    page = PAGE
    for port in ("5510", "5511"):
        page = page.replace(f"127.0.0.1:{port}", f"127.0.0.1:{free_port()}")
    steps: list[tuple[str, str]] = []
    for block in re.findall(r"```console\n(.*?)```", page, re.DOTALL):
        for step in re.split(r"^\$ ", block, flags=re.MULTILINE)[1:]:
            command, _, output = step.partition("\n")
            steps.append((command, output))
    lines = ['trap "kill %1 %2; wait" EXIT']
    for number, (command, _) in enumerate(steps):
        lines.append(f"echo '<<{number}>>'")
        if command.endswith(" &"):
            lines.append(f"{command.removesuffix(' &')} > door{number} &")
            lines.append(f"until grep -q listening door{number}; do :; done; cat door{number}")
        else:
            lines.append(f"{{ {command}; }} 2>&1")
    done = shell("\n".join(lines))
    pieces = re.split(r"^<<\d+>>\n", done.stdout, flags=re.MULTILINE)[1:]
    assert len(pieces) == len(steps) > 30
    for (command, expected), got in zip(steps, pieces, strict=True):
        assert plain(got) == plain(expected), command


def test_the_page_names_every_key_and_option(cli: Cli) -> None:
    rows = PAGE.split("| key | meaning |")[1].split("\n\n")[0]
    (fault,) = parse_inventory(b'[plc.p]\ntarget = "sim:"\nqqq = 1\n', Path("x")).faults
    keys = fault.message.split("expected one of ")[1].split(", ")
    named = re.findall(r"`(\w+)`", re.sub(r"\|[^|]*\|$", "|", rows, flags=re.MULTILINE))
    assert sorted(named) == sorted([*keys, *KEYS_OF_ALL])
    for name in ("status", "backup", "verify", "snapshot", "check"):
        for option in re.findall(r"--(?:on-\w+|dir|history|push|deadline|jobs|select|prometheus|max-age)\b",
                                 cli("fleet", name, "--help").out):  # fmt: skip
            assert option in PAGE
    for path in EXAMPLES.glob("**/*fleet*"):
        assert path.stem in PAGE


def test_the_inventory_to_copy() -> None:
    data = (EXAMPLES / "fatek.toml").read_bytes()
    found = parse_inventory(data, EXAMPLES / "fatek.toml")
    assert found.faults == []
    assert list(found.plcs) == ["press", "oven", "pump"]
    spec = found.plcs["press"].spec
    assert spec is not None
    assert spec.exists()
    documented = tomllib.loads(data.decode().replace("# reference = ", "reference = "))["plc"]
    assert {key for table in documented.values() for key in table} >= {
        "target",
        "spec",
        "reference",
        "expect",
    }


def words_of(command: str, place: Path) -> str:
    return re.sub(r"/etc/fatektool|/var/lib/fatektool|/var/lib/prometheus/node-exporter", str(place), command)


@pytest.mark.skipif(shutil.which("bash") is None, reason="cron starts a shell")
def test_crontab(plant: Hall, place: Path) -> None:
    assert plant.targets
    jobs = []
    for line in (EXAMPLES / "crontab-fleet").read_text(encoding="utf-8").splitlines():
        if line and not line.startswith("#") and not re.match("[A-Z_]+=", line):
            *times, command = line.split(None, 5)
            assert all(re.fullmatch(r"\*|\d+|\*/\d+", time) for time in times)
            assert "%" not in command
            jobs.append(command)
    assert len(jobs) == 2
    for command in jobs * 2:
        done = shell(words_of(command, place))
        assert (done.returncode, done.stdout, done.stderr) == (0, "", "")  # cron mails nothing
    plant.press.program_commands = False
    done = shell(words_of(jobs[0], place))
    assert done.returncode == 1
    assert done.stdout.startswith("press  FAILED    refused: ")
    assert {path.name for path in place.glob("*.prom")} == {"fatek-backup.prom", "fatek-check.prom"}


def unit(name: str) -> dict[str, dict[str, str]]:
    parser = configparser.RawConfigParser(strict=True)
    parser.optionxform = str  # type: ignore[assignment, method-assign]  # systemd's keys have capitals
    parser.read(EXAMPLES / "systemd" / name, encoding="utf-8")
    return {section: dict(parser[section]) for section in parser.sections()}


def test_systemd(cli: Cli, plant: Hall, place: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    service = unit("fatektool-fleet.service")["Service"]
    program, *words = shlex.split(words_of(service["ExecStart"].replace("%S", str(place)), place))
    assert (program, service["Type"]) == ("/usr/local/bin/fatektool", "oneshot")
    assert "/run/lock" in service["ReadWritePaths"]
    name, _, path = service["Environment"].partition("=")
    for folder in service["StateDirectory"].split():
        (place / folder).mkdir()
    plant.write(oven='tags = ["night"]\n')
    monkeypatch.setenv(name, words_of(path, place))
    for _ in range(2):
        done = cli(*words)
        assert (done.code, done.out, done.err) == (0, "", "")
    kept = {path.name for path in (place / "fatektool" / "backups").iterdir()}
    assert kept == {"press.json", "oven.json"}
    assert (place / "fatektool" / "history" / "HEAD").exists()
    assert (place / "fatek-backup.prom").exists()  # where the node exporter of Debian looks
    timer = unit("fatektool-fleet.timer")
    assert timer["Timer"]["OnCalendar"]
    assert timer["Install"]["WantedBy"] == "timers.target"
