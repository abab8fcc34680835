"""M-series frames explained: every byte belongs to a field, and every field says what it means.

A frame's header says whether it asks or answers. An answer does not say what was asked, so the request before
it, if there is one, names its values.
"""

from __future__ import annotations

from typing import TYPE_CHECKING, Any, ClassVar, Final

from fatektool.errors import FrameError
from fatektool.protocol.commands import Command
from fatektool.protocol.explain import Explanation, Field, Role
from fatektool.protocol.fatek.mseries.codec import QUERY, RESPONSE, MseriesDecoder
from fatektool.protocol.fatek.mseries.crc import crc_bytes
from fatektool.protocol.fatek.mseries.data import COMMANDS, parse_request
from fatektool.protocol.fatek.mseries.explain_data import answer_fields, request_fields

if TYPE_CHECKING:
    from collections.abc import Iterator

    from fatektool.protocol.codec import Codec
    from fatektool.protocol.commands import Request

_SAYS_LITTLE: Final = "data that no paper describes"
_STATIONS: Final = {
    0x00: "all (broadcast), nobody answers",
    0xFF: "255, any PLC, or an Ethernet module",
}
_HEADERS: Final = {QUERY: Role.REQUEST, RESPONSE: Role.ANSWER}
_PIECE: Final = 1 << 15
"""What a decoder is fed at once: it keeps no more than 64 KiB, and a record of a trace may hold more."""


class MseriesExplainer:
    """Explains a conversation, piece by piece, in the order it was spoken."""

    form: ClassVar[str] = "51 10 or 52 10, a length and as many bytes, a CRC, 55 AA"
    binary: ClassVar[bool] = True

    def __init__(self, codec: Codec) -> None:
        del codec
        self._last: dict[tuple[int, int], Request[Any]] = {}

    def explain(
        self,
        data: bytes,
        role: Role = Role.EITHER,  # noqa: ARG002  # the interface's; here the frame itself says
    ) -> Iterator[Explanation]:
        """Explain all frames in a piece of the conversation, and the bytes that are none.

        Args:
            data: the bytes.
            role: what the direction says; a frame's own header says it better.
        """
        decoder = MseriesDecoder()
        for at in range(0, len(data), _PIECE):
            decoder.feed(data[at : at + _PIECE])
            yield from self._frames(decoder)
        if decoder.expect_no_more():
            yield from self._frames(decoder)

    def _frames(self, decoder: MseriesDecoder) -> Iterator[Explanation]:
        while True:
            try:
                frame = decoder.next_frame()
            except FrameError as error:
                yield self._frame(error.raw, error) if error.checksum else _no_frame(error)
                continue
            if frame is None:
                return
            yield self._frame(frame.raw, None)

    def _frame(self, raw: bytes, damage: FrameError | None) -> Explanation:
        """Explain a frame that is whole in form; a damaged one says nothing about the conversation."""
        role, station, command, data = _HEADERS[raw[0]], raw[4], raw[5], raw[6:-4]
        asked = self._last.get((station, command))
        fields: tuple[Field, ...] = (Field("data", data, _SAYS_LITTLE),) if data else ()
        fault = None
        try:
            if role is Role.REQUEST:
                asked = parse_request(command, data)
                fields = request_fields(asked, data)
            else:
                fields = answer_fields(command, data, asked)
        except FrameError as error:
            fault = error.message
        if damage is not None:
            fault = damage.message
        elif role is Role.REQUEST and fault is None and asked is not None:
            self._last[station, command] = asked
        elif fault is None:
            self._last.pop((station, command), None)
        expected = crc_bytes(raw[2:-4]).hex(" ").upper()
        return Explanation(
            role if damage is None else Role.BROKEN,
            raw,
            (
                Field("header", raw[:1], role.value),
                Field("ID", raw[1:2], "binary protocol"),
                Field("length", raw[2:4], f"{len(data) + 2} bytes of payload"),
                Field("station", raw[4:5], _STATIONS.get(station, f"{station}")),
                Field("command", raw[5:6], _words(command)),
                *fields,
                Field("CRC", raw[-4:-2], "right" if damage is None else f"WRONG: expected {expected}"),
                Field("terminator", raw[-2:], "end"),
            ),
            station,
            command,
            damage is None,
            fault,
        )


def _words(command: int) -> str:
    return Command(command).words if command in COMMANDS else "not in the paper"


def _no_frame(error: FrameError) -> Explanation:
    return Explanation(
        Role.BROKEN, error.raw, (Field("bytes", error.raw, error.message),), fault=error.message
    )
