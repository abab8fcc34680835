"""A frame explained, field by field, for people: ``decode``, and who reads a trace."""

from __future__ import annotations

from dataclasses import dataclass
from enum import Enum
from typing import TYPE_CHECKING, Protocol

if TYPE_CHECKING:
    from collections.abc import Iterator


class FrameRole(Enum):
    """What a frame is in the conversation."""

    REQUEST = "request"
    ANSWER = "answer"
    EITHER = "request or answer"
    BROKEN = "broken"


@dataclass(frozen=True, slots=True)
class Field:
    """One field of a frame.

    Attributes:
        name: the protocol's word for it.
        raw: its bytes.
        meaning: what they say.
    """

    name: str
    raw: bytes
    meaning: str


@dataclass(frozen=True, slots=True)
class Explanation:
    """One frame, or bytes that are none.

    Attributes:
        role: what it is.
        raw: all its bytes.
        fields: the bytes, divided; together they are ``raw``.
        station: who is asked or who answers; None for no frame.
        command: the command's code; None for no frame.
        checksum_ok: None where there is none.
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
    """Explains a conversation of one protocol, piece by piece, in the order it was sent."""

    @property
    def form(self) -> str:
        """What a frame looks like, in words."""

    @property
    def binary(self) -> bool:
        """True if its bytes are better shown as hex than as characters."""

    def explain(self, data: bytes, role: FrameRole = FrameRole.EITHER) -> Iterator[Explanation]:
        """Explain all frames in a piece of the conversation, and the bytes that are none.

        Args:
            data: the bytes.
            role: REQUEST or ANSWER if the direction is known.
        """
