"""Files that mean harm: endless, deep, of two meanings, with names for a shell, a path or a terminal."""

from __future__ import annotations

import json
import os
import shlex
import subprocess
import sys
from typing import TYPE_CHECKING, Any

import pytest

from fatektool.errors import DataError, LineError
from fatektool.files.strict_json import read_json
from fatektool.files.strict_toml import MOST_PARTS, read_toml
from fatektool.jobs.programs import rewrite
from fatektool.jobs.snapshots.snapshot import parse_snapshot
from fatektool.program.archive import Backup, save_backup
from fatektool.simulator.build import build_simulation
from fatektool.simulator.state import dump_state, parse_state
from tests.cli.running import environment, one_line
from tests.forks.command import PIPE, Forked
from tests.forks.shell import path as shell_path
from tests.guard import GUARD_S
from tests.plant import snapshot_of
from tests.program.samples import backup, document, program
from tests.rows import each

if TYPE_CHECKING:
    from collections.abc import Callable
    from pathlib import Path

    from tests.cli.running import Cli

OLD, NEW = program(64, seed=1), program(64, seed=2)
GIB = 1 << 30
MOST_MEMORY = 700 << 20
PCAP_START = bytes.fromhex("4d3cb2a1 0200 0400 00000000 00000000 ffff0000 93000000")
NAMES = ["../x", "/etc/passwd", "$(touch pwned)", "`touch pwned`", "a; touch pwned", "-rf", "a\nb", "x\0y"]


# --- too much ---------------------------------------------------------------------------------------------

ENDLESS = [
    "inspect endless",
    "verify endless -p sim:",
    "restore endless -p sim: --yes",
    "decode endless",
    "decode endless.pcap",
    "simulate --replay endless.pcap --tcp 127.0.0.1:0",
    "snapshot diff endless endless",
    "snapshot apply endless -p sim: --yes",
    "snapshot --spec endless -p sim:",
    "inventory check --inventory endless",
    "link table check endless",
    "status -p sim:endless",
]


def limited(words: list[str]) -> tuple[int, str, str]:
    """Exit code and streams of a command that may not take more memory than a small computer has."""
    limits = {"RLIMIT_AS": MOST_MEMORY}
    with Forked(words, stdin=subprocess.DEVNULL, stdout=PIPE, stderr=PIPE, limits=limits) as command:
        out, err = command.communicate(timeout=GUARD_S)
    return command.wait(), out, err


@pytest.mark.skipif(sys.platform != "linux", reason="limits of memory are Linux's here")
@pytest.mark.parametrize("words", ENDLESS)
def test_a_file_of_a_gibibyte(words: str, place: Path) -> None:
    """It takes no room on the disk, and neither may it in memory."""
    for name, start in (("endless", b""), ("endless.pcap", PCAP_START)):
        with (place / name).open("wb") as file:
            file.write(start)
            file.truncate(GIB)
    code, out, err = limited(words.split())
    assert code in {2, 5}, err
    assert one_line(err)
    assert not out


DEEP: dict[str, bytes] = {
    "lists": b"[" * 500_000,
    "objects": b'{"a":' * 300_000,
    "closed": b"[" * 200_000 + b"]" * 200_000,
    "digits": b'{"schema": ' + b"9" * 1_000_000 + b"}",
    "toml": b"a = " + b"[" * 200_000,
    "toml tables": b"[" + b"a." * 100_000 + b"a]",
    "toml inline": b"a = " + b"{a = " * 50_000,
    "toml rows": b"[plc.a]\ntags = [\n" + b'"x",\n' * 30_000 + b"]\n",
    "toml keys": b"a.b.c.d.e.f.g.h"
    + b".i = 1\na.b.c.d.e.f.g.h".join(b"%d" % n for n in range(8_000))
    + b" = 1",
}
READERS = [
    "inspect FILE",
    "decode FILE",
    "snapshot diff FILE FILE",
    "snapshot --spec FILE -p sim:",
    "inventory check --inventory FILE",
    "link table check FILE",
    "status -p sim:FILE",
]


@pytest.mark.parametrize("words", READERS)
@pytest.mark.parametrize("name", DEEP)
def test_a_deep_file(words: str, name: str, place: Path, cli: Cli) -> None:
    (place / "FILE").write_bytes(DEEP[name])
    done = cli(*words.split())  # what takes for ever meets the guard of pytest
    assert done.code in {2, 5} or (done.code == 1 and words.startswith("inventory")), done
    assert "Traceback" not in done.err


# --- two meanings -----------------------------------------------------------------------------------------


def state() -> dict[str, Any]:
    found: dict[str, Any] = json.loads(dump_state(build_simulation(ladder_words=64).plcs.values()))
    return found


FILES: dict[str, tuple[dict[str, Any], Callable[[bytes], object]]] = {
    "backup": (document(OLD), lambda data: Backup.parse(data, "FILE")),
    "snapshot": (
        snapshot_of("R0-R1", "X3").document(),
        lambda data: parse_snapshot(data, "FILE"),
    ),
    "state": (state(), lambda data: parse_state(data, "FILE")),
}
NO_NUMBERS = ["NaN", "Infinity", "-Infinity", "1e999", "-1e999", "1" * 5000, "1.5", "true", '"1"', "-1"]


def keys_of(value: Any, at: tuple[Any, ...] = ()) -> list[tuple[Any, ...]]:
    """Where keys stand in a document, at any depth."""
    parts = value.items() if isinstance(value, dict) else enumerate(value) if isinstance(value, list) else []
    own = [(*at, key) for key in value] if isinstance(value, dict) else []
    return own + [path for key, part in parts for path in keys_of(part, (*at, key))]


@pytest.mark.parametrize("name", FILES)
def test_a_key_that_stands_twice_is_refused_wherever_it_stands(name: str) -> None:
    good, read = FILES[name]
    read(json.dumps(good).encode())
    paths = [path for path in keys_of(good) if path[0] != "pages"]
    assert len(paths) > 5
    for path in paths:
        twin = json.loads(json.dumps(good))
        part = twin
        for key in path[:-1]:
            part = part[key]
        part["TWIN"] = part[path[-1]]
        text = json.dumps(twin)
        assert text.count('"TWIN"') == 1
        with pytest.raises(DataError):
            read(text.replace('"TWIN"', json.dumps(path[-1])).encode())


@each("name", FILES)
@each("value", NO_NUMBERS)
def test_no_number_is_taken_for_one(name: str, value: str) -> None:
    good, read = FILES[name]
    keys = {"backup": "passes", "snapshot": "station", "state": "ladder_words"}
    spoiled = json.loads(json.dumps(good))
    part = spoiled["plcs"][0] if name == "state" else spoiled
    part[keys[name]] = "HERE"
    with pytest.raises(DataError):
        read(json.dumps(spoiled).replace('"HERE"', value).encode())


@pytest.mark.parametrize("name", FILES)
@pytest.mark.parametrize("damage", [b"\xff", b"\xc3", b"\xed\xa0\x80", b"\xc0\xaf", b"\x00"])
def test_what_is_no_utf_8_is_refused(name: str, damage: bytes) -> None:
    good, read = FILES[name]
    data = json.dumps(good).encode()
    for at in (0, len(data) // 2, len(data)):
        with pytest.raises(DataError):
            read(data[:at] + damage + data[at:])


@pytest.mark.parametrize(
    "text", ['{"a": 1, "a": 2}', '{"b": {"a": 1, "\\u0061": 1}}', "[NaN]", "[-Infinity]"]
)
def test_json_that_says_two_things(text: str) -> None:
    with pytest.raises(ValueError, match=r"occurs twice|is not JSON"):
        read_json(text.encode())


@pytest.mark.parametrize("part", ["a", '"a b"', "'a.b'", "a-1"])
@pytest.mark.parametrize("dot", [".", " . "])
def test_a_key_of_too_many_parts_is_refused_and_one_less_is_not(part: str, dot: str) -> None:
    for parts in (1, MOST_PARTS):
        found = read_toml(f"{dot.join([part] * parts)} = 1")
        assert len(found) == 1
    with pytest.raises(ValueError, match=rf"^a key of more than {MOST_PARTS} parts$"):
        read_toml(f"b = 2\n{dot.join([part] * (MOST_PARTS + 1))} = 1")


def test_toml_that_is_too_deep() -> None:
    with pytest.raises(ValueError, match=r"^too deep$"):
        read_toml("a = " + "[" * 50_000)


# --- names ------------------------------------------------------------------------------------------------


def folder_of(place: Path) -> dict[str, bytes]:
    """All that lies in the folder above the working one, to see what appears."""
    return {
        str(path.relative_to(place.parent)): path.read_bytes()
        for path in place.parent.rglob("*")
        if path.is_file() and "locks" not in path.parts
    }


@pytest.mark.parametrize("name", NAMES)
def test_a_name_in_a_specification_makes_no_path_and_no_command(name: str, place: Path, cli: Cli) -> None:
    (place / "out").mkdir()
    spec = place / "press.toml"
    spec.write_text(f'[[item]]\nelement = "R0"\nname = {json.dumps(name)}\nunit = {json.dumps(name)}\n')
    before = folder_of(place)
    for form in ("json", "csv", "influx", "prometheus", "ndjson"):
        done = cli("snapshot", "--spec", spec, "-p", "sim:", "-o", "out/", "--format", form)
        plain = name.isprintable()
        assert (done.code == 0) == plain, done
        if not plain:
            assert done.code == 5
            assert one_line(done.err)
    made = sorted(set(folder_of(place)) - set(before))
    assert all(path.startswith("work/out/snapshot-st01-") for path in made)
    assert len(made) == 5 * name.isprintable()


@pytest.mark.parametrize("name", NAMES)
def test_a_name_in_an_inventory_is_refused_unless_it_can_be_a_file(name: str, place: Path, cli: Cli) -> None:
    (place / "fatek.toml").write_text(f'[plc.{json.dumps(name)}]\ntarget = "sim:"\n')
    before = folder_of(place)
    assert cli("inventory", "check").code in {1, 5}
    done = cli("fleet", "backup", "--into", "out", "-q")
    assert done.code in {2, 5}, done
    assert folder_of(place) == before


@pytest.mark.parametrize(
    "name", ["$(touch pwned).json", "a; touch pwned.json", 'it\'s "mine".json', "-x.json"]
)
def test_the_command_that_goes_on_names_the_file_as_one_word(
    name: str, place: Path, cli: Cli, monkeypatch: pytest.MonkeyPatch
) -> None:
    """It is there to be copied into a shell."""
    save_backup(backup(NEW), place / name)
    build_simulation(ladder_words=64, program=OLD.pages, state=place / "plc.state").save_if_changed()

    def fail(*_: object) -> None:
        raise LineError("the line broke")

    with monkeypatch.context() as broken:
        broken.setattr(rewrite.Rewrite, "_prove", fail)
        done = cli("restore", f"./{name}", "-p", f"sim:{place / 'plc.state'}", "--yes", "--json")
    assert done.code == 6, done
    command = done.document("error")["error"]["details"]["command"]
    assert f"./{name}" in shlex.split(command)
    finished = subprocess.run(
        ["bash", "-c", command],
        stdin=subprocess.DEVNULL,
        capture_output=True,
        check=False,
        env=environment(PATH=shell_path()),
    )
    assert finished.returncode == 0, finished
    assert not (place / "pwned").exists()
    assert not list(place.glob("pwned*"))


ESCAPES = "\x1b]0;owned\x07\x1b[2J\x9b31m\u202e"


def test_nothing_in_a_file_reaches_the_terminal_as_an_order(place: Path, cli: Cli) -> None:
    spoiled = document(OLD) | {"tool": f"evil {ESCAPES}"}
    spoiled["source"]["target"] = f"/dev/{ESCAPES}"
    (place / "a.json").write_text(json.dumps(spoiled))
    shown = cli("inspect", "a.json")
    assert shown.code == 0
    assert "\\x1b]0;owned\\x07" in shown.out
    bad = place / f"{ESCAPES}.json"
    bad.write_text("{")
    refused = cli("inspect", bad)
    assert refused.code == 5
    spec = place / "s.toml"
    spec.write_text('"\\u001b[2J" = 1\n')
    for done in (shown, refused, cli("snapshot", "--spec", spec, "-p", "sim:")):
        assert not set(done.out + done.err) & set(ESCAPES) - set("]0;owned[2J31m")
        assert (done.out + done.err).replace("\n", "").isprintable()


def test_the_folder_of_a_hostile_name_is_not_left(place: Path, cli: Cli) -> None:
    """What is named by the user may be anywhere; what is named by a file's content may not."""
    spoiled = document(OLD)
    spoiled["source"]["target"] = "../../" * 8 + "etc/cron.d/x"
    (place / "a.json").write_text(json.dumps(spoiled))
    before = folder_of(place)
    assert cli("inspect", "a.json").code == 0
    assert cli("verify", "a.json", "-p", "sim:").code in {1, 5}
    assert folder_of(place) == before
    assert not os.path.lexists(place.parent / "etc")
