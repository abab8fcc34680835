"""Frames, checksums and error texts by the name of a protocol, for whoever sends and reads bytes himself.

::

    protocol       checksum                                 covers
    facon          LRC, two hex digits                      STX to the last data byte
    mseries        CRC-16/MODBUS, low byte first            length and payload
    modbus-rtu     CRC-16/MODBUS, low byte first            station and PDU
    modbus-ascii   LRC, two hex digits                      station and PDU as bytes, not as digits
    modbus-tcp     none; the network has its own
"""

from __future__ import annotations

from typing import TYPE_CHECKING, Any, Final, TypeVar

from fatektool.errors import UsageError
from fatektool.protocol.registry import Codecs

if TYPE_CHECKING:
    from fatektool.protocol.codec import Codec
    from fatektool.protocol.commands import Request
    from fatektool.protocol.modbus.codec import ModbusCodec

A = TypeVar("A")

_CODECS: Final = Codecs()
_MODBUS: Final = "modbus-"
_REFUSED: Final = 0x80


def codec_of(protocol: str) -> Codec:
    """The codec of a protocol.

    Raises:
        UsageError: there is no such protocol.
    """
    if protocol not in _CODECS:
        raise UsageError(f"protocol: expected one of {', '.join(_CODECS)}, got {protocol!r}")
    return _CODECS[protocol]


def frame(request: Request[Any], station: int = 1, protocol: str = "facon", *, number: int = 0) -> bytes:
    """A request as the frame that goes over the wire.

    Args:
        request: what is asked: a value of ``fatektool.protocol.commands``, such as the ``request`` of what
            ``fatektool.parse_command`` returns.
        station: of the PLC; 0 for all of them.
        protocol: a name of ``--protocol``.
        number: of a Modbus TCP request, which its answer repeats; 0 for the others.

    Raises:
        UsageError: no such protocol, or it cannot say this.
    """
    return codec_of(protocol).encode(station, request, number)


def answer_frame(
    request: Request[A], answer: A, station: int = 1, protocol: str = "facon", *, number: int = 0
) -> bytes:
    """The frame in which a PLC gives this answer to a request; the arguments are those of ``frame``.

    Raises:
        UsageError: no such protocol, or it cannot say this.
    """
    codec_of(protocol).encode(station, request, number)  # what cannot be asked has no answer
    if protocol.startswith(_MODBUS):
        return _modbus(protocol).encode_answer(station, request, answer, number)
    if protocol == "mseries":
        from fatektool.protocol.fatek.mseries.codec import MSERIES

        return MSERIES.encode_answer(station, request, answer)
    from fatektool.protocol.fatek.facon.codec import FACON

    return FACON.encode_answer(station, request, answer)


def raw_frame(
    command: int,
    data: bytes,
    station: int = 1,
    protocol: str = "facon",
    *,
    answer: bool = False,
    number: int = 0,
) -> bytes:
    """Any command with any data as a frame, whether the protocol has such a command or not.

    Args:
        command: the command's code, 0 to 255; in Modbus the function.
        data: what stands between command and checksum; of an answer with its error code.
        station: 0 for all of them.
        protocol: a name of ``--protocol``.
        answer: True for an answer, which M-series frames say.
        number: of a Modbus TCP request.

    Raises:
        UsageError: no such protocol, or no frame of it can hold this.
    """
    codec = codec_of(protocol)
    if not 0 <= command <= 0xFF:
        raise UsageError(f"command: expected 00 to FF, got {command:X}")
    if not protocol.startswith(_MODBUS):
        if protocol == "facon":
            from fatektool.protocol.fatek.facon.codec import frame_bytes

            return frame_bytes(station, command, data)
        from fatektool.protocol.fatek.mseries import codec as mseries

        header = mseries.RESPONSE if answer else mseries.QUERY
        return mseries.frame_bytes(header, station, command, data)
    from fatektool.protocol.modbus.frame import MAX_PDU

    if station and station not in codec.stations:
        raise UsageError(f"station: expected 0 to {codec.stations[-1]}, got {station}")
    if len(data) >= MAX_PDU:
        raise UsageError(f"frame data: expected at most {MAX_PDU - 1} bytes, got {len(data)}")
    return _modbus(protocol).framing.encode(station, bytes([command]) + data, number)


def error_frame(
    command: int, code: int, station: int = 1, protocol: str = "facon", *, number: int = 0
) -> bytes:
    """The answer that refuses a command.

    Args:
        command: that was asked; in Modbus the function.
        code: the error code: 1 to F in FACON, 1 to FF in the others.
        station: who refuses.
        protocol: a name of ``--protocol``.
        number: of a Modbus TCP request.

    Raises:
        UsageError: no such protocol or code.
    """
    most = 0xF if protocol == "facon" else 0xFF
    if not 1 <= code <= most:
        raise UsageError(f"error code: expected 1 to {most:X}, got {code:X}")
    if protocol.startswith(_MODBUS):
        return raw_frame(command | _REFUSED, bytes([code]), station, protocol, answer=True, number=number)
    data = b"%X" % code if protocol == "facon" else bytes([code])
    return raw_frame(command, data, station, protocol, answer=True)


def checksum(data: bytes, protocol: str = "facon") -> bytes:
    """The checksum of some bytes, as it stands on the wire.

    Args:
        data: what it covers: see the table above. FACON's begins with STX (02).
        protocol: a name of ``--protocol``.

    Raises:
        UsageError: no such protocol, or it has no checksum.
    """
    codec_of(protocol)
    match protocol:
        case "facon":
            return b"%02X" % (sum(data) & 0xFF)
        case "mseries" | "modbus-rtu":
            from fatektool.protocol.fatek.mseries.crc import crc_bytes

            return crc_bytes(data)
        case "modbus-ascii":
            from fatektool.protocol.modbus.pdu import lrc_byte

            return b"%02X" % lrc_byte(data)
    raise UsageError(f"{protocol} frames have no checksum: the network has its own")


def error_text(code: int, protocol: str = "facon") -> str:
    """What an error code in an answer means, in words.

    Args:
        code: 0 for no error.
        protocol: a name of ``--protocol``.

    Raises:
        UsageError: no such protocol.
    """
    codec_of(protocol)
    if code == 0:
        return "no error"
    if protocol.startswith(_MODBUS):
        from fatektool.protocol.modbus import data as modbus_data

        if code in modbus_data.GATEWAY:
            return f"the gateway says: {modbus_data.GATEWAY[code]}"
        return modbus_data.MEANINGS.get(code, "a code that Modbus does not list")
    if protocol == "mseries":
        from fatektool.protocol.fatek.mseries import errors as mseries_errors

        return mseries_errors.MEANINGS.get(code, mseries_errors.UNKNOWN)
    if protocol == "mseries":
        from fatektool.protocol.fatek.mseries import errors as mseries_errors

        return mseries_errors.MEANINGS.get(code, mseries_errors.UNKNOWN)
    from fatektool.protocol.plc_errors import MEANINGS

    return MEANINGS.get(code, "a code that no paper lists")


def _modbus(protocol: str) -> ModbusCodec:
    from fatektool.protocol.modbus.codec import ASCII, RTU, TCP

    return {codec.name: codec for codec in (RTU, ASCII, TCP)}[protocol]
