"""What to say when no answer came: what was heard instead, and what to look at first."""

from __future__ import annotations

from typing import TYPE_CHECKING, TypeVar

from fatektool.errors import NoAnswer
from fatektool.protocol.plc_errors import PROGRAM_COMMANDS, PROGRAM_REFUSED

if TYPE_CHECKING:
    from fatektool.protocol.commands import Request

A = TypeVar("A")


def no_answer(
    request: Request[A],
    heard: str,
    *,
    station: int,
    target: str,
    line: str,
    tries: int,
    timeout_s: float,
    alive: bool = False,
    served: bool = False,
    unknown: bool = False,
    fence: str = "loopbacks",
) -> NoAnswer:
    """The error for a request that found no answer to trust.

    Args:
        request: what was asked.
        heard: what came instead of an answer; empty for silence.
        station: who was asked.
        target: where.
        line: speed and format of the line, or the protocol where it has none.
        tries: how often it was asked at most.
        timeout_s: the PLC's time to answer.
        alive: True if the PLC has answered fences in between.
        served: True if it has answered this command before.
        unknown: True for a write that could not be read back.
        fence: what fences are, in a word.
    """
    said = f"heard {heard}" if heard else "nothing heard"
    if alive:
        said = f"it answers {fence}, but not this; {said}"
    if unknown:
        said += "; whether the PLC took it is not known"
    return NoAnswer(
        f"no answer from station {station} on {target} ({line}) to '{request.command.words}' "
        f"({request.command:02X}) in {tries} {'try' if tries == 1 else 'tries'} of {timeout_s:g} s: {said}",
        hint=_advice(request, heard, alive=alive, served=served),
        station=station,
        target=target,
        heard=heard or None,
    )


def _advice(request: Request[A], heard: str, *, alive: bool, served: bool) -> str:
    if alive and request.command in PROGRAM_COMMANDS and not served:
        return PROGRAM_REFUSED
    if "station" in heard:
        return "check --station"
    if "own request" in heard:
        return "the PLC is silent: is it on, are A and B the right way round, is the station right?"
    if alive:
        return "the PLC is slow or the line loses frames: try a longer --timeout, more --retries"
    if heard:
        return "check --baud, --format and --protocol, and the line's termination and shield"
    return "is the PLC on and the cable in? Check station, baud and format (factory: station 1, 9600 7E1)"
