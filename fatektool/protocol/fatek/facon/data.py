"""The data field of each FACON command (FACON paper, section 4.2).

The paper's figures of 4F and 53 have no error character, but its example has one, so both are accepted: the
length shows which it is.
"""

from __future__ import annotations

from typing import TYPE_CHECKING, Final

from fatektool.errors import FrameError
from fatektool.protocol.commands import (
    BRIEF_BYTES,
    DETAILED_BYTES,
    PAGE_BYTES,
    Command,
    ReadBriefStatus,
    ReadDetailedStatus,
    ReadPage,
    WritePage,
)
from fatektool.protocol.fatek.codec import DataFields
from fatektool.protocol.fatek.facon.text import TEXT
from fatektool.protocol.fatek.fields import ROWS, CommandRow, acknowledged, parse_empty

if TYPE_CHECKING:
    from fatektool.errors import PlcRefused
    from fatektool.protocol.fatek.notation import Notation
    from fatektool.protocol.status import BriefStatus, DetailedStatus


def _brief(chars: bytes) -> BriefStatus:
    from fatektool.protocol.status import BriefStatus  # loaded after the request is sent

    return BriefStatus.parse(TEXT.take_octets(chars))


def _detailed(chars: bytes) -> DetailedStatus:
    from fatektool.protocol.status import DetailedStatus  # likewise

    return DetailedStatus.parse(TEXT.take_octets(chars))


def _refusal(code: int, command: int, asked: str) -> PlcRefused:
    from fatektool.protocol.plc_errors import refusal  # the words of errors are loaded with the first

    return refusal(code, command, asked)


def _page_number(data: bytes) -> int:
    page = TEXT.take_octets(data[:4])
    if len(page) != 2:
        raise FrameError("expected a page number of 4 hex digits", raw=data)
    return int.from_bytes(page, "big")


def _parse_read_page(w: Notation, data: bytes) -> ReadPage:
    w.nothing_after(data[4:])
    return ReadPage(_page_number(data))


def _parse_write_page(w: Notation, data: bytes) -> WritePage:
    return WritePage(_page_number(data), w.take_octets(data[4:]))


DATA: Final = DataFields(
    TEXT,
    {
        Command.BRIEF_STATUS: CommandRow(
            lambda _w, _r: b"",
            parse_empty(ReadBriefStatus),
            lambda _w, _r: 2 * BRIEF_BYTES,
            lambda _w, _r, chars: _brief(chars),
            lambda w, _, answer: w.octets(answer.to_bytes()),
        ),
        **ROWS,
        Command.READ_PAGE: CommandRow(
            lambda _, r: b"%04X" % r.page,
            _parse_read_page,
            lambda _w, _r: 2 * PAGE_BYTES,
            lambda w, _, chars: w.take_octets(chars),
            lambda w, _, data: w.octets(data),
        ),
        Command.WRITE_PAGE: acknowledged(
            lambda w, r: b"%04X%b" % (r.page, w.octets(r.data)), _parse_write_page
        ),
        Command.DETAILED_STATUS: CommandRow(
            lambda _w, _r: b"",
            parse_empty(ReadDetailedStatus),
            lambda _w, _r: 2 * DETAILED_BYTES,
            lambda _w, _r, chars: _detailed(chars),
            lambda w, _, answer: w.octets(answer.raw),
        ),
    },
    _refusal,
    "the paper",
    error_optional=frozenset({Command.READ_PAGE, Command.DETAILED_STATUS}),
)
