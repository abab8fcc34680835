"""What does starting cost? ``fatektool --version`` beside ``import click``, its largest part.

Usage: python bench/start.py
"""

from __future__ import annotations

import subprocess
import sys
import time

RUNS = 25
LIMIT = 1.4


def least(command: list[str]) -> float:
    """Seconds of the fastest of several runs."""
    took = []
    for _ in range(RUNS):
        began = time.perf_counter()
        subprocess.run(command, stdout=subprocess.DEVNULL, check=True)
        took.append(time.perf_counter() - began)
    return min(took)


def main() -> None:
    """Print one row."""
    bare = least([sys.executable, "-c", "import click"])
    tool = least([sys.executable, "-m", "fatektool", "--version"])
    ratio = tool / bare
    times = f"click {bare * 1000:.1f} ms  tool {tool * 1000:.1f} ms"
    print(f"--version              {times}  ratio {ratio:.3f}  limit {LIMIT}")


if __name__ == "__main__":
    main()
