"""No option is dropped in silence: in every combination it works, or is refused.

Each option of each command stands in one of the tables, so that a new one is thought about: which other
leaves it without effect? Options that only permit (``--force``, ``--yes``) or describe the line need nothing
to act on.
"""

from __future__ import annotations

import json
from pathlib import Path
from typing import TYPE_CHECKING

import click
import pytest

from fatektool.cli.app import app
from tests.rows import each

if TYPE_CHECKING:
    from collections.abc import Iterator

    from tests.cli.running import Cli, Press

LINE = (
    "--port --inventory --station --protocol --baud --line --format --timeout --retries --lock-wait "
    "--low-latency --trace --read-only"
)
VOICE = "--json --quiet --verbose"
FREE = {
    "backup": "--data --single-pass --known --any-header --raw",
    "verify": "--data --comments --report --force",
    "restore": "--data --stop --run --changed-only --dry-run --single-pass --any-header --yes",
    "inspect": "--raw",
    "diff": "--comments --report --force",
    "listing": "--network --words --comments --report --force",
    "xref": "--comments",
    "monitor": "--comments --why --network --interval --count",
    "status": "--brief",
    "run": "--broadcast --yes",
    "stop": "--broadcast --yes",
    "read": "--comments --modbus-map",
    "write": "--broadcast --yes --modbus-map",
    "snapshot apply": "--only --dry-run --yes --modbus-map",
    "snapshot diff": "--ignore --tolerance",
    "snapshot take": "--output --comments --force --modbus-map",
    "watch": "--comments --interval --count --report --force --modbus-map",
    "discrete disable": "--broadcast --yes --modbus-map",
    "discrete enable": "--broadcast --yes --modbus-map",
    "discrete reset": "--broadcast --yes --modbus-map",
    "discrete set": "--broadcast --yes --modbus-map",
    "discrete list": "--modbus-map",
    "loopback": "--count --duration --sizes --pattern --interval --max-error-rate --max-p99 --report --force",
    "scan": "--stations",
    "link table save": "--kind --force",
    "link table show": "--kind --check",
    "link table write": "--dry-run --force --yes",
    "link result": "--kind --check",
    "link modem set": "--number --modem-on --pulse --auto-answer --dial-control --profile --dry-run --yes",
    "encode": "--as --error --data --number --protocol --station",
    "decode": "--protocol",
    "modbus map": "--modbus-map",
    "fleet backup": "--data --news --dir --history --single-pass --any-header --on-change --prometheus "
    "--on-failure --select --jobs --deadline",
    "fleet check": "--prometheus --on-failure --select --jobs --deadline",
    "fleet snapshot": "--news --dir --keep --prometheus --on-failure --select --jobs --deadline",
    "fleet status": "--news --brief --prometheus --on-failure --select --jobs --deadline",
    "fleet verify": "--news --on-change --prometheus --on-failure --select --jobs --deadline",
    "inventory add": "--tag",
    "inventory list": "--select",
    "history diff": "--report --force --history",
    "history check": "--history",
    "history export": "--history",
    "history log": "--limit --history",
    "history record": "--push --history --lock-wait",
    "history show": "--history",
    "check": "--expect --backup --deadline --prometheus --on-failure",
    "simulate": "--discovery --tcp --udp --pty --model --protocol --station --state --set --memory --scan-ms "
    "--fault "
    "--replay --latency-timer --no-program-commands",
}
"""What has an effect whatever stands beside it."""

SNAPSHOT = "snapshot take R0 -p sim:"
SIMULATE = "simulate --tcp 0"
APART = [
    ("restore old.json -p sim:", "--no-safety-backup", "--safety-dir ."),
    ("restore old.json -p sim:", "--no-safety-backup", "--rollback"),
    ("snapshot apply s.json -p sim:", "--no-safety-snapshot", "--safety-dir ."),
    ("snapshot apply s.json -p sim:", "--no-safety-snapshot", "--rollback"),
    ("link table write t.toml R0 -p sim:", "--no-safety-snapshot", "--safety-dir ."),
    ("link table write t.toml R0 -p sim:", "--no-safety-snapshot", "--rollback"),
    ("link modem set -p sim:", "--no-safety-snapshot", "--safety-dir ."),
    ("link modem set -p sim:", "--no-safety-snapshot", "--rollback"),
    (SNAPSHOT, "--json", "--format csv"),
    (SNAPSHOT, "--json", "--format ndjson"),
    (SNAPSHOT, "--json -o -", "--format influx"),
    (SNAPSHOT, "--append x.ndjson", "--format csv"),
    (SNAPSHOT, "--append x.ndjson", "--format json"),
    (SNAPSHOT, "--format csv", "--format influx"),
    (SNAPSHOT, "--spec a.toml", ""),
    (SNAPSHOT, "--all", ""),
    ("watch R0 -p sim:", "--spec a.toml", ""),
    ("loopback -p sim:", "--raw 02,03", "--station 2"),
    ("loopback -p sim:", "--raw 02,03", "--protocol mseries"),
    ("listing old.json", "--ladder", "--words"),
    ("listing old.json", "--ladder", "--json"),
    ("monitor old.json -p sim:", "--why Y0", "--network 0"),
    ("monitor old.json -p sim:", "--why Y0", "--interval 1"),
    ("monitor old.json -p sim:", "--why Y0", "--count 1"),
    ("scan -p sim:", "--baud 9600", "--bauds 9600"),
    ("scan", "--network 127.0.0.1", "--port sim:"),
    ("scan", "--network 127.0.0.1", "--stations 1-3"),
    ("scan", "--network 127.0.0.1", "--bauds 9600"),
    ("scan", "--network 127.0.0.1", "--trace x.pcap"),
    ("scan -p sim:", "--line 7E1", "--formats 7E1"),
    ("scan -p sim:", "--format 7E1", "--formats 7E1"),
    ("status -p sim:", "--line 7E1", "--format 7E1"),
    ("scan -p sim:", "--protocol facon", "--protocols facon"),
    ("check -p sim:", "--reference old.json", "--no-reference"),
    ("fleet check", "--no-reference", "--on-change true"),
    ("inventory add x", "--from scan.json", "--port sim:"),
    ("inventory add x", "--from scan.json", "--station 2"),
    ("inventory add x", "--from scan.json", "--protocol facon"),
    ("inventory add x", "--from scan.json", "--baud 9600"),
    ("inventory add x", "--from scan.json", "--format 7E1"),
    (SIMULATE, "--program old.json", "--program-seed 2"),
    (SIMULATE, "--program old.json", "--swap-program"),
    (SIMULATE, "--replay x.pcap", "--ladder-words 400"),
]
"""One of the two would be without effect; each alone is taken by this check."""

ALONE = [
    ("backup - -p sim:", "--force"),
    ("backup x.json -p sim: --single-pass", "--known old.json"),
    ("inspect old.json", "--force"),
    ("restore old.json -p sim:", "--system"),
    ("verify old.json -p sim:", "--ignore R0"),
    ("diff old.json old.json", "--ignore R0"),
    ("history export x - --history h", "--force"),
    ("decode x.ndjson", "--as request"),
    (SNAPSHOT, "--group x"),
    ("watch R0 -p sim:", "--group x"),
    (SNAPSHOT, "--keep 3"),
    (SNAPSHOT + " -o . --format csv", "--report r.html"),
    (SNAPSHOT, "--append x.csv"),
    (SNAPSHOT, "--append x.prom"),
    ("loopback -p sim: --pattern ones", "--seed 2"),
    ("scan -p sim:", "--station 2"),
    ("check -p sim:", "--max-age 1d"),
    ("inspect old.json", "--encoding cp1250"),
    ("diff old.json old.json", "--encoding cp1250"),
    ("listing old.json", "--encoding cp1250"),
    ("xref old.json", "--encoding cp1250"),
    ("verify old.json -p sim:", "--encoding cp1250"),
    ("monitor old.json -p sim:", "--encoding cp1250"),
    ("read R0 -p sim:", "--encoding cp1250"),
    ("watch R0 -p sim:", "--encoding cp1250"),
    (SNAPSHOT, "--encoding cp1250"),
    ("check -p sim:", "--on-change true"),
    ("fleet check", "--max-age 1d"),
    ("fleet check --max-age 1d", "--backups"),
    ("fleet backup --dir .", "--push x"),
    (SIMULATE, "--strict-baud"),
    (SIMULATE, "--baud 9600 --strict-baud"),
    (SIMULATE, "--replay-speed 2"),
    (SIMULATE, "--format 7E1"),
    (SIMULATE, "--line 7E1"),
    (SIMULATE, "--seed 3"),
    (SIMULATE + " --protocol mseries", "--no-error-character"),
]
"""Without what gives it an effect."""


def commands() -> Iterator[tuple[str, click.Command]]:
    def below(command: click.Command, words: list[str]) -> Iterator[tuple[str, click.Command]]:
        if isinstance(command, click.Group):
            context = click.Context(command)
            for name in command.list_commands(context):
                found = command.get_command(context, name)
                assert found is not None
                yield from below(found, [*words, name])
        else:
            yield " ".join(words), command

    return below(app, [])


def options(command: click.Command) -> set[str]:
    found = [option for option in command.params if isinstance(option, click.Option)]
    return {max(option.opts, key=len) for option in found}


@each(("name", "command"), list(commands()), ids=str)
def test_each_option_is_thought_about(name: str, command: click.Command) -> None:
    words = " ".join([
        FREE.get(name, ""),
        *(f"{start} {one} {other}" for start, one, other in APART if start.startswith(name)),
        *(f"{start} {one}" for start, one in ALONE if start.startswith(name)),
    ])  # fmt: skip
    known = {word.replace("-o", "--output") if word == "-o" else word for word in words.split()}
    shared = {*VOICE.split(), *(LINE.split() if "--port" in options(command) else ["--inventory"])}
    assert options(command) - known - shared == set()


@pytest.fixture
def files(press: Press, place: Path) -> Path:
    assert press.old.exists()
    (place / "x.ndjson").write_text(
        '{"time": "2026-11-22T03:15:00.1Z", "protocol": "facon", "direction": "tx", '
        '"hex": "0230313430433703"}\n'
    )
    (place / "fatek.toml").write_text('[plc.x]\ntarget = "sim:"\n')
    return place


@each(("start", "one", "other"), APART)
def test_options_that_would_leave_each_other_without_effect(
    cli: Cli, files: Path, start: str, one: str, other: str
) -> None:
    before = sorted(files.rglob("*"))
    done = cli(*start.split(), *one.split(), *other.split())
    assert done.code == (3 if "check" in start else 2), done
    said = done.out + done.err
    for option in (one, other):
        assert not option or option.split()[0] in said, said
    assert sorted(files.rglob("*")) == before


@each(("start", "one"), ALONE)
def test_an_option_without_what_gives_it_an_effect(cli: Cli, files: Path, start: str, one: str) -> None:
    before = sorted(files.rglob("*"))
    done = cli(*start.split(), *one.split())
    assert done.code == (3 if "check" in start else 2), done
    assert one.rsplit("--", 1)[-1].split(maxsplit=1)[0] in done.out + done.err
    assert sorted(files.rglob("*")) == before


@pytest.mark.parametrize(
    ("words", "file", "start"),
    [
        ("-o x.csv", "x.csv", "time,"),
        ("-o x.ndjson", "x.ndjson", '{"schema":"fatektool.snapshot/'),
        ("-o x.json", "x.json", '{\n  "schema"'),
        ("-o x.txt", "x.txt", '{\n  "schema"'),
        ("-o x.prom", "x.prom", "# HELP"),
        ("-o x.CSV --json", "x.CSV", "time,"),
        ("-o x.csv --format json", "x.csv", '{\n  "schema"'),
        ("-o x.txt --format csv --append y.ndjson", "x.txt", "time,"),
        ("--append x.log --format ndjson --json", "x.log", '{"schema":"fatektool.snapshot/'),
        ("-o - --append x.log", "x.log", '{"schema":"fatektool.snapshot/'),
        ("-o - --append x.log --format csv", "x.log", '{"schema":"fatektool.snapshot/'),
    ],
)
def test_what_a_snapshot_is_written_as(cli: Cli, place: Path, words: str, file: str, start: str) -> None:
    """As ``--format`` says, else as the name does; and all that was asked for is done."""
    done = cli("snapshot", "R0", "-p", "sim:", *words.split())
    assert done.code == 0, done
    assert (place / file).read_text().startswith(start)
    if "--json" in words:
        assert done.document("snapshot")["values"] == {"R0": 0}
    elif "-o -" in words:
        assert done.out.startswith("time," if "csv" in words else '{\n  "schema"')
        assert "csv" in words or json.loads(done.out)["values"] == {"R0": 0}
    else:
        assert done.out == ""
    assert ("y.ndjson" in words) == Path("y.ndjson").exists()
