"""Frames, checksums and error texts by the name of a protocol, for programs with their own connection.

::

    protocol       checksum                                 covers
    facon          LRC, two hex digits                      STX to the last data byte
    mseries        CRC-16/MODBUS, low byte first            length and payload
    modbus-rtu     CRC-16/MODBUS, low byte first            station and PDU
    modbus-ascii   LRC, two hex digits                      station and PDU as bytes, not as digits
    modbus-tcp     none; the network has its own
"""

from __future__ import annotations

from typing import TYPE_CHECKING, Any, TypeVar

from fatektool.errors import UsageError
from fatektool.protocol.registry import codec_named

if TYPE_CHECKING:
    from fatektool.protocol.commands import Request

A = TypeVar("A")


def frame(request: Request[Any], station: int = 1, protocol: str = "facon", *, number: int = 0) -> bytes:
    """A request as a frame, as sent on the wire.

    Args:
        request: what is asked: a value of ``fatektool.protocol.commands``, such as the ``request`` of what
            ``fatektool.parse_command`` returns.
        station: of the PLC; 0 for a broadcast.
        protocol: a name of ``--protocol``.
        number: of a Modbus TCP request, which its answer repeats; 0 for the others.

    Raises:
        UsageError: no such protocol, or it has no such request.
    """
    return codec_named(protocol).encode(station, request, number)


def answer_frame(
    request: Request[A], answer: A, station: int = 1, protocol: str = "facon", *, number: int = 0
) -> bytes:
    """The frame of a PLC with this answer to a request; the arguments are those of ``frame``.

    Raises:
        UsageError: no such protocol, or it has no such request.
    """
    codec = codec_named(protocol)
    codec.encode(station, request, number)  # an invalid request has no answer
    return codec.encode_answer(station, request, answer, number)


def raw_frame(
    command: int,
    data: bytes,
    station: int = 1,
    protocol: str = "facon",
    *,
    answer: bool = False,
    number: int = 0,
) -> bytes:
    """Any command with any data as a frame, also a command that the protocol does not have.

    Args:
        command: the command's code, 0 to 255; in Modbus the function.
        data: the bytes between command and checksum; of an answer with its error code.
        station: 0 for all of them.
        protocol: a name of ``--protocol``.
        answer: True for an answer, which has another form in the M-series.
        number: of a Modbus TCP request.

    Raises:
        UsageError: no such protocol, or it does not fit into a frame.
    """
    codec = codec_named(protocol)
    if not 0 <= command <= 0xFF:
        raise UsageError(f"command: expected 00 to FF, got {command:X}")
    return codec.encode_raw(station, command, data, number, answer=answer)


def error_frame(
    command: int, code: int, station: int = 1, protocol: str = "facon", *, number: int = 0
) -> bytes:
    """The answer that refuses a command.

    Args:
        command: of the request; in Modbus the function.
        code: the error code: 1 to F in FACON, 1 to FF in the others.
        station: of the PLC that refuses.
        protocol: a name of ``--protocol``.
        number: of a Modbus TCP request.

    Raises:
        UsageError: no such protocol or code.
    """
    codec = codec_named(protocol)
    if not 1 <= code <= codec.last_error:
        raise UsageError(f"error code: expected 1 to {codec.last_error:X}, got {code:X}")
    return codec.encode_refusal(station, command, code, number)


def checksum(data: bytes, protocol: str = "facon") -> bytes:
    """The checksum of some bytes, as sent.

    Args:
        data: the bytes that it covers: see the table above. FACON's begins with STX (02).
        protocol: a name of ``--protocol``.

    Raises:
        UsageError: no such protocol, or it has no checksum.
    """
    return codec_named(protocol).checksum(data)


def error_text(code: int, protocol: str = "facon") -> str:
    """The meaning of an error code in an answer.

    Args:
        code: 0 for no error.
        protocol: a name of ``--protocol``.

    Raises:
        UsageError: no such protocol.
    """
    codec = codec_named(protocol)
    return codec.error_text(code) if code else "no error"
