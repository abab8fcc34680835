"""FACON frames explained: every byte belongs to a field, and every field says what it means.

A frame does not say whether it asks or answers. The direction in a trace tells; else what its data can be
read as. An answer does not say what was asked either, so the request before it, if there is one, names its
values.
"""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

from fatektool.errors import FrameError
from fatektool.protocol.commands import COMMAND_WORDS, Command
from fatektool.protocol.explain import Explanation, Field, Role
from fatektool.protocol.facon import FaconDecoder, lrc
from fatektool.protocol.facon_data import parse_request
from fatektool.protocol.facon_explain_data import answer_fields, request_fields

if TYPE_CHECKING:
    from collections.abc import Iterator

    from fatektool.protocol.commands import Request

_SAYS_LITTLE = "data that no paper describes"


class FaconExplainer:
    """Explains a conversation, piece by piece, in the order it was spoken."""

    def __init__(self) -> None:
        self._last: dict[tuple[int, int], Request[Any]] = {}

    def explain(self, data: bytes, role: Role = Role.EITHER) -> Iterator[Explanation]:
        """Explain all frames in a piece of the conversation, and the bytes that are none.

        Args:
            data: the bytes.
            role: REQUEST or ANSWER if the direction is known.
        """
        decoder = FaconDecoder()
        decoder.feed(data)
        while True:
            try:
                frame = decoder.next_frame()
            except FrameError as error:
                yield self._frame(error.raw, role, error) if error.checksum else _no_frame(error)
                continue
            if frame is None:
                break
            yield self._frame(frame.raw, role, None)
        left = decoder.clear()
        if left:
            yield _no_frame(FrameError("cut off: no ETX (03)", raw=data[-left:]))

    def _frame(self, raw: bytes, role: Role, error: FrameError | None) -> Explanation:
        try:
            station, command = int(raw[1:3], 16), int(raw[3:5], 16)
        except ValueError:
            return _no_frame(FrameError("station or command is not two hex digits", raw=raw))
        data = raw[5:-3]
        role, fields, fault = self._data(station, command, data, role)
        expected = lrc(raw[:-3])
        got = raw[-3:-1]
        checksum = "right" if error is None else f"WRONG: expected {expected.decode()}"
        known = Command(command) if command in COMMAND_WORDS else None
        return Explanation(
            role if error is None else Role.BROKEN,
            raw,
            (
                Field("STX", raw[:1], "start"),
                Field(
                    "station", raw[1:3], "all (broadcast), nobody answers" if not station else f"{station}"
                ),
                Field("command", raw[3:5], known.words if known else "not in the paper"),
                *fields,
                Field("LRC", got, checksum),
                Field("ETX", raw[-1:], "end"),
            ),
            station,
            command,
            error is None,
            error.message if error is not None else fault,
        )

    def _data(
        self, station: int, command: int, data: bytes, role: Role
    ) -> tuple[Role, tuple[Field, ...], str | None]:
        """Read the data field as a request, as an answer, or as what it can be."""
        fault = None
        request = None
        if role is not Role.ANSWER:
            try:
                request = parse_request(command, data)
            except FrameError as error:
                fault = error.message
        asked = self._last.get((station, command))
        answer = None
        if role is not Role.REQUEST:
            try:
                answer = answer_fields(command, data, asked)
            except FrameError as error:
                fault = fault or error.message
        if request is not None and (role is Role.REQUEST or asked is None or answer is None):
            self._last[station, command] = request
            either = role is Role.EITHER and answer is not None and command != Command.BRIEF_STATUS
            return (Role.EITHER if either else Role.REQUEST), request_fields(request, data), None
        if answer is not None:
            self._last.pop((station, command), None)
            return Role.ANSWER, answer, None
        rest = (Field("data", data, _SAYS_LITTLE),) if data else ()
        return role, rest, fault


def _no_frame(error: FrameError) -> Explanation:
    return Explanation(
        Role.BROKEN, error.raw, (Field("bytes", error.raw, error.message),), fault=error.message
    )
