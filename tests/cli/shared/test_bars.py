"""Bars and words on a terminal whose encoding has not all characters."""

from __future__ import annotations

import errno
import io

import pytest

from fatektool.cli.shared import streams
from fatektool.cli.shared.bars import bar, levels
from fatektool.cli.shared.streams import Output, is_closed_pipe
from tests.rows import each


@each(
    ("eighths", "encoding", "drawn"),
    [
        (0, "utf-8", ""),
        (1, "utf-8", "▏"),
        (8, "utf-8", "█"),
        (12, "utf-8", "█▌"),
        (0, "cp1252", ""),
        (1, "cp1252", "#"),
        (16, "cp1252", "##"),
        (17, "cp850", "###"),
    ],
)
def test_a_bar(eighths: int, encoding: str, drawn: str) -> None:
    assert bar(eighths, encoding) == drawn
    drawn.encode(encoding)


@pytest.mark.parametrize("encoding", ["utf-8", "cp1252", "cp850", "cp437", "cp950", "ascii", "no-such"])
def test_a_chart_has_eight_levels_in_each_encoding(encoding: str) -> None:
    found = levels(encoding)
    assert len(set(found)) == 8
    if encoding != "no-such":
        found.encode(encoding)


def test_a_character_that_a_terminal_lacks() -> None:
    written = io.BytesIO()
    out = Output(written, "cp437", "fatektool.shown", newline="\n")
    out.write("and 3 more …, Süd, M1 → M2, \u6c34\n")
    out.flush()
    assert written.getvalue().decode("cp437") == "and 3 more ..., Süd, M1 -> M2, \\u6c34\n"


def test_a_closed_pipe_of_windows(monkeypatch: pytest.MonkeyPatch) -> None:
    """The C library there reports it as an invalid argument; of a file it is one."""
    assert is_closed_pipe(BrokenPipeError())
    closed, of_a_file = (
        OSError(errno.EINVAL, "Invalid argument"),
        OSError(errno.EINVAL, "Invalid", "press?.json"),
    )
    for windows in (False, True):
        monkeypatch.setattr(streams, "_WINDOWS", windows)
        assert is_closed_pipe(closed) == windows
        assert not is_closed_pipe(of_a_file)
        assert not is_closed_pipe(OSError(errno.ENOSPC, "No space left on device"))
        assert not is_closed_pipe(ValueError(errno.EINVAL))
