"""The programs of 1000 PLCs over 365 nights, 1 % changing: what a year costs, and whether it grows.

Each night every PLC's backup is recorded, as ``fleet backup --history`` does it: a ``History`` of its own a
night, all PLCs through it, changed or not. A program has 13184 words: 207 pages, a file of 55 kB. A change is
of 1 to 8 words in one or two pages. Then the history is asked, each question in a process of its own, so that
its peak of memory is its own (with as much of the packs as it has looked at: they are mapped, and the
system may take that back); and git is asked the same, where there is git.

The bare loop beside it keeps a compressed file for each PLC and forgets what was before: it reads, inflates
and hashes the old file, and where the program is another it compresses the new one, writes it, syncs it and
its folder. It is done in turns with the history, on the same backups of the same night.

Usage: python bench/history.py [PLCS [NIGHTS]]
"""

from __future__ import annotations

import hashlib
import json
import os
import re
import shutil
import subprocess
import sys
import tempfile
import time
import zlib
from contextlib import closing
from dataclasses import dataclass, field, replace
from itertools import islice
from pathlib import Path
from random import Random
from typing import TYPE_CHECKING

from common import pinned
from figures import figure

from fatektool.files.atomic import sync_folder, write_synced
from fatektool.history.checking import check
from fatektool.history.history import History
from fatektool.program.archive import Backup, Source
from fatektool.program.image import Program
from fatektool.simulator.program.facon_program import demonstration_program

if TYPE_CHECKING:
    from collections.abc import Callable, Iterator

WORDS = 13184
CHANGING = 0.01
BEGAN = 1_767_225_600  # 2026-01-01T00:00:00Z
DAY = 86_400
LIMIT_GROWTH = 1.5
"""The ratio to the bare loop in the last third of the nights, to that in the first."""
_FLAGS = ("running", "battery_low", "ladder_checksum_error", "rom_pack", "watchdog_timeout", "id_set")
_SIZES = ("discrete_inputs", "discrete_outputs", "analog_inputs", "analog_outputs", "m_relays", "s_relays",
          "l_relays", "r_registers", "d_registers", "timers", "counters")  # fmt: skip


def made(number: int) -> Backup:
    """A PLC's first backup."""
    unit = {"code": 1, "name": "MC"}
    system = {"unit_type": unit, "main_unit_points": {"code": 9, "points": None}, "os_version": "3.1"}
    plc = {
        "status": dict.fromkeys((*_FLAGS, "emergency_stop"), False),
        "system": {**system, **dict.fromkeys(_SIZES, 256), "ladder_words": WORDS},
    }
    program = Program(WORDS, tuple(demonstration_program(WORDS, seed=number)))
    source = Source(f"tcp://10.0.{number >> 8}.{number & 255}:500", 1, "facon", None)
    return Backup(program, "2026-01-01T00:00:00Z", "bench", source, plc, 2)


def changed(old: Backup, random: Random, night: int) -> Backup:
    """The same with a few words changed."""
    pages = list(old.program.pages)
    for number in random.sample(range(1, 150), random.choice((1, 2))):
        page = bytearray(pages[number])
        for word in random.sample(range(64), random.randint(1, 4)):
            page[2 * word] ^= random.randint(1, 255)
        pages[number] = bytes(page)
    created = time.strftime("%Y-%m-%dT%H:%M:%SZ", time.gmtime(BEGAN + night * DAY))
    return replace(old, program=Program(WORDS, tuple(pages)), created=created)


@dataclass(slots=True)
class Night:
    """What one night took: seconds and records, of programs that changed and of those that did not."""

    seconds: list[float] = field(default_factory=lambda: [0.0, 0.0])
    records: list[int] = field(default_factory=lambda: [0, 0])
    bare_seconds: list[float] = field(default_factory=lambda: [0.0, 0.0])


class BareLoop:
    """The least that could work: a compressed file a PLC, replaced where the program is another."""

    def __init__(self, folder: Path) -> None:
        self.folder = folder
        folder.mkdir()

    def record(self, name: str, backup: Backup) -> bool:
        """Keep it if it changed."""
        path = self.folder / name
        data = backup.to_bytes()
        try:
            old = zlib.decompress(path.read_bytes())
        except FileNotFoundError:
            old = b""
        hashlib.sha1(old, usedforsecurity=False).digest()
        if _pages(old) == _pages(data):
            return False
        temporary = path.with_suffix(".tmp")
        write_synced(temporary, zlib.compress(data))
        temporary.replace(path)
        sync_folder(self.folder)
        return True


def _pages(data: bytes) -> bytes:
    return data[data.find(b'"sha256"') :]


def nights(folder: Path, plcs: int, count: int) -> Iterator[Night]:
    """Record so many nights; what each took."""
    random = Random(1)  # noqa: S311  # the same year each time
    backups = {f"plc-{number:04}": made(number) for number in range(plcs)}
    bare = BareLoop(folder / "bare")
    for night in range(count):
        if night:
            for name, old in backups.items():
                if random.random() < CHANGING:
                    backups[name] = changed(old, random, night)
        found = Night()
        now = BEGAN + night * DAY
        with History(folder / "history", clock=lambda now=now: now) as history:  # type: ignore[misc]  # read at once
            for name, backup in backups.items():
                began = time.perf_counter()
                new = history.record(name, backup).revision is not None
                ended = time.perf_counter()
                if bare.record(name, backup) != new:
                    raise SystemExit(f"night {night}: {name}: the bare loop saw another thing")
                found.seconds[new] += ended - began
                found.bare_seconds[new] += time.perf_counter() - ended
                found.records[new] += 1
        yield found


def _first_ten(place: Path) -> int:
    with closing(History(place).log()) as changes:
        return sum(1 for _ in islice(changes, 10))


QUESTIONS: dict[str, Callable[[Path], object]] = {
    "log, all": lambda place: sum(1 for _ in History(place).log()),
    "log plc-0000": lambda place: sum(1 for _ in History(place).log("plc-0000")),
    "log -n 10": _first_ten,
    "show plc-0000": lambda place: History(place).show("plc-0000").label,
    "show plc-0000@~1": lambda place: History(place).show("plc-0000", "~1").label,
    "show plc-0000@2026-01-02": lambda place: History(place).show("plc-0000", "2026-01-02").label,
    "diff plc-0000": lambda place: History(place).diff("plc-0000").word_count,
    "check": lambda place: (found := check(place)).commits * (not found.faults),
}
GIT = {
    "log, all": ["log", "--format=%H %ct %s", "--name-status"],
    "log plc-0000": ["log", "--format=%H %ct %s", "--", "plc-0000.json"],
    "show plc-0000": ["log", "-1", "-p", "--format=%H %ct %s", "--", "plc-0000.json"],
    "check": ["fsck", "--full", "--no-progress"],
}


def answer(question: str, place: Path) -> None:
    """One question, in this process: prints seconds, and the process's peak in MB."""
    began = time.perf_counter()
    found = QUESTIONS[question](place)
    took = time.perf_counter() - began
    status = Path(
        "/proc/self/status"
    )  # of this program alone: getrusage's peak is of the one that forked it too
    peak = re.search(r"VmHWM:\s+(\d+)", status.read_text(encoding="ascii")) if status.exists() else None
    print(json.dumps({"seconds": took, "mb": int(peak[1]) / 1024 if peak else 0, "found": found}))


def ask(question: str, place: Path) -> str:
    """A line on one question, to the tool and to git."""
    command = pinned(1, [sys.executable, __file__, "ask", question, str(place)])
    asked = json.loads(subprocess.run(command, stdout=subprocess.PIPE, check=True).stdout)
    line = f"{question:<26} {asked['seconds']:7.2f} s  {asked['mb']:4.0f} MB  {asked['found']!s:<20}"
    words = GIT.get(question)
    if words is None or shutil.which("git") is None:
        return line
    began = time.perf_counter()
    subprocess.run(
        pinned(1, ["/usr/bin/env", "git", "-C", str(place), *words]), stdout=subprocess.DEVNULL, check=True
    )
    git_s = time.perf_counter() - began
    return f"{line} git {git_s:6.2f} s  ratio {asked['seconds'] / git_s:5.2f}"


def size_of(place: Path) -> str:
    """What it takes on disk."""
    loose = [path.stat().st_size for path in place.glob("objects/??/*")]
    packed = [path.stat().st_size for path in place.glob("objects/pack/*")]
    return (
        f"{sum(loose) + sum(packed):,} bytes: {len(loose)} loose objects {sum(loose) / 1e6:.1f} MB, "
        f"{len(packed)} files of packs {sum(packed) / 1e6:.1f} MB"
    )


def report(found: list[Night]) -> float:
    """Lines on the nights; how much dearer a record of the last third is than one of the first, by ratio."""
    rest = found[1:]
    third = max(1, len(rest) // 3)
    groups = {
        "first night": found[:1],
        "all after it": rest,
        "first third": rest[:third],
        "last third": rest[-third:],
    }
    ratios: dict[tuple[str, int], float] = {}
    for name, group in groups.items():
        line = f"{name:<13} {sum(sum(n.seconds) for n in group) / max(1, len(group)):7.2f} s a night "
        for new, word in enumerate(("unchanged", "changed")):
            records = sum(n.records[new] for n in group)
            if records:
                took, bare = sum(n.seconds[new] for n in group), sum(n.bare_seconds[new] for n in group)
                ratios[name, new] = took / bare
                line += (
                    f" {word} {records:6} x {1e3 * took / records:6.2f} ms"
                    f" (bare {1e3 * bare / records:5.2f}, ratio {took / bare:5.2f})"
                )
        print(line)
    both = [new for new in (0, 1) if {("first third", new), ("last third", new)} <= ratios.keys()]
    return max((ratios["last third", new] / ratios["first third", new] for new in both), default=1.0)


def main() -> None:
    """Print a year."""
    if sys.argv[1:2] == ["ask"]:
        answer(sys.argv[2], Path(sys.argv[3]))
        return
    plcs, count = [*map(int, sys.argv[1:3]), *[1000, 365][len(sys.argv) - 1 :]]
    if sys.platform == "linux":
        os.sched_setaffinity(0, [max(os.sched_getaffinity(0))])
    with tempfile.TemporaryDirectory(prefix="fatektool-bench-") as made_folder:
        folder = Path(made_folder)
        found = list(nights(folder, plcs, count))
        place = folder / "history"
        commits = sum(night.records[True] for night in found)
        print(f"{plcs} PLCs, {count} nights, {plcs * count} records, {commits} commits")
        growth = report(found)
        figure("history, a record of the last third to one of the first", growth, limit=LIMIT_GROWTH)
        print(f"a record of the last third to one of the first, by ratio: {growth:.2f}  limit {LIMIT_GROWTH}")
        print(
            f"on disk {size_of(place)}, {sum(p.stat().st_size for p in place.rglob('*')) // commits} a commit"
        )
        for question in QUESTIONS:
            print(ask(question, place))
        if shutil.which("git") is not None:
            began = time.perf_counter()
            subprocess.run(["/usr/bin/env", "git", "-C", str(place), "gc", "--quiet"], check=True)
            print(f"git gc {time.perf_counter() - began:.1f} s, then on disk {size_of(place)}")
            print(ask("check", place))
            print(ask("log plc-0000", place))
    if growth > LIMIT_GROWTH:
        raise SystemExit(1)


if __name__ == "__main__":
    main()
