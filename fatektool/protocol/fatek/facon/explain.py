"""FACON frames explained: every byte belongs to a field, and every field says what it means.

A frame does not say whether it asks or answers. The direction in a trace tells; else what its data can be
read as. An answer does not say what was asked either, so the request before it, if there is one, names its
values.
"""

from __future__ import annotations

from typing import TYPE_CHECKING, Any, ClassVar, Final

from fatektool.errors import FrameError
from fatektool.protocol.commands import COMMAND_WORDS, Command
from fatektool.protocol.explain import Explanation, Field, Role
from fatektool.protocol.fatek.facon.codec import FaconDecoder, lrc
from fatektool.protocol.fatek.facon.data import parse_request, request_data
from fatektool.protocol.fatek.facon.explain_data import answer_fields, request_fields

if TYPE_CHECKING:
    from collections.abc import Iterator

    from fatektool.protocol.codec import Codec
    from fatektool.protocol.commands import Request

_SAYS_LITTLE: Final = "data that no paper describes"
_STATIONS: Final = {
    0x00: "all (broadcast), nobody answers",
    0xFF: "255, any PLC, or an Ethernet module",
}
_PIECE: Final = 1 << 15
"""What a decoder is fed at once: it keeps no more than 64 KiB, and a record of a trace may hold more."""


class FaconExplainer:
    """Explains a conversation, piece by piece, in the order it was spoken."""

    form: ClassVar[str] = "bytes from STX (02) to ETX (03)"
    binary: ClassVar[bool] = False

    def __init__(self, codec: Codec) -> None:
        del codec
        self._last: dict[tuple[int, int], Request[Any]] = {}

    def explain(self, data: bytes, role: Role = Role.EITHER) -> Iterator[Explanation]:
        """Explain all frames in a piece of the conversation, and the bytes that are none.

        Args:
            data: the bytes.
            role: REQUEST or ANSWER if the direction is known.
        """
        decoder = FaconDecoder()
        for at in range(0, len(data), _PIECE):
            decoder.feed(data[at : at + _PIECE])
            yield from self._frames(decoder, role)
        left = decoder.clear()
        if left:
            yield _no_frame(FrameError("cut off: no ETX (03)", raw=data[-left:]))

    def _frames(self, decoder: FaconDecoder, role: Role) -> Iterator[Explanation]:
        while True:
            try:
                frame = decoder.next_frame()
            except FrameError as error:
                yield self._frame(error.raw, role, error) if error.checksum else _no_frame(error)
                continue
            if frame is None:
                return
            yield self._frame(frame.raw, role, None)

    def _frame(self, raw: bytes, role: Role, damage: FrameError | None) -> Explanation:
        """Explain a frame that is whole in form; a damaged one says nothing about the conversation."""
        station, command, data = int(raw[1:3], 16), int(raw[3:5], 16), raw[5:-3]
        role, fields, fault, request = self._data(station, command, data, role)
        if damage is not None:
            role, fault = Role.BROKEN, damage.message
        elif request is not None:
            self._last[station, command] = request
        elif fault is None:
            self._last.pop((station, command), None)
        known = Command(command) if command in COMMAND_WORDS else None
        return Explanation(
            role,
            raw,
            (
                Field("STX", raw[:1], "start"),
                Field("station", raw[1:3], _STATIONS.get(station, f"{station}")),
                Field("command", raw[3:5], known.words if known else "not in the paper"),
                *fields,
                Field("LRC", raw[-3:-1], f"WRONG: expected {lrc(raw[:-3]).decode()}" if damage else "right"),
                Field("ETX", raw[-1:], "end"),
            ),
            station,
            command,
            damage is None,
            fault,
        )

    def _data(
        self, station: int, command: int, data: bytes, role: Role
    ) -> tuple[Role, tuple[Field, ...], str | None, Request[Any] | None]:
        """Read the data field as a request, as an answer, or as what it can be.

        Returns:
            What it is, its fields, what is wrong with it, and the request if it is one.
        """
        asked = self._last.get((station, command))
        fault = None
        request = None
        if role is not Role.ANSWER:
            try:
                request = parse_request(command, data)
            except FrameError as error:
                fault = error.message
        answer = None
        if role is not Role.REQUEST:
            try:
                answer = answer_fields(command, data, asked)
            except FrameError as error:
                fault = error.message if asked else fault or error.message
                if asked is not None and request_data(asked) == data:
                    request = asked  # a two-wire line echoes
        if request is not None and (asked is None or answer is None):
            either = role is Role.EITHER and answer is not None
            return Role.EITHER if either else Role.REQUEST, request_fields(request, data), None, request
        if answer is not None:
            return Role.ANSWER, answer, None, None
        return role, (Field("data", data, _SAYS_LITTLE),) if data else (), fault, None


def _no_frame(error: FrameError) -> Explanation:
    return Explanation(
        Role.BROKEN, error.raw, (Field("bytes", error.raw, error.message),), fault=error.message
    )
