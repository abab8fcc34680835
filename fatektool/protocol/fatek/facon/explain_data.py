"""The data fields of FACON requests and answers, divided and explained."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any, ClassVar, Final

from fatektool.errors import FrameError
from fatektool.protocol import explain_data
from fatektool.protocol.commands import COMMAND_WORDS, PAGE_BYTES, Command
from fatektool.protocol.explain_data import ACKNOWLEDGED, Cutter
from fatektool.protocol.fatek.facon.text import CHARS, HEX_DIGITS, element_text, take_value, unhex
from fatektool.protocol.plc_errors import meaning_of
from fatektool.protocol.status import BriefStatus, DetailedStatus

if TYPE_CHECKING:
    from fatektool.protocol.commands import Request
    from fatektool.protocol.elements import Element
    from fatektool.protocol.explain import Field

_READS: Final[dict[int, tuple[bytes, int]]] = {
    Command.READ_DISABLED: (b"01", 1),
    Command.READ_DISCRETES: (b"01", 1),
    Command.READ_REGISTERS: (HEX_DIGITS, 4),
    Command.READ_MIXED: (HEX_DIGITS, 1),
}
"""The characters that an answer's values are written in, and the fewest that a value takes."""

_MOST_CHARS: Final = 256
"""What the values of any read take at most: 256 discretes, or 64 words."""

_WHOLE: Final[dict[int, int]] = {Command.READ_PAGE: 256, Command.DETAILED_STATUS: 128}


class _FaconCutter(Cutter):
    octet: ClassVar[int] = 2  # hex digits
    value_sizes: ClassVar[dict[int, int]] = CHARS
    unit: ClassVar[str] = "characters"

    def element_size(self, element: Element) -> int:
        return len(element_text(element))

    def taken_value(self, element: Element, raw: bytes) -> int:
        return take_value(element, raw)


def request_fields(request: Request[Any], data: bytes) -> tuple[Field, ...]:
    """The data field of a request, divided."""
    return explain_data.request_fields(request, _FaconCutter(data))


def answer_fields(command: int, data: bytes, asked: Request[Any] | None) -> tuple[Field, ...]:
    """The data field of an answer, divided.

    Args:
        command: the command's code.
        data: the field.
        asked: the request it answers, if that is known.

    Raises:
        FrameError: no answer to this command has such data.
    """
    cutter = _FaconCutter(data)
    if command == Command.LOOPBACK:
        explain_data.loopback(cutter)
        return tuple(cutter.fields)
    if len(data) == 1 and data != b"0":
        if data not in HEX_DIGITS:
            raise FrameError("the error character is no hex digit", raw=data)
        cutter.cut(1, "error", f"REFUSED: {meaning_of(int(data, 16))}")
        return tuple(cutter.fields)
    if command not in COMMAND_WORDS:
        raise FrameError(f"command {command:02X} is not in the paper", raw=data)
    if len(data) != _WHOLE.get(command):  # those two may come without the error character
        if not data.startswith(b"0"):
            raise FrameError("an answer begins with its error character", raw=data)
        cutter.cut(1, "error", "none")
    _values(cutter, command, asked)
    return tuple(cutter.fields)


def _values(cutter: Cutter, command: int, asked: Request[Any] | None) -> None:
    rest = cutter.rest
    if command in ACKNOWLEDGED:
        if rest:
            raise FrameError("an acknowledgement has no data", raw=rest)
    elif command == Command.BRIEF_STATUS:
        explain_data.brief_status(cutter, BriefStatus.parse(unhex(rest)))
    elif command == Command.DETAILED_STATUS:
        explain_data.detailed_status(cutter, DetailedStatus.parse(unhex(rest)))
    elif command == Command.READ_PAGE:
        page = unhex(rest)
        if len(page) != PAGE_BYTES:
            raise FrameError(f"expected a page of {PAGE_BYTES} bytes, got {len(page)}", raw=rest)
        cutter.page(page)
    else:
        _read(cutter, command, explain_data.elements_of(asked))


def _read(cutter: Cutter, command: int, elements: list[Element]) -> None:
    """The values of a read; ``elements`` is empty if it is not known what was asked."""
    characters, fewest = _READS[command]
    rest = cutter.rest
    if not 0 < len(rest) <= _MOST_CHARS or len(rest) % fewest or rest.translate(None, characters):
        raise FrameError("no answer to a read has such data", raw=rest)
    if not elements:
        cutter.all("values", "of elements that the request names")
        return
    chars = cutter.values_size(elements)
    if len(rest) != chars:
        raise FrameError(f"expected {chars} characters of values, as was asked, got {len(rest)}", raw=rest)
    cutter.read_values(command, elements)
