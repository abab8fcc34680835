"""Explanations of frames, field by field, for ``decode`` and readers of traces."""

from __future__ import annotations

from dataclasses import dataclass
from enum import Enum
from typing import TYPE_CHECKING, Protocol

if TYPE_CHECKING:
    from collections.abc import Iterator


class FrameRole(Enum):
    """The role of a frame: request, answer, or unknown."""

    REQUEST = "request"
    ANSWER = "answer"
    EITHER = "request or answer"
    BROKEN = "broken"


@dataclass(frozen=True, slots=True)
class Field:
    """One field of a frame.

    Attributes:
        name: as in the protocol's paper.
        raw: its bytes.
        meaning: of these bytes.
    """

    name: str
    raw: bytes
    meaning: str


@dataclass(frozen=True, slots=True)
class Explanation:
    """One frame, or bytes that are not a frame.

    Attributes:
        role: request, answer, or unknown.
        raw: all its bytes.
        fields: the parts of the bytes; together they are ``raw``.
        station: of the PLC that is asked or answers; None if not a frame.
        command: the command's code; None if not a frame.
        checksum_ok: None if there is no checksum.
        fault: what is wrong, None if nothing is.
    """

    role: FrameRole
    raw: bytes
    fields: tuple[Field, ...]
    station: int | None = None
    command: int | None = None
    checksum_ok: bool | None = None
    fault: str | None = None


class Explainer(Protocol):
    """Explains the frames of one protocol, piece by piece, in the order in which they were sent."""

    @property
    def form(self) -> str:
        """The form of a frame, as text."""

    @property
    def binary(self) -> bool:
        """True if its bytes should be shown as hex, not as characters."""

    def explain(self, data: bytes, role: FrameRole = FrameRole.EITHER) -> Iterator[Explanation]:
        """Explain all frames in a piece of the trace, and the bytes outside frames.

        Args:
            data: the bytes.
            role: REQUEST or ANSWER if the direction is known.
        """
