"""Put into the kept corpus what of a folder goes ways through the code that no kept input goes.

A way is a step from one line of the package to the next, as Python's own tracing sees it. Short inputs are
looked at first, so that a long one is kept for what only it reaches.

Usage: python -m fuzz.keep FOLDER [TARGET …]
"""

from __future__ import annotations

import hashlib
import importlib
import sys
from pathlib import Path
from typing import TYPE_CHECKING

from fuzz.run import CORPUS, targets

if TYPE_CHECKING:
    from collections.abc import Callable
    from types import FrameType

    Step = tuple[str, int, int]

MOST_BYTES = 512
_PACKAGE = str(CORPUS.parent.parent / "fatektool")


def ways(one_input: Callable[[bytes], None], data: bytes) -> set[Step]:
    """The steps that an input takes."""
    taken: set[Step] = set()
    last: dict[FrameType, int] = {}

    def trace(frame: FrameType, event: str, _: object) -> object:
        if not frame.f_code.co_filename.startswith(_PACKAGE):
            return None
        if event == "line":
            taken.add((frame.f_code.co_filename, last.get(frame, 0), frame.f_lineno))
            last[frame] = frame.f_lineno
        return trace

    sys.settrace(trace)  # type: ignore[arg-type]  # it gives itself, or None
    try:
        one_input(data)
    finally:
        sys.settrace(None)
    return taken


def keep(target: str, folder: Path) -> int:
    """How many inputs of the folder were added to the corpus of this target."""
    one_input = importlib.import_module(f"fuzz.{target}").one_input
    known: set[Step] = set()
    for path in (CORPUS / target).iterdir():
        known |= ways(one_input, path.read_bytes())
    added = 0
    for data in sorted((path.read_bytes() for path in folder.iterdir()), key=len):
        if len(data) <= MOST_BYTES and not (steps := ways(one_input, data)) <= known:
            known |= steps
            added += 1
            (CORPUS / target / f"found-{hashlib.sha256(data).hexdigest()[:12]}").write_bytes(data)
    return added


def main() -> None:
    """Keep what is new, and say how much that was."""
    found = Path(sys.argv[1])
    for target in sys.argv[2:] or targets():
        if (found / target).is_dir():
            print(f"{target:<16} {keep(target, found / target)} added")


if __name__ == "__main__":
    main()
