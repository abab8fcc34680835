"""The check whether a write was made: the read, and the expected answer."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

from fatektool.protocol.commands import (
    Control,
    ControlDiscrete,
    ReadBriefStatus,
    ReadDisabled,
    ReadDiscretes,
    ReadMixed,
    ReadPage,
    ReadRegisters,
    Request,
    RunStop,
    WriteDiscretes,
    WriteMixed,
    WritePage,
    WriteRegisters,
)

if TYPE_CHECKING:
    from collections.abc import Callable


def read_back(  # noqa: PLR0911  # a case a command
    request: Request[None],
) -> tuple[Request[Any], Callable[[Any], bool]]:
    """The request that reads back a write, and the test of its answer.

    Args:
        request: a request whose ``writes`` is True.
    """
    match request:
        case RunStop(run):
            return ReadBriefStatus(), lambda status: bool(status.flags.running == run)
        case ControlDiscrete(Control.DISABLE | Control.ENABLE as control, element):
            return ReadDisabled(element, 1), lambda bits: bool(bits[0] == (control == Control.DISABLE))
        case ControlDiscrete(control, element):
            return ReadDiscretes(element, 1), lambda bits: bool(bits[0] == (control == Control.SET))
        case WriteDiscretes(first, values):
            return ReadDiscretes(first, len(values)), values.__eq__
        case WriteRegisters(first, values):
            return ReadRegisters(first, len(values)), values.__eq__
        case WriteMixed(items):
            wanted = tuple(value for _, value in items)
            return ReadMixed(tuple(element for element, _ in items)), wanted.__eq__
        case WritePage(page, data):
            return ReadPage(page), data.__eq__
    raise TypeError(f"{type(request).__name__} writes nothing")
