"""What FACON and the M-series have in common as codecs: the fourteen commands, their limits, 4E as fence."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any, Final

from fatektool.protocol.commands import (
    MAX_MIXED_WRITE_WORDS,
    MAX_READ_WORDS,
    Loopback,
    ReadBriefStatus,
    run_limit,
)
from fatektool.protocol.elements import KINDS

if TYPE_CHECKING:
    from collections.abc import Collection

    from fatektool.protocol.commands import Request
    from fatektool.protocol.elements import Element


class FatekCommands:
    """The part of a ``Codec`` that does not depend on how a frame is written."""

    stations: Final = range(1, 255)
    numbers: Final = 1
    quiet_chars: Final = 0.0
    probe: Final[Request[Any]] = ReadBriefStatus()

    def code(self, request: Request[Any]) -> int:
        """The command's code."""
        return request.command

    def neighbourhood(self, element: Element, *, writes: bool) -> int:  # noqa: ARG002  # the interface's
        """All elements have their place."""
        return 0

    def most(self, symbol: str, *, writes: bool) -> int:  # noqa: ARG002  # the same both ways
        """How many elements of a kind one run holds."""
        return run_limit(KINDS[symbol])

    def mixed_words(self, *, writes: bool) -> int:
        """How many words one mixed request holds."""
        return MAX_MIXED_WRITE_WORDS if writes else MAX_READ_WORDS

    def shape(self, request: Request[Any]) -> bytes:  # noqa: ARG002  # the interface's
        """Nothing: a fence is known by its nonce."""
        return b""

    def fence(self, nonce: bytes, asked: Collection[bytes] | None) -> Request[Any]:  # noqa: ARG002  # the interface's
        """A loopback (4E) with a nonce."""
        return Loopback(nonce)
