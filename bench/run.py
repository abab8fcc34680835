"""All figures of all benches, as one table with their limits.

Usage: python bench/run.py [--quick] [--markdown] [BENCH …]

``--quick`` measures less: small programs, few runs, no year of nights; minutes instead of hours. What a bench
prints for people goes to standard error, the table to standard output. Exit code 1 if a figure is over its
limit.
"""

from __future__ import annotations

import argparse
import os
import platform
import subprocess
import sys
import tempfile
import time
from pathlib import Path
from typing import TYPE_CHECKING, NamedTuple

from figures import FILE, noted

if TYPE_CHECKING:
    from figures import Figure

HERE = Path(__file__).parent


class Bench(NamedTuple):
    """A script, and what follows its name in a quick run and in a whole one."""

    quick: tuple[str, ...] = ()
    whole: tuple[str, ...] = ()


BENCHES = {
    "line": Bench(("921600",)),
    "restore": Bench(("921600",)),
    "tcp": Bench(),
    "processor": Bench(),
    "start": Bench(("10",)),
    "latency": Bench(("115200",)),
    "planner": Bench(),
    "ladder": Bench(),
    "crc": Bench(),
    "lrc": Bench(("20000",)),
    "fleet": Bench(("1", "10", "100")),
    "history": Bench(("20", "30")),
    "simulator": Bench(("0.2",)),
}


def figures_of(name: str, words: tuple[str, ...]) -> tuple[list[Figure], int]:
    """Run one bench; its figures, and its exit code."""
    with tempfile.TemporaryDirectory() as folder:
        place = Path(folder) / "figures"
        command = [sys.executable, str(HERE / f"{name}.py"), *words]
        done = subprocess.run(command, stdout=sys.stderr, env=os.environ | {FILE: str(place)}, check=False)
        return noted(place), done.returncode


def row(cells: tuple[str, ...], *, markdown: bool) -> str:
    """One line of the table."""
    if markdown:
        return f"| {' | '.join(cells)} |"
    bench, name, value, limit, verdict = cells
    return f"{bench:<10} {name:<52} {value:>20}  {limit:>8}  {verdict}".rstrip()


def main() -> int:
    """Print the table."""
    parser = argparse.ArgumentParser()
    parser.add_argument("--quick", action="store_true")
    parser.add_argument("--markdown", action="store_true")
    parser.add_argument("benches", nargs="*", metavar="BENCH", choices=[*BENCHES, []])
    wanted = parser.parse_args()
    began = time.perf_counter()
    print(row(("bench", "figure", "value", "limit", ""), markdown=wanted.markdown))
    if wanted.markdown:
        print("| --- | --- | --- | --- | --- |")
    bad = False
    for name in wanted.benches or BENCHES:
        found, code = figures_of(name, BENCHES[name].quick if wanted.quick else BENCHES[name].whole)
        bad |= code != 0 or not all(each.kept for each in found)
        for each in found:
            limit = "" if each.limit is None else f"{each.limit:g}"
            value = f"{each.value:.3f}" if each.unit == "ratio" else f"{each.value:.4g} {each.unit}"
            verdict = "" if each.limit is None else "kept" if each.kept else "OVER"
            print(row((name, each.name, value, limit, verdict), markdown=wanted.markdown), flush=True)
        if not found:
            print(
                row((name, "no figure", f"exit code {code}", "", "FAILED"), markdown=wanted.markdown),
                flush=True,
            )
    cores = os.cpu_count()
    took = (time.perf_counter() - began) / 60
    machine = f"{platform.system()} {platform.machine()}, {cores} cores"
    print(f"\n{machine}, Python {platform.python_version()}, {took:.0f} min")
    return 1 if bad else 0


if __name__ == "__main__":
    sys.exit(main())
