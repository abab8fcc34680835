"""FACON and M-series frames explained: every byte belongs to a field, and every field says what it means.

An answer does not say what was asked, so the request before it, if there is one, names its values. An
M-series frame says whether it asks or answers; of a FACON frame the direction in a trace says it, else what
its data can be read as.
"""

from __future__ import annotations

from abc import ABC, abstractmethod
from typing import TYPE_CHECKING, Any, ClassVar, Final

from fatektool.errors import FrameError
from fatektool.protocol.commands import Command
from fatektool.protocol.explain import Explanation, Field, FrameRole
from fatektool.protocol.fatek.explain_data import answer_fields, request_fields

if TYPE_CHECKING:
    from collections.abc import Iterator

    from fatektool.protocol.codec import Decoder
    from fatektool.protocol.commands import Request
    from fatektool.protocol.fatek.codec import FatekCodec

_SAYS_LITTLE: Final = "data that no paper describes"
_STATIONS: Final = {
    0x00: "all (broadcast), no PLC answers",
    0xFF: "255, any PLC, or an Ethernet module",
}
_PIECE: Final = 1 << 15
"""What a decoder is fed at once: it keeps no more than 64 KiB, and a record of a trace may hold more."""


class FatekExplainer(ABC):
    """Explains a conversation, piece by piece, in the order it was sent.

    Attributes:
        form: what a frame looks like, in words.
        binary: True if its bytes are better shown as hex than as characters.
        cut_off: what is said of bytes at the end that began a frame.
    """

    form: ClassVar[str]
    binary: ClassVar[bool]
    cut_off: ClassVar[str]

    def __init__(self, codec: FatekCodec) -> None:
        self.codec = codec
        self._last: dict[tuple[int, int], Request[Any]] = {}

    def explain(self, data: bytes, role: FrameRole = FrameRole.EITHER) -> Iterator[Explanation]:
        """Explain all frames in a piece of the conversation, and the bytes that are none.

        Args:
            data: the bytes.
            role: REQUEST or ANSWER if the direction is known; where a frame itself says it, that counts.
        """
        decoder = self.codec.decoder()
        for at in range(0, len(data), _PIECE):
            decoder.feed(data[at : at + _PIECE])
            yield from self._frames(decoder, role)
        if decoder.expect_no_more():
            yield from self._frames(decoder, role)
        left = decoder.clear()
        if left:
            yield _no_frame(FrameError(self.cut_off, raw=data[-left:]))

    @abstractmethod
    def role_of(self, raw: bytes, role: FrameRole) -> FrameRole:
        """What a frame says that it is; else what is known."""

    @abstractmethod
    def place(self, raw: bytes) -> tuple[int, int, bytes]:
        """Station, command and data of a frame that is whole in form."""

    @abstractmethod
    def around(
        self, raw: bytes, station: str, command: str, data: tuple[Field, ...], *, damaged: bool
    ) -> tuple[Field, ...]:
        """All fields of a frame, in order."""

    def _frames(self, decoder: Decoder, role: FrameRole) -> Iterator[Explanation]:
        while True:
            try:
                frame = decoder.next_frame()
            except FrameError as error:
                yield self._frame(error.raw, role, error) if error.checksum else _no_frame(error)
                continue
            if frame is None:
                return
            yield self._frame(frame.raw, role, None)

    def _frame(self, raw: bytes, role: FrameRole, damage: FrameError | None) -> Explanation:
        """Explain a frame that is whole in form; a damaged one says nothing about the conversation."""
        station, command, data = self.place(raw)
        role, fields, fault, request = self._data(station, command, data, self.role_of(raw, role))
        if damage is not None:
            role, fault = FrameRole.BROKEN, damage.message
        elif request is not None:
            self._last[station, command] = request
        elif fault is None:
            self._last.pop((station, command), None)
        known = command in self.codec.data.rows
        return Explanation(
            role,
            raw,
            self.around(
                raw,
                _STATIONS.get(station, f"{station}"),
                Command(command).words if known else "not in the paper",
                fields,
                damaged=damage is not None,
            ),
            station,
            command,
            damage is None,
            fault,
        )

    def _data(
        self, station: int, command: int, data: bytes, role: FrameRole
    ) -> tuple[FrameRole, tuple[Field, ...], str | None, Request[Any] | None]:
        """Read the data field as a request, as an answer, or as what it can be.

        Returns:
            What it is, its fields, what is wrong with it, and the request if it is one.
        """
        asked = self._last.get((station, command))
        fault = None
        request = None
        if role is not FrameRole.ANSWER:
            try:
                request = self.codec.data.parse_request(command, data)
            except FrameError as error:
                fault = error.message
        answer = None
        if role is not FrameRole.REQUEST:
            try:
                answer = answer_fields(self.codec, command, data, asked)
            except FrameError as error:
                fault = error.message if asked else fault or error.message
                if asked is not None and self._is_echo(asked, data):
                    request = asked
        if request is not None and (asked is None or answer is None):
            either = role is FrameRole.EITHER and answer is not None
            fields = request_fields(self.codec, request, data)
            return FrameRole.EITHER if either else FrameRole.REQUEST, fields, None, request
        if answer is not None:
            return FrameRole.ANSWER, answer, None, None
        return role, (Field("data", data, _SAYS_LITTLE),) if data else (), fault, None

    def _is_echo(self, asked: Request[Any], data: bytes) -> bool:
        """True for what a two-wire line gives back, where requests and answers have the same form."""
        return self.codec.same_form and self.codec.data.request_data(asked) == data


def _no_frame(error: FrameError) -> Explanation:
    return Explanation(
        FrameRole.BROKEN, error.raw, (Field("bytes", error.raw, error.message),), fault=error.message
    )
