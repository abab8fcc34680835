"""The standard streams, made fit for data: UTF-8 wherever it goes, and no stream that fails ends any work.

What is redirected is data for programs, and is UTF-8 with plain line ends whatever the locale says. On a
terminal words take its encoding. A character that it lacks is shown as one that looks like it, else
as a code. So is it on stderr.

If standard output cannot be written any more (its reader is gone, the disk is full), the command goes on, and
its exit code is changed at its end. If standard error cannot be written, nothing is changed: the message is
lost. A stream that a shell closed is as ``/dev/null``, but for a file that was to go to standard output.
"""

from __future__ import annotations

import codecs
import errno
import io
import os
import sys
from typing import TYPE_CHECKING, Final

from fatektool.errors import DataError

if TYPE_CHECKING:
    from _typeshed import ReadableBuffer

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
    """Standard output that takes text also when it cannot be written any more.

    Attributes:
        loss: why what was printed is not where it ought to be; None if it is.
        stands_in: True in place of a standard output that is closed.
    """

    loss: OSError | None = None
    stands_in = False

    def write(self, text: str) -> int:
        """Write text."""
        try:
            return super().write(text)
        except OSError as error:
            self.lose(error)
            return len(text)

    def flush(self) -> None:
        """Write what is buffered."""
        try:
            super().flush()
        except OSError as error:
            self.lose(error)

    def lose(self, error: OSError) -> None:
        """Discard all that is buffered and all that is still to come."""
        if self.loss is None:
            self.loss = error
        nowhere = os.open(os.devnull, os.O_WRONLY)
        os.dup2(nowhere, self.fileno())
        os.close(nowhere)


class Unheard(io.RawIOBase):
    """Bytes of standard error: those that cannot be written are discarded, the next ones are tried again.

    So no message stops the work that it is about. Python finds nothing at its end that it cannot write, for
    which it would change the exit code to 120.

    Args:
        raw: what is written to.
    """

    def __init__(self, raw: io.RawIOBase) -> None:
        self._raw = raw

    def writable(self) -> bool:
        """True."""
        return True

    def fileno(self) -> int:
        """The descriptor of standard error."""
        return self._raw.fileno()

    def isatty(self) -> bool:
        """True on a terminal."""
        return self._raw.isatty()

    def write(self, data: ReadableBuffer) -> int:
        """Write bytes, as far as that is possible."""
        size = memoryview(data).nbytes
        try:
            return self._raw.write(data) or size
        except OSError:
            return size


def print_bytes(data: bytes) -> None:
    """Print the bytes of a file on standard output, which is its only place: it must not be closed."""
    out = sys.stdout
    out.flush()
    _require_open()
    try:
        out.buffer.write(data)
        out.buffer.flush()
    except OSError as error:
        if not isinstance(out, Output):
            raise
        out.lose(error)


def print_text(text: str) -> None:
    """Print the text of a file on standard output, in the same way."""
    _require_open()
    sys.stdout.write(text)
    sys.stdout.flush()


def _require_open() -> None:
    """Take it for a loss if standard output is closed."""
    out = sys.stdout
    if isinstance(out, Output) and out.stands_in:
        out.lose(OSError(errno.EBADF, os.strerror(errno.EBADF)))


def mend_streams() -> None:
    """Put streams that can always be written in place of the standard ones, also of those that are closed."""
    out, err = sys.stdout, sys.stderr
    if _WINDOWS:
        _know_nul()
    for name, mode in (("stdin", os.O_RDONLY), ("stdout", os.O_WRONLY), ("stderr", os.O_WRONLY)):
        if getattr(sys, name) is None:  # what is opened next must not get its descriptor
            null = os.open(os.devnull, mode)  # stays open
            setattr(sys, name, open(null, "w" if mode else "r", encoding="utf-8", closefd=False))  # noqa: SIM115
    if isinstance(err, io.TextIOWrapper):
        raw = open(err.fileno(), "wb", buffering=0, closefd=False)  # noqa: SIM115  # of the console on Windows
        sys.stderr = io.TextIOWrapper(
            io.BufferedWriter(Unheard(raw)), err.encoding, _SHOWN, line_buffering=True
        )
    if isinstance(sys.stdout, io.TextIOWrapper):
        is_terminal = sys.stdout.isatty()
        raw = open(sys.stdout.fileno(), "wb", buffering=0, closefd=False)  # noqa: SIM115
        made = Output(
            io.BufferedWriter(raw),
            sys.stdout.encoding if is_terminal else "utf-8",
            _SHOWN,
            newline=None if is_terminal else "\n",
            line_buffering=is_terminal,
        )
        made.stands_in = out is None
        sys.stdout = made
    if _WINDOWS:
        _know_nul()


def _know_nul() -> None:
    """Let no stream pass for a terminal on Windows that is none: NUL, from which nobody answers."""
    from fatektool.system.terminal import is_terminal

    for stream in (sys.stdin, sys.stdout, sys.stderr):
        if isinstance(stream, io.TextIOWrapper) and stream.isatty() and not is_terminal(stream):
            stream.isatty = lambda: False  # type: ignore[method-assign]  # for all who ask


def output_loss() -> OSError | None:
    """Why standard output cannot be written any more, on which an endless command ends; None if it can."""
    return sys.stdout.loss if isinstance(sys.stdout, Output) else None


def lost_output(loss: OSError) -> DataError:
    """What a user reads of such a loss."""
    if loss.errno == errno.EBADF:
        return DataError(
            "standard output is closed: nothing was written to it", hint="redirect it, or name a file"
        )
    return DataError(
        f"standard output cannot be written: {loss.strerror}",
        hint="free some space or name another place; the command was carried out, its output is not complete",
    )
