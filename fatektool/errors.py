"""All errors that the library raises, each with the exit code of its class.

::

    FatektoolError                     70  an error in fatektool itself
    ├── UsageError                      2  an invalid option or value; nothing was sent
    │   ├── LineReadOnly                   a write on a read-only line
    │   └── FileExists                     the file exists already; it is kept
    ├── LineError                       3  no valid answer; port missing or in use
    │   ├── TransportError                 the medium failed
    │   │   ├── TransportTimeout           nothing received in time (one read, not one exchange)
    │   │   │   └── GatewayTimeout         a gateway reports that it did not reach the PLC
    │   │   └── TransportClosed            the connection or the device is lost
    │   ├── PortBusy                       another process uses the port
    │   ├── FrameError                     bytes that are not a frame
    │   ├── NoAnswer                       no valid answer to a request and its retries
    │   ├── DeadlinePassed                 the time limit for this PLC is over
    │   └── PushFailed                     a history could not be sent to the other repository
    ├── PlcError                        4  the PLC is reached, but refuses, or must not be asked
    │   ├── PlcRefused                     an error code in its answer
    │   ├── PlcBusy                        the PLC is busy, also after retries
    │   └── PlcNotReady                    for example in RUN where STOP is needed, or a ROM pack is fitted
    ├── DataError                       5  an invalid file or program
    └── RestoreIncomplete               6  a write stopped half way: the PLC has neither the old nor the new

A message is one line with what, where, expected, got and the next step. ``details`` holds the
same as values for JSON, and ``kind`` is the class's name in snake case.
"""

from __future__ import annotations

import re
from typing import TYPE_CHECKING, Any, ClassVar

if TYPE_CHECKING:
    from collections.abc import Sequence


class FatektoolError(Exception):
    """Base of all errors of this project.

    Args:
        message: one line: what happened, where, what was expected and got.
        hint: the next step for the person who reads it, as a sentence without its full stop.
        details: values for a script: JSON types only.

    ``lines`` is the same for a person, a fact a line; empty for what fits on one.
    """

    exit_code: ClassVar[int] = 70

    def __init__(self, message: str, *, hint: str | None = None, **details: Any) -> None:
        super().__init__(message)
        self.lines: list[str] = []
        self.message = message
        self.hint = hint
        self.details = details

    @property
    def kind(self) -> str:
        """The class's name in snake case: ``PlcRefused`` is ``plc_refused``."""
        return re.sub(r"(?<!^)(?=[A-Z])", "_", type(self).__name__).lower()

    def __str__(self) -> str:
        return f"{self.message}; {self.hint}" if self.hint else self.message


class UsageError(FatektoolError):
    """An invalid option, value or request: nothing was sent."""

    exit_code = 2


class LineReadOnly(UsageError):
    """A write on a read-only line.

    Args:
        what: the request or command that writes.
    """

    def __init__(self, what: str) -> None:
        super().__init__(
            f"{what}: this line is read-only, and nothing was sent",
            hint="to write, leave out --read-only, FATEKTOOL_READ_ONLY and the inventory's read_only",
        )


class FileExists(UsageError):
    """The file exists already; it is kept."""


class LineError(FatektoolError):
    """No valid answer; or the port is missing or in use."""

    exit_code = 3


class TransportError(LineError):
    """The medium failed: an error of the operating system."""


class TransportTimeout(TransportError):
    """Not one byte was received within the time of one read."""


class GatewayTimeout(TransportTimeout):
    """A gateway reports that it got no answer from the PLC.

    Args:
        message: what it reports.
        handed_on: False if the request did not leave the gateway.
    """

    def __init__(self, message: str, *, handed_on: bool, hint: str) -> None:
        super().__init__(message, hint=hint)
        self.handed_on = handed_on


class TransportClosed(TransportError):
    """The connection or the device is lost.

    Args:
        message: what happened.
        hint: the next step.
        may_return: True for a connection that was refused, reset or closed by the other side, which may
            accept the next one soon.
    """

    def __init__(self, message: str, *, hint: str | None = None, may_return: bool = False) -> None:
        super().__init__(message, hint=hint)
        self.may_return = may_return


class PortBusy(LineError):
    """Another process uses the port or gateway."""


class FrameError(LineError):
    """Bytes that are not a frame of the protocol.

    Args:
        message: what is wrong with them.
        raw: the bytes that were dropped.
        checksum: True for a complete frame in which only the checksum is wrong.
    """

    def __init__(self, message: str, *, raw: bytes = b"", checksum: bool = False) -> None:
        super().__init__(message, raw=raw.hex(" ").upper())
        self.raw = raw
        self.checksum = checksum


class NoAnswer(LineError):
    """No valid answer to a request and its retries."""


class DeadlinePassed(LineError):
    """The time limit for this PLC is over."""


class PushFailed(LineError):
    """A history could not be sent to another repository. What was recorded here is kept."""


class PlcError(FatektoolError):
    """The PLC is reached, but refuses the request, or must not do it now."""

    exit_code = 4


class PlcRefused(PlcError):
    """An error code in the PLC's answer.

    Args:
        message: what was asked and the code's meaning.
        code: the error code, 1 to 15.
        command: the command's code.
    """

    def __init__(self, message: str, *, code: int, command: int, hint: str | None = None) -> None:
        super().__init__(message, hint=hint, code=f"{code:X}", command=f"{command:02X}")
        self.code = code
        self.command = command


class PlcBusy(PlcError):
    """The PLC reports that it is busy. The request is repeated; this is raised if the PLC stays busy.

    Args:
        message: what was asked and what the PLC answered.
        code: the exception code.
        command: the command's code.
        accepted: True if the PLC accepted the request and has not completed it yet.
    """

    def __init__(
        self, message: str, *, code: int, command: int, accepted: bool, hint: str | None = None
    ) -> None:
        super().__init__(message, hint=hint, code=f"{code:X}", command=f"{command:02X}")
        self.accepted = accepted


class PlcNotReady(PlcError):
    """This must not be done in the present state of the PLC."""


class DataError(FatektoolError):
    """A file, program or header that is invalid, or does not fit this PLC."""

    exit_code = 5


class RestoreIncomplete(FatektoolError):
    """A write stopped half way: the PLC has neither its previous nor the new values or program.

    Attributes:
        headline: what was not completed.
        mode: the present mode of the PLC, and what must not be done; empty if it was not changed.
        states: the contents of the PLC: the range, such as ``page 0-3``, and its state.
        saved: the file with what the PLC had before; None if it was not saved.
    """

    exit_code = 6
    headline = ""
    mode = ""
    states: Sequence[tuple[str, str]] = ()
    saved: str | None = None


class FileWarning(UserWarning):
    """A file is written and complete, but something about it needs attention."""
