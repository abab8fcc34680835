"""Explanations of FACON and M-series frames: every byte belongs to a field with a meaning.

An answer does not contain its request, so its values are named by the request before it, if there is one. An
M-series frame shows whether it is a request or an answer; for a FACON frame this is known from the direction
in a trace, else from the form of its data.
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
    0x00: "broadcast to all PLCs, none answers",
    0xFF: "255, any PLC, or an Ethernet module",
}
_PIECE: Final = 1 << 15
"""The bytes given to a decoder at once: it keeps at most 64 KiB, and a record of a trace may have more."""


class FatekExplainer(ABC):
    """Explains frames, piece by piece, in the order in which they were sent.

    Attributes:
        form: the form of a frame, as text.
        binary: True if its bytes should be shown as hex, not as characters.
        cut_off: the message for an incomplete frame at the end.
    """

    form: ClassVar[str]
    binary: ClassVar[bool]
    cut_off: ClassVar[str]

    def __init__(self, codec: FatekCodec) -> None:
        self.codec = codec
        self._last: dict[tuple[int, int], Request[Any]] = {}

    def explain(self, data: bytes, role: FrameRole = FrameRole.EITHER) -> Iterator[Explanation]:
        """Explain all frames in a piece of the trace, and the bytes outside frames.

        Args:
            data: the bytes.
            role: REQUEST or ANSWER if the direction is known; what a frame itself shows has priority.
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
        """The role that the frame itself shows; else ``role``."""

    @abstractmethod
    def place(self, raw: bytes) -> tuple[int, int, bytes]:
        """Station, command and data of a frame with a complete form."""

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
        """Explain a frame with a complete form; a damaged one does not change the role of others."""
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
        """Parse the data field as a request, as an answer, or as either.

        Returns:
            The role, the fields, what is wrong, and the request if it is one.
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
        """True for the echo of a two-wire line, if requests and answers have the same form."""
        return self.codec.same_form and self.codec.data.request_data(asked) == data


def _no_frame(error: FrameError) -> Explanation:
    return Explanation(
        FrameRole.BROKEN, error.raw, (Field("bytes", error.raw, error.message),), fault=error.message
    )
