"""The data field of each FACON command, request and answer, both ways (FACON paper, section 4.2).

One row of ``_FIELDS`` a command. An answer begins with the error character, ``0`` for none; any other
stands alone. Two commands differ: 4E answers the very data it was sent, and 4F and 53 are drawn without
the error character in the paper's figures but with it in its example, so both are taken, told apart by
length.
"""

from __future__ import annotations

from typing import TYPE_CHECKING, Any, Final, NamedTuple, TypeVar, cast

from fatektool.errors import FrameError, PlcRefused, UsageError
from fatektool.protocol.commands import (
    BRIEF_BYTES,
    DETAILED_BYTES,
    PAGE_BYTES,
    Command,
    Loopback,
    ReadBriefStatus,
    ReadDetailedStatus,
    ReadDisabled,
    ReadDiscretes,
    ReadMixed,
    ReadRegisters,
    Request,
    require_run_limit,
)
from fatektool.protocol.fatek.facon.requests import (
    parse_control,
    parse_empty,
    parse_read_mixed,
    parse_read_page,
    parse_read_run,
    parse_run_stop,
    parse_write_discretes,
    parse_write_mixed,
    parse_write_page,
    parse_write_registers,
)
from fatektool.protocol.fatek.facon.text import (
    CHARS,
    HEX_DIGITS,
    bits_text,
    count_text,
    element_text,
    take_bits,
    take_value,
    take_words,
    to_hex,
    unhex,
    value_text,
    words_text,
)
from fatektool.protocol.plc_errors import asked, refusal

if TYPE_CHECKING:
    from collections.abc import Callable

    from fatektool.protocol.elements import Element
    from fatektool.protocol.status import BriefStatus, DetailedStatus

A = TypeVar("A")

_NO_ERROR: Final = b"0"


# --- answers --------------------------------------------------------------------------------------


def _brief(chars: bytes) -> BriefStatus:
    from fatektool.protocol.status import BriefStatus  # not before the request is on its way

    return BriefStatus.parse(unhex(chars))


def _detailed(chars: bytes) -> DetailedStatus:
    from fatektool.protocol.status import DetailedStatus  # likewise

    return DetailedStatus.parse(unhex(chars))


def _take_mixed(request: ReadMixed, chars: bytes) -> tuple[int, ...]:
    values = []
    at = 0
    for element in request.elements:
        end = at + CHARS[element.kind.bits]
        values.append(take_value(element, chars[at:end]))
        at = end
    return tuple(values)


def _mixed_values(request: ReadMixed, values: tuple[int, ...]) -> bytes:
    return b"".join(map(value_text, request.elements, values))


class _Fields(NamedTuple):
    """How one command is written. ``chars`` counts an answer's characters after the error character."""

    request: Callable[[Any], bytes]
    parse_request: Callable[[bytes], Request[Any]]
    chars: Callable[[Any], int]
    parse_answer: Callable[[Any, bytes], Any]
    answer: Callable[[Any, Any], bytes]


def _acknowledged(request: Callable[[Any], bytes], parse_request: Callable[[bytes], Request[Any]]) -> _Fields:
    return _Fields(request, parse_request, lambda _: 0, lambda _r, _c: None, lambda _r, _a: b"")


def _read_bits(make: Callable[[Element, int], Request[Any]]) -> _Fields:
    return _Fields(
        lambda r: count_text(r.count) + element_text(r.first),
        parse_read_run(make, zero_is_256=True),
        lambda r: int(r.count),
        lambda _, chars: take_bits(chars),
        lambda _, values: bits_text(values),
    )


_FIELDS: Final[dict[int, _Fields]] = {
    Command.BRIEF_STATUS: _Fields(
        lambda _: b"",
        parse_empty(ReadBriefStatus),
        lambda _: 2 * BRIEF_BYTES,
        lambda _, chars: _brief(chars),
        lambda _, answer: to_hex(answer.to_bytes()),
    ),
    Command.RUN_STOP: _acknowledged(lambda r: b"1" if r.run else b"0", parse_run_stop),
    Command.CONTROL_DISCRETE: _acknowledged(
        lambda r: b"%d%b" % (r.control, element_text(r.element)), parse_control
    ),
    Command.READ_DISABLED: _read_bits(ReadDisabled),
    Command.READ_DISCRETES: _read_bits(ReadDiscretes),
    Command.WRITE_DISCRETES: _acknowledged(
        lambda r: count_text(len(r.values)) + element_text(r.first) + bits_text(r.values),
        parse_write_discretes,
    ),
    Command.READ_REGISTERS: _Fields(
        lambda r: count_text(r.count) + element_text(r.first),
        parse_read_run(ReadRegisters, zero_is_256=False),
        lambda r: r.count * CHARS[r.first.kind.bits],
        lambda r, chars: take_words(chars, r.first.kind.bits),
        lambda r, values: words_text(values, r.first.kind.bits),
    ),
    Command.WRITE_REGISTERS: _acknowledged(
        lambda r: count_text(len(r.values)) + element_text(r.first) + words_text(r.values, r.first.kind.bits),
        parse_write_registers,
    ),
    Command.READ_MIXED: _Fields(
        lambda r: count_text(len(r.elements)) + b"".join(map(element_text, r.elements)),
        parse_read_mixed,
        lambda r: sum(CHARS[element.kind.bits] for element in r.elements),
        _take_mixed,
        _mixed_values,
    ),
    Command.WRITE_MIXED: _acknowledged(
        lambda r: count_text(len(r.items)) + b"".join(element_text(e) + value_text(e, v) for e, v in r.items),
        parse_write_mixed,
    ),
    Command.LOOPBACK: _Fields(
        lambda r: bytes(r.data),
        Loopback,
        lambda r: len(r.data) - 1,  # no error character
        lambda _, chars: chars,
        lambda _, data: bytes(data),
    ),
    Command.READ_PAGE: _Fields(
        lambda r: b"%04X" % r.page,
        parse_read_page,
        lambda _: 2 * PAGE_BYTES,
        lambda _, chars: unhex(chars),
        lambda _, data: to_hex(data),
    ),
    Command.WRITE_PAGE: _acknowledged(lambda r: b"%04X%b" % (r.page, to_hex(r.data)), parse_write_page),
    Command.DETAILED_STATUS: _Fields(
        lambda _: b"",
        parse_empty(ReadDetailedStatus),
        lambda _: 2 * DETAILED_BYTES,
        lambda _, chars: _detailed(chars),
        lambda _, answer: to_hex(answer.raw),
    ),
}
COMMANDS: Final = frozenset(Command(code) for code in _FIELDS)

_ERROR_CHARACTER_MAY_LACK: Final = {Command.READ_PAGE, Command.DETAILED_STATUS}


# --- the four ways --------------------------------------------------------------------------------


def request_data(request: Request[A]) -> bytes:
    """The data field of a request.

    Raises:
        UsageError: a run that is too long.
    """
    require_run_limit(request)
    return _FIELDS[request.command].request(request)


def parse_request(command: int, data: bytes) -> Request[object]:
    """The request that a data field holds.

    Raises:
        FrameError: an unknown command, or data that no request of it has.
    """
    fields = _FIELDS.get(command)
    if fields is None:
        raise FrameError(f"command {command:02X} is not in the paper", raw=data)
    try:
        request = fields.parse_request(data)
        require_run_limit(request)
    except UsageError as error:
        raise FrameError(error.message, raw=data) from error
    return request


def answer_chars(request: Request[A]) -> int:
    """How many data characters the good answer to a request has, error character included."""
    return 1 + _FIELDS[request.command].chars(request)


def parse_answer(request: Request[A], data: bytes) -> A:
    """What an answer's data field says to this request.

    Raises:
        PlcRefused: an error code.
        FrameError: no answer to this request, by length or content.
    """
    command = request.command
    fields = _FIELDS[command]
    chars = 1 + fields.chars(request)
    if len(data) == chars and data.startswith(_NO_ERROR) and command != Command.LOOPBACK:
        return cast("A", fields.parse_answer(request, data[1:]))
    one_letter_loopback = command == Command.LOOPBACK and chars == 1
    if len(data) == 1 and data != _NO_ERROR and data in HEX_DIGITS and not one_letter_loopback:
        raise refusal(int(data, 16), command, asked(request))
    if command == Command.LOOPBACK:
        return cast("A", data)
    if len(data) == chars:
        raise FrameError(f"expected the error character 0 before the data, got {data[:1]!r}", raw=data)
    if command in _ERROR_CHARACTER_MAY_LACK and len(data) == chars - 1:
        return cast("A", fields.parse_answer(request, data))
    raise FrameError(
        f"answer to {asked(request)}: expected {chars} characters of data, got {len(data)}", raw=data
    )


def answer_data(request: Request[A], answer: A) -> bytes:
    """The data field of the answer to a request, error character included but for 4E."""
    data = _FIELDS[request.command].answer(request, answer)
    return data if request.command == Command.LOOPBACK else _NO_ERROR + data


def echo_may_pass(request: Request[A]) -> bool:
    """True if a request's own data reads as an answer to it.

    The echo of 4E and of STOP reads as a good answer, so does that of one DD under 46 and of some under 48,
    which are all hex digits; that of RUN reads as error 1.
    """
    try:
        parse_answer(request, request_data(request))
    except FrameError:
        return False
    except PlcRefused:
        return True
    return True
