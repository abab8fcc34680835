"""The standard streams, made fit for data: UTF-8 wherever it goes, and an end of reading that ends no work.

What is redirected is data for programs, and is UTF-8 with plain line ends whatever the locale says. On a
terminal words take its encoding. A character that it lacks is shown as one that looks like it, else
as a code. So is it on stderr.
"""

from __future__ import annotations

import codecs
import errno
import io
import os
import sys
from typing import Final

_WINDOWS: Final = os.name == "nt"
_SHOWN: Final = "fatektool.shown"
_ALIKE: Final = {"…": "...", "→": "->"}


def shown(error: UnicodeError) -> tuple[str | bytes, int]:
    """The error handler of these streams: for what cannot be encoded, what looks like it, or its code."""
    if isinstance(error, UnicodeEncodeError) and (alike := _ALIKE.get(error.object[error.start])):
        return alike, error.start + 1
    return codecs.backslashreplace_errors(error)


codecs.register_error(_SHOWN, shown)


def is_closed_pipe(error: BaseException) -> bool:
    """True if the reader of a pipe is gone: on Windows the C library reports it as an invalid argument."""
    if isinstance(error, BrokenPipeError):
        return True
    return _WINDOWS and isinstance(error, OSError) and error.errno == errno.EINVAL and error.filename is None


class Output(io.TextIOWrapper):
    """Standard output that can be written also after its reader is gone: ``cut`` is true then."""

    cut = False

    def write(self, text: str) -> int:
        """Write text."""
        try:
            return super().write(text)
        except OSError as error:
            self.lost(error)
            return len(text)

    def flush(self) -> None:
        """Hand on what is kept back."""
        try:
            super().flush()
        except OSError as error:
            self.lost(error)

    def lost(self, error: OSError) -> None:
        """Let all that is still to come go nowhere, if it is the reader that is gone.

        Raises:
            OSError: it is another fault.
        """
        if not is_closed_pipe(error):
            raise error
        self.cut = True
        nowhere = os.open(os.devnull, os.O_WRONLY)
        os.dup2(nowhere, self.fileno())
        os.close(nowhere)


def print_bytes(data: bytes) -> None:
    """Print data as they are on standard output."""
    out = sys.stdout
    out.flush()
    try:
        out.buffer.write(data)
        out.buffer.flush()
    except OSError as error:
        if not isinstance(out, Output):
            raise
        out.lost(error)


def mend_streams() -> None:
    """Stand in for standard streams that are closed; let no character be one that cannot be printed."""
    out = sys.stdout
    for name, mode in (("stdin", "r"), ("stdout", "w"), ("stderr", "w")):
        if getattr(sys, name) is None:
            setattr(sys, name, open(os.devnull, mode, encoding="utf-8"))  # noqa: PTH123, SIM115  # stays open
    if isinstance(sys.stderr, io.TextIOWrapper):
        sys.stderr.reconfigure(errors=_SHOWN)
    if isinstance(out, io.TextIOWrapper):
        terminal = out.isatty()
        raw = open(out.fileno(), "wb", buffering=0, closefd=False)  # noqa: SIM115  # of the console on Windows
        sys.stdout = Output(
            io.BufferedWriter(raw),
            out.encoding if terminal else "utf-8",
            _SHOWN,
            newline=None if terminal else "\n",
            line_buffering=terminal,
        )


def reader_is_gone() -> bool:
    """True if the reader of standard output is gone: a command that prints without end can end."""
    return isinstance(sys.stdout, Output) and sys.stdout.cut
