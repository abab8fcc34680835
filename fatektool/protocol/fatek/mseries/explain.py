"""Explanations of M-series frames."""

from __future__ import annotations

from typing import ClassVar, Final

from fatektool.protocol.explain import Field, FrameRole
from fatektool.protocol.fatek.explain import FatekExplainer
from fatektool.protocol.fatek.mseries.codec import QUERY, RESPONSE
from fatektool.protocol.fatek.mseries.crc import crc_bytes

_HEADERS: Final = {QUERY: FrameRole.REQUEST, RESPONSE: FrameRole.ANSWER}


class MseriesExplainer(FatekExplainer):
    """Explains M-series frames."""

    form: ClassVar[str] = "51 10 or 52 10, a length and as many bytes, a CRC, 55 AA"
    binary: ClassVar[bool] = True
    cut_off: ClassVar[str] = "an incomplete frame"

    def role_of(self, raw: bytes, role: FrameRole) -> FrameRole:
        """The role by the header."""
        del role
        return _HEADERS[raw[0]]

    def place(self, raw: bytes) -> tuple[int, int, bytes]:
        """Station, command and data."""
        return raw[4], raw[5], raw[6:-4]

    def around(
        self, raw: bytes, station: str, command: str, data: tuple[Field, ...], *, damaged: bool
    ) -> tuple[Field, ...]:
        """Header to terminator."""
        expected = crc_bytes(raw[2:-4]).hex(" ").upper()
        return (
            Field("header", raw[:1], self.role_of(raw, FrameRole.EITHER).value),
            Field("ID", raw[1:2], "binary protocol"),
            Field("length", raw[2:4], f"{int.from_bytes(raw[2:4], 'big')} bytes of payload"),
            Field("station", raw[4:5], station),
            Field("command", raw[5:6], command),
            *data,
            Field("CRC", raw[-4:-2], f"WRONG: expected {expected}" if damaged else "right"),
            Field("terminator", raw[-2:], "end"),
        )
