"""Explanations of FACON frames."""

from __future__ import annotations

from typing import TYPE_CHECKING, ClassVar

from fatektool.protocol.explain import Field
from fatektool.protocol.fatek.explain import FatekExplainer
from fatektool.protocol.fatek.facon.codec import lrc

if TYPE_CHECKING:
    from fatektool.protocol.explain import FrameRole


class FaconExplainer(FatekExplainer):
    """Explains FACON frames."""

    form: ClassVar[str] = "bytes from STX (02) to ETX (03)"
    binary: ClassVar[bool] = False
    cut_off: ClassVar[str] = "cut off: no ETX (03)"

    def role_of(self, raw: bytes, role: FrameRole) -> FrameRole:
        """``role``: the frame itself does not show it."""
        del raw
        return role

    def place(self, raw: bytes) -> tuple[int, int, bytes]:
        """Station, command and data."""
        return int(raw[1:3], 16), int(raw[3:5], 16), raw[5:-3]

    def around(
        self, raw: bytes, station: str, command: str, data: tuple[Field, ...], *, damaged: bool
    ) -> tuple[Field, ...]:
        """STX to ETX."""
        return (
            Field("STX", raw[:1], "start"),
            Field("station", raw[1:3], station),
            Field("command", raw[3:5], command),
            *data,
            Field("LRC", raw[-3:-1], f"WRONG: expected {lrc(raw[:-3]).decode()}" if damaged else "right"),
            Field("ETX", raw[-1:], "end"),
        )
