"""Every file for Prometheus before its own judges: promtool, the node exporter, Prometheus itself."""

from __future__ import annotations

import json
import re
import shlex
import subprocess
import threading
import time
import urllib.parse
import urllib.request
from contextlib import contextmanager
from pathlib import Path
from typing import TYPE_CHECKING, Any

import pytest

from tests.cli.many.fleet.gateway import Hall, hall
from tests.parts.programs import PATIENCE_S, command, free_port, listening, needs, running
from tests.root import EXAMPLES

if TYPE_CHECKING:
    from collections.abc import Iterator

    from tests.cli.running import Cli

OPERATIONS = EXAMPLES.parent / "docs" / "operations.md"
RULES = EXAMPLES / "prometheus" / "fatek.rules.yml"
FLEET = {
    "status": "fleet status",
    "backup": "fleet backup --dir backups",
    "verify": "fleet verify",
    "snapshot": "fleet snapshot --dir snapshots",
    "check": "fleet check --backups backups",
}


@pytest.fixture
def plant(place: Path) -> Iterator[Hall]:
    """A hall in which each job has something to say of each PLC; one is not there."""
    (place / "spec.toml").write_text('[[item]]\nname = "speed"\nelement = "R12"\n')
    with hall() as made:
        more = 'reference = "backups/press.json"\nspec = "spec.toml"\n'
        made.write(press=more, oven=more, pump=more, gone='target = "tcp://127.0.0.1:1"\n')
        (place / "backups").mkdir()
        (place / "snapshots").mkdir()
        (place / "prom").mkdir()
        yield made


def written(cli: Cli, place: Path, plant: Hall) -> list[Path]:
    """What every command writes, into one folder; the examples' own commands among them."""
    for job, words in FLEET.items():
        cli(*words.split(), "--prometheus", place / f"prom/fleet-{job}.prom")
    for name in ("a", "b"):  # two snapshots of one PLC
        for target in plant.targets:
            port = target.rpartition(":")[2]
            done = cli("snapshot", "R0-R3", "Y0", "-p", target, "-o", place / f"prom/{name}-{port}.prom")
            assert done.code == 0, done.err
    return sorted((place / "prom").iterdir())


def example_commands(place: Path) -> list[list[str]]:
    """The commands of crontab and units that write a .prom file, with their folders in this one."""
    found = []
    for path in (EXAMPLES / "crontab-fleet", *sorted((EXAMPLES / "systemd").glob("*.service"))):
        for line in path.read_text(encoding="utf-8").splitlines():
            match = re.search(r"fatektool (fleet .*--prometheus.*)", line)
            if match is not None and not line.startswith("#"):
                words = re.sub(r"/var/lib/prometheus/node-exporter", f"{place}/prom", match[1])
                words = re.sub(r"(/var/lib|%S)/fatektool", str(place), words).replace(" >/dev/null", "")
                found.append(shlex.split(words.replace("--select night", "")))
    return found


# --- promtool -----------------------------------------------------------------------------------------


@needs("promtool")
def test_promtool_finds_nothing_in_any_file(cli: Cli, place: Path, plant: Hall) -> None:
    paths = written(cli, place, plant)
    assert len(paths) == len(FLEET) + 4
    cli("check", "-p", "press", "--prometheus", place / "prom/one.prom")
    for path in [*paths, place / "prom/one.prom"]:
        assert judged(path.read_text(encoding="utf-8")) == (0, ""), path.name


@needs("promtool")
def test_promtool_would_find_something() -> None:
    code, said = judged('fatek_up{plc="a"} 1\nfatek_up{plc="a"} 0\n')
    assert code
    assert said


def judged(text: str) -> tuple[int, str]:
    done = subprocess.run(
        command("promtool", "check", "metrics"), input=text, capture_output=True, text=True, check=False
    )
    return done.returncode, done.stdout + done.stderr


@needs("promtool")
def test_the_rules_of_the_page_are_those_to_copy_and_do_what_they_say(place: Path) -> None:
    page = re.search(r"```yaml\n(groups:.*?)```", OPERATIONS.read_text(encoding="utf-8"), re.DOTALL)
    assert page is not None
    assert RULES.read_text(encoding="utf-8").endswith(page[1])
    (place / "rules.yml").write_bytes(RULES.read_bytes())
    (place / "tests.yml").write_text(json.dumps(rule_tests()), encoding="utf-8")  # JSON is YAML
    for words in (("check", "rules", "rules.yml"), ("test", "rules", "tests.yml")):
        done = subprocess.run(
            command("promtool", *words), capture_output=True, text=True, check=False, cwd=place
        )
        assert done.returncode == 0, done.stdout + done.stderr


def rule_tests() -> dict[str, Any]:
    """A PLC that the backup of the night found up and this hour's check down; another the other way round."""

    def series(name: str, job: str, plc: str, value: float) -> dict[str, str]:
        labels = f'exported_job="{job}",instance="gw",job="node",plc="{plc}"'
        return {"series": f"{name}{{{labels}}}", "values": f"{value:g}x180"}

    rows = [
        series("fatek_up", "backup", "died", 1),
        series("fatek_up", "check", "died", 0),
        series("fatek_up", "backup", "came-back", 0),
        series("fatek_up", "check", "came-back", 1),
        series("fatek_battery_low", "status", "died", 1),
        series("fatek_last_success_timestamp_seconds", "backup", "died", -40 * 3600),
        series("fatek_last_success_timestamp_seconds", "backup", "came-back", 0),
    ]
    for plc in ("died", "came-back"):
        rows += [
            series("fatek_last_run_timestamp_seconds", "backup", plc, 600),
            series("fatek_last_run_timestamp_seconds", "check", plc, 3600),
            series("fatek_last_run_timestamp_seconds", "status", plc, 60),
        ]

    def alarm(name: str, job: str | None, minute: int = 70) -> dict[str, Any]:
        labels = {"exported_job": job, "instance": "gw", "job": "node", "plc": "died"}
        expected = [] if job is None else [{"exp_labels": labels}]
        return {"eval_time": f"{minute}m", "alertname": name, "exp_alerts": expected}

    both = [{"exp_labels": {"instance": "gw", "plc": plc}} for plc in ("came-back", "died")]
    return {
        "rule_files": ["rules.yml"],
        "evaluation_interval": "1m",
        "tests": [
            {
                "interval": "1m",
                "input_series": rows,
                "alert_rule_test": [
                    alarm("PlcDown", "check"),
                    alarm("BatteryLow", None),  # a look that is older than the last one
                    alarm("NoGoodBackup", "backup"),
                    alarm("NobodyLooked", None),
                    {"eval_time": "181m", "alertname": "NobodyLooked", "exp_alerts": both},
                ],
            }
        ],
    }


# --- the node exporter --------------------------------------------------------------------------------


@contextmanager
def exporter(folder: Path) -> Iterator[int]:
    """A node exporter over a folder; its port."""
    port = free_port()
    words = command(
        "prometheus-node-exporter",
        "--collector.disable-defaults",
        "--collector.textfile",
        f"--collector.textfile.directory={folder}",
        f"--web.listen-address=127.0.0.1:{port}",
        "--web.disable-exporter-metrics",
    )
    with listening(words, port):
        yield port


def got(url: str) -> str:
    with urllib.request.urlopen(url, timeout=PATIENCE_S) as answer:  # noqa: S310  # this computer's own
        text: str = answer.read().decode()
        return text


def series(text: str) -> dict[str, float]:
    """The samples, by name and sorted labels."""
    found = {}
    for line in text.splitlines():
        match = re.fullmatch(r"(fatek_\w+)\{(.*)\} (\S+)", line)
        if match is not None:
            labels = sorted(re.findall(r'\w+="(?:[^"\\]|\\.)*"', match[2]))
            name = f"{match[1]}{{{','.join(labels)}}}"
            assert name not in found, name
            found[name] = float(match[3])
    return found


@needs("prometheus-node-exporter")
def test_the_node_exporter_takes_all_files_of_a_folder(cli: Cli, place: Path, plant: Hall) -> None:
    paths = written(cli, place, plant)
    for words in example_commands(place):
        cli(*words)
    names = {path.name for path in (place / "prom").iterdir()}
    assert names >= {"fatek-backup.prom", "fatek-check.prom"}
    for name in ("fleet-backup.prom", "fleet-check.prom"):  # the same jobs of the same PLCs: once is enough
        (place / "prom" / name).unlink()
    with exporter(place / "prom") as port:
        text = got(f"http://127.0.0.1:{port}/metrics")
    assert "node_textfile_scrape_error 0" in text
    wanted: dict[str, float] = {}
    for path in sorted((place / "prom").iterdir()):
        own = series(path.read_text(encoding="utf-8"))
        assert own
        assert not wanted.keys() & own.keys()
        wanted |= own
    shown = {re.sub(r',?\w+=""', "", name): value for name, value in series(text).items()}
    assert {name.replace("{,", "{") for name in shown} == wanted.keys()
    assert len(paths) > len(FLEET)
    up = {name: value for name, value in wanted.items() if name.startswith("fatek_up") and "gone" in name}
    assert len(up) >= 3
    assert not any(up.values())


@needs("prometheus-node-exporter")
def test_the_node_exporter_would_refuse_one_series_in_two_files(cli: Cli, place: Path, plant: Hall) -> None:
    assert plant.targets
    cli("fleet", "status", "--prometheus", "prom/a.prom")
    (place / "prom/b.prom").write_bytes((place / "prom/a.prom").read_bytes().replace(b"} 1", b"} 0"))
    with exporter(place / "prom") as port:
        try:
            text = got(f"http://127.0.0.1:{port}/metrics")
        except OSError as error:
            text = str(error)
    assert "500" in text or "node_textfile_scrape_error 1" in text


def test_a_series_that_another_file_has_is_warned_of(cli: Cli, place: Path, plant: Hall) -> None:
    assert plant.targets
    assert "neither" not in cli("fleet", "status", "--prometheus", "prom/a.prom").err
    assert "neither" not in cli("fleet", "backup", "--dir", "backups", "--prometheus", "prom/b.prom").err
    assert "neither" not in cli("fleet", "status", "--prometheus", "prom/a.prom").err  # its own is replaced
    done = cli("fleet", "status", "--select", "oven", "--prometheus", "prom/c.prom", "-q")
    assert done.code == 0
    assert 'c.prom and a.prom both have fatek_battery_low{job="status",plc="oven"}' in done.err
    assert "remove a.prom" in done.err
    (place / "prom/a.prom").unlink()
    assert "neither" not in cli("fleet", "status", "--select", "oven", "--prometheus", "prom/c.prom").err


# --- Prometheus ---------------------------------------------------------------------------------------


@pytest.mark.slow  # it looks for its targets every 5 s; the rules themselves are tried by promtool above
@needs("prometheus", "prometheus-node-exporter")
def test_prometheus_alarms_of_a_plc_that_died_after_its_backup(cli: Cli, place: Path, plant: Hall) -> None:
    assert cli("fleet", "backup", "--dir", "backups", "--prometheus", "prom/backup.prom").code == 1
    plant.write(press="", gone='target = "tcp://127.0.0.1:1"\n')
    text = Path("fatek.toml").read_text(encoding="utf-8").replace(plant.targets[0], "tcp://127.0.0.1:1")
    Path("fatek.toml").write_text(text, encoding="utf-8")
    earlier = re.sub(  # the night's run
        r"^(fatek_last_\w+\{.*\}) \d+$",
        lambda line: f"{line[1]} {int(time.time()) - 7200}",
        Path("prom/backup.prom").read_text(encoding="utf-8"),
        flags=re.MULTILINE,
    )
    Path("prom/backup.prom").write_text(earlier, encoding="utf-8")
    cli("fleet", "check", "--no-reference", "--prometheus", "prom/check.prom")
    port = free_port()
    with exporter(place / "prom") as scraped:
        (place / "prometheus.yml").write_text(
            f"global: {{scrape_interval: 100ms, evaluation_interval: 100ms}}\nrule_files: ['{RULES}']\n"
            f"scrape_configs:\n- job_name: node\n  static_configs: [{{targets: ['127.0.0.1:{scraped}']}}]\n"
        )
        words = command(
            "prometheus",
            f"--config.file={place / 'prometheus.yml'}",
            f"--storage.tsdb.path={place / 'tsdb'}",
            f"--web.listen-address=127.0.0.1:{port}",
        )
        with running(words, "ready to receive web requests"):
            down = asked(port, 'ALERTS{alertname="PlcDown"}', at_least=2)
            up = asked(port, 'fatek_up{plc="press"}', at_least=2)
    assert {(each["plc"], each["exported_job"]) for each, _ in down} == {
        ("press", "check"),
        ("gone", "check"),
    }
    assert {each["exported_job"]: value for each, value in up} == {"backup": "1", "check": "0"}


def asked(port: int, query: str, at_least: int) -> list[tuple[dict[str, str], str]]:
    """The answer to a query, when there is one: Prometheus scrapes and judges ten times a second."""
    url = f"http://127.0.0.1:{port}/api/v1/query?{urllib.parse.urlencode({'query': query})}"
    deadline = time.monotonic() + PATIENCE_S
    while True:
        result = json.loads(got(url))["data"]["result"]
        if len(result) >= at_least:
            return [(each["metric"], each["value"][1]) for each in result]
        assert time.monotonic() < deadline, query
        threading.Event().wait(0.05)
