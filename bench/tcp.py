"""What does a page cost beside a bare socket loop? 1025 pages over TCP on this machine, no pace.

Usage: python bench/tcp.py
"""

from __future__ import annotations

import tempfile
from pathlib import Path

from common import LARGEST, bare, best, row, simulator, tool
from exchanges import verify

PAGES = 1025
LIMIT = 1.15
RUNS = 7


def main() -> None:
    """Print one row."""
    with (
        simulator("--tcp", "127.0.0.1:0", "--ladder-words", str(LARGEST)) as target,
        tempfile.TemporaryDirectory() as folder,
    ):
        file = str(Path(folder) / "backup.json")
        bares, tools = [], []
        for _ in range(RUNS):
            bares.append(bare(target, verify(PAGES)))  # once, as the tool's single pass
            tools.append(tool("backup", file, "-p", target, "--single-pass", "--force"))
    print(row(f"TCP, {PAGES} pages", best(tools), best(bares), LIMIT))


if __name__ == "__main__":
    main()
