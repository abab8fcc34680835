"""What may be said of a file that does not hold: one line, and nothing in it that a terminal would obey."""

from __future__ import annotations

from typing import TYPE_CHECKING

if TYPE_CHECKING:
    from fatektool.errors import FatektoolError

MOST = 2000


def require_plain(error: FatektoolError) -> None:
    """Hold a message to that."""
    text = " ".join(str(error).split())
    assert text.isprintable(), f"a terminal would obey {text!r}"
    assert len(text) <= MOST, f"{len(text)} characters: {text[:200]!r}"
