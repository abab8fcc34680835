"""The standard streams, made fit for data: UTF-8 wherever it goes, and an end of reading that ends no work.

What is redirected is data for programs, and is UTF-8 with plain line ends whatever the locale says. On a
terminal words take the terminal's encoding, and what that lacks is shown as a code. So is it on stderr.
"""

from __future__ import annotations

import errno
import io
import os
import sys

_NOBODY_READS = {errno.EPIPE, errno.EINVAL}  # the second on Windows


class Output(io.FileIO):
    """A descriptor that takes what it is given, also once nobody reads it any more: ``cut`` tells."""

    cut = False

    def write(self, data: object) -> int:
        """Write what the system takes; all is taken once the reader is gone."""
        size = memoryview(data).nbytes  # type: ignore[arg-type]  # any buffer
        if self.cut:
            return size
        try:
            return super().write(data) or 0  # type: ignore[arg-type]
        except OSError as error:
            if error.errno not in _NOBODY_READS or (error.errno == errno.EINVAL and os.name != "nt"):
                raise
            self.cut = True
            return size


def mend_streams() -> None:
    """Stand in for standard streams that are closed; let no character be one that cannot be printed."""
    out = sys.stdout
    for name, mode in (("stdin", "r"), ("stdout", "w"), ("stderr", "w")):
        if getattr(sys, name) is None:
            setattr(sys, name, open(os.devnull, mode, encoding="utf-8"))  # noqa: PTH123, SIM115  # stays open
    if isinstance(out, io.TextIOWrapper):
        terminal = out.isatty()
        sys.stdout = io.TextIOWrapper(
            io.BufferedWriter(Output(out.fileno(), "wb", closefd=False)),
            out.encoding if terminal else "utf-8",
            "backslashreplace",
            newline=None if terminal else "\n",
            line_buffering=terminal,
        )


def reader_is_gone() -> bool:
    """True if nobody reads standard output any more, so that who prints without end may end."""
    raw = getattr(getattr(sys.stdout, "buffer", None), "raw", None)
    return isinstance(raw, Output) and raw.cut
