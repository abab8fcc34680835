"""Times are measured with the clock of high resolution: ``monotonic`` has steps of 15.6 ms on Windows."""

from __future__ import annotations

import ast

from tests.root import ROOT

COARSE = {"monotonic", "monotonic_ns", "clock_gettime"}


def test_no_time_is_measured_with_a_coarse_clock() -> None:
    """A latency of 5 ms would be 0 or 15.6; Python has a finer one there from 3.13 on."""
    found = [
        f"{path}:{node.lineno}: {ast.unparse(node)}"
        for path in [*(ROOT / "fatektool").rglob("*.py"), *(ROOT / "bench").glob("*.py")]
        for node in ast.walk(ast.parse(path.read_text(encoding="utf-8")))
        if isinstance(node, ast.Attribute) and node.attr in COARSE and ast.unparse(node.value) == "time"
    ]
    assert not found
