"""Every error the library raises, each with the exit code of its class.

::

    FatektoolError                     70  a fault of fatektool itself
    ├── UsageError                      2  a bad option or value, a refused question
    │   ├── LineReadOnly                   a write over a line that may only be read
    │   └── FileExists                     a file of this name is there, and is kept
    ├── LineError                       3  no or no usable answer, port not there or in use
    │   ├── TransportError                 the medium failed
    │   │   ├── TransportTimeout           nothing came in time (one read, not one exchange)
    │   │   │   └── GatewayTimeout         a gateway says that it did not reach the PLC
    │   │   └── TransportClosed            the other side or the cable is gone
    │   ├── PortBusy                       another process holds the port
    │   ├── FrameError                     bytes that are no frame
    │   ├── NoAnswer                       an exchange found no answer, retries included
    │   ├── DeadlinePassed                 the limit of time for this PLC is over
    │   └── PushFailed                     a history did not reach the other repository; it is kept here
    ├── PlcError                        4  the PLC is reached and will not or must not
    │   ├── PlcRefused                     an error code in its answer
    │   ├── PlcBusy                        it says that it is at work: to be asked again
    │   └── PlcNotReady                    RUN where STOP is needed, ROM pack fitted
    ├── DataError                       5  a file or program that does not hold
    └── RestoreIncomplete               6  a write ended half way: the PLC holds neither old nor new

A message is one line that says what, where, expected, got and the next step. ``details`` holds the
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
    """What was asked cannot be asked: nothing was sent."""

    exit_code = 2


class LineReadOnly(UsageError):
    """A write over a line that may only be read.

    Args:
        what: wanted to write.
    """

    def __init__(self, what: str) -> None:
        super().__init__(
            f"{what}: this line is read-only, and nothing was sent",
            hint="to write, leave out --read-only, FATEKTOOL_READ_ONLY and the inventory's read_only",
        )


class FileExists(UsageError):
    """A file of this name is there already, and is kept."""


class LineError(FatektoolError):
    """No or no usable answer; or the port cannot be had."""

    exit_code = 3


class TransportError(LineError):
    """The medium failed: an error of the operating system, in the project's words."""


class TransportTimeout(TransportError):
    """Not one byte came within the time that a single read was given."""


class GatewayTimeout(TransportTimeout):
    """A gateway says that no answer came from behind it.

    Args:
        message: what it says.
        handed_on: False if the request did not leave the gateway.
    """

    def __init__(self, message: str, *, handed_on: bool, hint: str) -> None:
        super().__init__(message, hint=hint)
        self.handed_on = handed_on


class TransportClosed(TransportError):
    """The connection or the device is gone.

    Args:
        message: what happened.
        hint: the next step.
        may_return: True for a connection that was refused, reset or closed by the other side, which may take
            the next one in a moment.
    """

    def __init__(self, message: str, *, hint: str | None = None, may_return: bool = False) -> None:
        super().__init__(message, hint=hint)
        self.may_return = may_return


class PortBusy(LineError):
    """Another process uses the port or gateway."""


class FrameError(LineError):
    """Bytes that are no frame of the protocol.

    Args:
        message: what is wrong with them.
        raw: the bytes that were dropped.
        checksum: True if all but the checksum of a whole frame is right in form.
    """

    def __init__(self, message: str, *, raw: bytes = b"", checksum: bool = False) -> None:
        super().__init__(message, raw=raw.hex(" ").upper())
        self.raw = raw
        self.checksum = checksum


class NoAnswer(LineError):
    """One exchange and its retries found no answer to trust."""


class DeadlinePassed(LineError):
    """The overall limit of time for this PLC is over."""


class PushFailed(LineError):
    """A history did not reach another repository. What was recorded here stays recorded."""


class PlcError(FatektoolError):
    """The PLC is reached, and will not or must not do what was asked."""

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
    """The PLC says that it is at work. Not for good: it is asked again, and this is raised if it stays so.

    Args:
        message: what was asked and what the PLC said.
        code: the exception code.
        command: the command's code.
        accepted: True if it will do what it was asked, and has not done it yet.
    """

    def __init__(
        self, message: str, *, code: int, command: int, accepted: bool, hint: str | None = None
    ) -> None:
        super().__init__(message, hint=hint, code=f"{code:X}", command=f"{command:02X}")
        self.accepted = accepted


class PlcNotReady(PlcError):
    """The PLC is in a state in which this must not be done."""


class DataError(FatektoolError):
    """A file, program or header that does not hold, or does not fit this PLC."""

    exit_code = 5


class RestoreIncomplete(FatektoolError):
    """A write that can be undone ended half way: the PLC holds neither what it held nor what it should.

    Attributes:
        headline: what did not complete.
        mode: the mode that the PLC is in now, and what must not be done; empty if it was left alone.
        states: what the PLC holds: the place, such as ``page 0-3``, and what is there.
        saved: the file with what the PLC held before; None if it was not saved.
    """

    exit_code = 6
    headline = ""
    mode = ""
    states: Sequence[tuple[str, str]] = ()
    saved: str | None = None


class FileWarning(UserWarning):
    """A file is written and whole, and something about it is not as it ought to be."""
