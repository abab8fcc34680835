"""The data fields of M-series requests and answers, divided and explained."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any, ClassVar, Final

from fatektool.errors import FrameError
from fatektool.protocol import explain_data
from fatektool.protocol.commands import DETAILED_BYTES, Command
from fatektool.protocol.explain_data import ACKNOWLEDGED, Cutter
from fatektool.protocol.fatek.mseries.bytes import VALUE_BYTES, element_size, take_value
from fatektool.protocol.fatek.mseries.data import COMMANDS
from fatektool.protocol.fatek.mseries.errors import meaning_of
from fatektool.protocol.status import BriefStatus, DetailedStatus

if TYPE_CHECKING:
    from fatektool.protocol.commands import Request
    from fatektool.protocol.elements import Element
    from fatektool.protocol.explain import Field

_READS: Final[dict[int, tuple[int, int]]] = {
    Command.READ_DISABLED: (1, 256),
    Command.READ_DISCRETES: (1, 256),
    Command.READ_REGISTERS: (2, 128),
    Command.READ_MIXED: (1, 128),
}
"""How many bytes a value takes at least, and all values at most."""


class _MseriesCutter(Cutter):
    octet: ClassVar[int] = 1
    value_sizes: ClassVar[dict[int, int]] = VALUE_BYTES
    unit: ClassVar[str] = "bytes"

    def element_size(self, element: Element) -> int:
        return element_size(element)

    def taken_value(self, element: Element, raw: bytes) -> int:
        return take_value(element, raw)


def request_fields(request: Request[Any], data: bytes) -> tuple[Field, ...]:
    """The data field of a request, divided."""
    return explain_data.request_fields(request, _MseriesCutter(data))


def answer_fields(command: int, data: bytes, asked: Request[Any] | None) -> tuple[Field, ...]:
    """The data field of an answer, divided.

    Args:
        command: the command's code.
        data: the field.
        asked: the request it answers, if that is known.

    Raises:
        FrameError: no answer to this command has such data.
    """
    cutter = _MseriesCutter(data)
    if command == Command.LOOPBACK:
        explain_data.loopback(cutter)
        return tuple(cutter.fields)
    if len(data) == 1 and data[0]:
        cutter.cut(1, "error", f"REFUSED: {meaning_of(data[0])}")
        return tuple(cutter.fields)
    if command not in COMMANDS:
        raise FrameError(f"command {command:02X} is not in the paper", raw=data)
    if not data.startswith(b"\0"):
        raise FrameError("an answer begins with its error byte", raw=data)
    cutter.cut(1, "error", "none")
    _values(cutter, command, asked)
    return tuple(cutter.fields)


def _values(cutter: Cutter, command: int, asked: Request[Any] | None) -> None:
    rest = cutter.rest
    if command in ACKNOWLEDGED:
        if rest:
            raise FrameError("an acknowledgement has no data", raw=rest)
    elif command == Command.BRIEF_STATUS:
        explain_data.brief_status(cutter, BriefStatus.parse(rest, m_series=True))
    elif command == Command.DETAILED_STATUS:
        if len(rest) == DETAILED_BYTES:
            explain_data.detailed_status(cutter, DetailedStatus.parse(rest, assumed=True))
        else:
            cutter.all("status", "in a layout that no paper describes")
    else:
        _read(cutter, command, explain_data.elements_of(asked))


def _read(cutter: Cutter, command: int, elements: list[Element]) -> None:
    """The values of a read; ``elements`` is empty if it is not known what was asked."""
    fewest, most = _READS[command]
    rest = cutter.rest
    if not 0 < len(rest) <= most or len(rest) % fewest:
        raise FrameError("no answer to a read has such data", raw=rest)
    if not elements:
        cutter.all("values", "of elements that the request names")
        return
    size = cutter.values_size(elements)
    if len(rest) != size:
        raise FrameError(f"expected {size} bytes of values, as was asked, got {len(rest)}", raw=rest)
    cutter.read_values(command, elements)
