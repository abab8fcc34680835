"""The data field of each M-series command (M-series paper, section 2.5).

There is no program command: 4F and 50 are FACON's.

53 is listed without a layout. An answer of 64 bytes is parsed as FACON's, and marked as assumed; of another
length it is kept as bytes.
"""

from __future__ import annotations

from typing import Final

from fatektool.protocol.commands import (
    BRIEF_BYTES,
    DETAILED_BYTES,
    Command,
    ReadBriefStatus,
    ReadDetailedStatus,
)
from fatektool.protocol.fatek.codec import DataFields
from fatektool.protocol.fatek.fields import ROWS, CommandRow, parse_empty
from fatektool.protocol.fatek.mseries.bytes import BINARY
from fatektool.protocol.fatek.mseries.errors import refusal
from fatektool.protocol.status import BriefStatus, DetailedStatus, RawStatus


def _detailed(data: bytes) -> DetailedStatus | RawStatus:
    if len(data) == DETAILED_BYTES:
        return DetailedStatus.parse(data, assumed=True)
    return RawStatus(data)


DATA: Final = DataFields(
    BINARY,
    {
        Command.BRIEF_STATUS: CommandRow(
            lambda _w, _r: b"",
            parse_empty(ReadBriefStatus),
            lambda _w, _r: BRIEF_BYTES,
            lambda _w, _r, data: BriefStatus.parse(data, m_series=True),
            lambda _w, _r, answer: answer.to_bytes(),
        ),
        **ROWS,
        Command.DETAILED_STATUS: CommandRow(
            lambda _w, _r: b"",
            parse_empty(ReadDetailedStatus),
            lambda _w, _r: DETAILED_BYTES,
            lambda _w, _r, data: _detailed(data),
            lambda _w, _r, answer: answer.raw,
        ),
    },
    refusal,
    "the M-series paper",
    any_size=frozenset({Command.DETAILED_STATUS}),
)
