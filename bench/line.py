"""How much of the line does a backup use? Against a bare loop, on a pty paced to a baud rate.

Usage: python bench/line.py [BAUD …]
"""

from __future__ import annotations

import sys
import tempfile
from pathlib import Path

from common import bare, best, row, simulator, tool

LIMITS = {9600: 1.02, 38400: 1.02, 115200: 1.02, 921600: 1.05}
WORDS = {9600: 2048, 38400: 8192, 115200: 13184, 921600: 65535}
RUNS = 3


def main() -> None:
    """Print a row a baud rate."""
    for baud in [int(word) for word in sys.argv[1:]] or [38400, 115200, 921600]:
        words = WORDS.get(baud, 8192)
        pages = 1 + -(-words // 64)
        with tempfile.TemporaryDirectory() as folder:
            link = str(Path(folder) / "plc")
            options = ["--pty", link, "--baud", str(baud), "--ladder-words", str(words)]
            with simulator(*options) as target:
                bares, tools = [], []
                for _ in range(RUNS):
                    bares.append(bare(target, pages))
                    tools.append(tool(target, "--baud", str(baud)))
        print(row(f"{baud} baud, {pages} pages", best(tools), best(bares), LIMITS.get(baud, 1.05)))


if __name__ == "__main__":
    main()
