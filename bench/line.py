"""How much of the line does each job use? Against a bare loop, on a pty paced to a baud rate.

The bare loop sends what the job cannot do without, in a process of its own: see ``exchanges``. *transfer* is
from the first request to the last answer, *process* the whole command with Python's start. *wire* is the
bare loop's bytes at this baud.

Usage: python bench/line.py [BAUD …]
"""

from __future__ import annotations

import sys
import tempfile
from dataclasses import replace
from pathlib import Path

import exchanges
from common import Timing, bare, best, row, simulator, tool
from figures import figure

sys.path.insert(0, str(Path(__file__).parent.parent))

from fatektool.program.archive import Backup, load_backup
from fatektool.program.image import Program

LIMITS = {9600: 1.01, 38400: 1.01, 115200: 1.01, 921600: 1.03}
WORDS = {9600: 4096, 38400: 8192, 115200: 13184, 921600: 65535}
RUNS = {921600: 4, 115200: 2}
BITS = 10  # 7E1
CHANGED = 10  # one page in so many
NIGHT_BAUD = 9600
NIGHT_PAGES = 207


class Bench:
    """One simulated PLC on a paced pty, and the programs that are written into it in turn.

    Args:
        target: the pty.
        baud: its pace.
        first: the program that it holds.
        second: another.
        folder: for files.
    """

    def __init__(self, target: str, baud: int, first: Backup, second: Backup, folder: Path) -> None:
        self.target = target
        self.baud = baud
        self.old = first.program.pages
        self.new = second.program.pages
        some = [new if number % CHANGED == 1 else old for number, (old, new) in enumerate(self._pairs())]
        one = (self.old[0], self.new[1], *self.old[2:])
        programs = {"old": self.old, "new": self.new, "some": tuple(some), "one": one}
        self.files = {name: str(folder / f"{name}.json") for name in programs}
        for name, pages in programs.items():
            changed = replace(first, program=Program(first.program.ladder_words, pages))
            Path(self.files[name]).write_bytes(changed.to_bytes())
        self.folder = folder
        self.backup = str(folder / "backup.json")
        self.snapshot = str(folder / "snapshot.json")

    def _pairs(self) -> list[tuple[bytes, bytes]]:
        return list(zip(self.old, self.new, strict=True))

    def jobs(self) -> dict[str, tuple[list[str], list[exchanges.Exchange]]]:
        """By name: the tool's words, and the bare loop's exchanges, which leave the first program."""
        pages = len(self.old)
        every = list(enumerate(self.old))
        differ = [number for number, (old, new) in enumerate(self._pairs()) if old != new]
        some = [(number, self.old[number]) for number in differ if number % CHANGED == 1]
        restore = ["restore", "--yes"]
        return {
            "backup, first": (["backup", self.backup], exchanges.backup(pages)),
            "backup, unchanged": (["backup", self.backup, "--force"], exchanges.known(pages, [])),
            "backup, one page changed": (
                ["backup", self.backup, "--known", self.files["one"], "--force"],
                exchanges.known(pages, [1]),
            ),
            "verify": (["verify", self.files["old"]], exchanges.verify(pages)),
            "restore": ([*restore, self.files["new"]], exchanges.restore(pages, differ, every)),
            "restore --changed-only": (
                [*restore, "--changed-only", self.files["some"]],
                exchanges.restore(pages, [number for number, _ in some], some),
            ),
            "snapshot --all": (["snapshot", "--all", "-o", self.snapshot, "--force"], exchanges.snapshot()),
        }

    def rows(self) -> None:
        """Print a row a job."""
        limit = LIMITS.get(self.baud, 1.03)
        for name, (words, todo) in self.jobs().items():
            bares: list[Timing] = []
            tools: list[Timing] = []
            for _ in range(RUNS.get(self.baud, 1)):
                if name == "backup, first":
                    Path(self.backup).unlink(missing_ok=True)
                for copy in self.folder.glob("*safety*"):  # pages that it has would be read once
                    copy.unlink()
                tools.append(tool(*words, "-p", self.target, "--baud", str(self.baud)))
                bares.append(bare(self.target, todo))
            wire_s = exchanges.wire_bytes(todo) * BITS / self.baud
            print(row(f"{self.baud} {name}", best(tools), best(bares), limit, wire_s), flush=True)
            if self.baud == NIGHT_BAUD and name.startswith("backup"):
                night = best(tools).transfer_s * NIGHT_PAGES / len(self.old)
                print(f"a night of {NIGHT_PAGES} pages at {self.baud} baud, {name}: {night:.0f} s")
                figure(f"{name}, {NIGHT_PAGES} pages at {self.baud} baud", night, "s")


def program(words: int, seed: int, folder: Path) -> Backup:
    """A program of this size, as a backup over TCP."""
    options = ["--tcp", "127.0.0.1:0", "--ladder-words", str(words), "--program-seed", str(seed)]
    file = folder / f"seed-{seed}.json"
    with simulator(*options) as target:
        tool("backup", str(file), "-p", target)
    return load_backup(file)


def main() -> None:
    """Print a row a baud rate and job."""
    for baud in [int(word) for word in sys.argv[1:]] or sorted(LIMITS):
        words = WORDS.get(baud, 8192)
        with tempfile.TemporaryDirectory() as name:
            folder = Path(name)
            first, second = program(words, 1, folder), program(words, 2, folder)
            options = ["--baud", str(baud), "--ladder-words", str(words), "--program-seed", "1"]
            with simulator("--pty", str(folder / "plc"), *options) as target:
                print(f"{baud} 7E1, {len(first.program.pages)} pages")
                Bench(target, baud, first, second, folder).rows()


if __name__ == "__main__":
    main()
