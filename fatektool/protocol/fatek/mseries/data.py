"""The data field of each M-series command (M-series paper, section 2.5).

There is no program command: 4F and 50 are FACON's.

53 is listed without a layout. Its answer is taken for FACON's where it has 64 bytes, and marked as assumed;
of any other length it is kept raw.
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
