"""What a restore costs: its time on a paced line as the sum of its parts.

The wire is recorded by ``--trace``; each exchange lasts from its request to the next one. 4F before the first
50 is the program that was in the PLC, 4F after it the read-back. *least* is the part's bytes at this baud,
*between* the rest: the safety backup on its way to the disk, and the tool's own work.

Usage: python bench/restore.py [BAUD …]
"""

from __future__ import annotations

import json
import sys
import tempfile
from collections import defaultdict
from datetime import datetime
from itertools import pairwise
from pathlib import Path
from typing import NamedTuple

from common import simulator, tool
from figures import figure

WORDS = {9600: 4096, 38400: 8192, 115200: 13184, 921600: 65535}
BITS = 10  # 7E1
LIMIT = {9600: 1.02, 38400: 1.02, 115200: 1.02, 921600: 1.05}
COMMANDS = {"40": "status", "53": "status", "4E": "fences", "4F": "read", "50": "write", "41": "STOP and RUN"}


class Part(NamedTuple):
    """A part of a restore: exchanges, bytes both ways, seconds."""

    exchanges: int = 0
    size: int = 0
    seconds: float = 0.0

    def plus(self, size: int, seconds: float) -> Part:
        """With one more exchange."""
        return Part(self.exchanges + 1, self.size + size, self.seconds + seconds)


def parts(trace: Path) -> dict[str, Part]:
    """The parts by name, in the order of their beginning."""
    records = [json.loads(line) for line in trace.read_text(encoding="utf-8").splitlines()]
    asked: list[tuple[float, str, int]] = []
    for record in records:
        data = bytes.fromhex(record["hex"])
        if record["direction"] == "tx":
            when = datetime.fromisoformat(record["time"]).timestamp()
            asked.append((when, data[3:5].decode(), len(data)))
        elif asked:
            when, command, size = asked[-1]
            asked[-1] = (when, command, size + len(data))
    end = datetime.fromisoformat(records[-1]["time"]).timestamp()
    found: dict[str, Part] = defaultdict(Part)
    written = False
    for (when, command, size), (then, _, _) in pairwise([*asked, (end, "", 0)]):
        written |= command == "50"
        name = COMMANDS.get(command, command)
        if name == "read":
            name = "read back" if written else "read the present program"
        found[name] = found[name].plus(size, then - when)
    return found


def show(baud: int, trace: Path, took_s: float, kind: str) -> None:
    """Print a row a part."""
    total_least = 0.0
    rest = took_s
    for name, part in parts(trace).items():
        least = part.size * BITS / baud
        total_least += least
        rest -= part.seconds
        print(
            f"{baud:>6} {kind:<15} {name:<26} {part.exchanges:>5} exchanges {part.size:>8} bytes  "
            f"least {least:8.3f} s  took {part.seconds:8.3f} s"
        )
        figure(f"{baud} {kind}: {name}", part.seconds, "s")
    print(f"{baud:>6} {kind:<15} {'between':<26} {'':>31}  {'':>16}  took {rest:8.3f} s")
    ratio = took_s / total_least
    limit = LIMIT.get(baud, 1.05)
    print(
        f"{baud:>6} {kind:<15} {'whole':<26} {'':>31}  "
        f"least {total_least:8.3f} s  took {took_s:8.3f} s  ratio {ratio:.3f}"
    )
    figure(f"{baud} {kind}: whole, to its bytes", ratio, limit=limit)


def main() -> None:
    """Restore another program, then the same again, at each speed."""
    for baud in [int(word) for word in sys.argv[1:]] or sorted(WORDS):
        words = str(WORDS.get(baud, 8192))
        with tempfile.TemporaryDirectory() as name:
            folder = Path(name)
            file = folder / "new.json"
            with simulator("--tcp", "127.0.0.1:0", "--ladder-words", words, "--program-seed", "2") as target:
                tool("backup", str(file), "-p", target)
            with simulator(
                "--pty", str(folder / "plc"), "--baud", str(baud), "--ladder-words", words
            ) as target:
                for kind in ("all pages", "same again"):
                    trace = folder / f"{kind.replace(' ', '-')}.ndjson"
                    words_of = ["restore", str(file), "--yes", "-p", target, "--baud", str(baud)]
                    took = tool(*words_of, "--trace", str(trace))
                    show(baud, trace, took.transfer_s, kind)


if __name__ == "__main__":
    main()
