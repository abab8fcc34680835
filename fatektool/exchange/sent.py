"""A request as sent, with what its answer must contain."""

from __future__ import annotations

from typing import TYPE_CHECKING, NamedTuple

if TYPE_CHECKING:
    from fatektool.protocol.codec import Frame


class Sent(NamedTuple):
    """A request as sent, with what its answer must contain.

    Attributes:
        raw: the frame.
        station: of the PLC.
        code: the command code in the frame.
        number: the transaction number; 0 if the protocol has none.
        size: expected length of the answer, in bytes.
        data: the data that the answer to a loopback must return; None for any other request.
    """

    raw: bytes
    station: int
    code: int
    number: int
    size: int
    data: bytes | None

    def answered_by(self, frame: Frame) -> bool:
        """True if station, command and transaction number of a frame are those of the answer."""
        return (frame.station, frame.command, frame.number) == (self.station, self.code, self.number)
