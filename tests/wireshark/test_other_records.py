"""Records that are neither FACON nor M-series, and frames over TCP and UDP."""

from __future__ import annotations

import struct
from typing import TYPE_CHECKING

from tests.wireshark.capture import (
    ASCII,
    EXPERT,
    FACON,
    INFO,
    PROTOCOL,
    RAW_IP,
    RECEIVED,
    RTU,
    SENT,
    TCP,
    capture,
    seen,
    traced,
)

if TYPE_CHECKING:
    from tests.wireshark.capture import Packet, Tshark

ASKS, ANSWERS = b"\x02014603R0001275\x03", b"\x020146010A57FC4000189\x03"
PC, PLC = bytes([192, 168, 2, 1]), bytes([192, 168, 2, 3])
WORDS = {"asks": "station 1 read R12..R14", "answers": "station 1 answer: read R12..R14: 4261, 32708, 1"}


def test_modbus_goes_to_wiresharks_own_dissector(tshark: Tshark) -> None:
    rtu_asks, rtu_answers, ascii_asks, tcp_asks = tshark(
        capture(
            [
                traced(RTU, SENT, bytes.fromhex("01 03 0000 0001 840A")),
                traced(RTU, RECEIVED, bytes.fromhex("01 03 02 0001 7984")),
                traced(ASCII, SENT, b":010300000001FB\r\n"),
                traced(TCP, SENT, bytes.fromhex("0001 0000 0006 01 03 0000 0001")),
            ]
        )
    )
    assert rtu_asks[PROTOCOL] == "Modbus RTU"
    assert rtu_asks["frame.protocols"] == rtu_answers["frame.protocols"] == "fatek:mbrtu:modbus"
    assert rtu_asks["modbus.func_code"] == rtu_answers["modbus.func_code"] == "3"
    assert ascii_asks[PROTOCOL] == "Modbus ASCII"
    assert ascii_asks[INFO] == ":010300000001FB"
    assert tcp_asks[PROTOCOL] == "Modbus TCP"
    assert tcp_asks["modbus.func_code"] == "3"


def test_a_pseudo_header_that_is_none(tshark: Tshark) -> None:
    good = traced(FACON, SENT, ASKS)
    records = [good[:at] + b"\x09" + good[at + 1 :] for at in range(3)]
    found = tshark(capture([*records, b"\x01\x00", b"", good]))
    for packet in found[:3]:
        assert seen(packet, {EXPERT: "", "station": ""}) == {
            EXPERT: "a pseudo-header of another version",
            "station": "",
        }
    assert found[3][EXPERT] == "shorter than its pseudo-header"
    assert found[-1]["fatek.station"] == "1"


# --- FACON over Ethernet --------------------------------------------------------------------------


def over_ip(protocol: int, source: bytes, destination: bytes, body: bytes) -> bytes:
    head = struct.pack(">BBHHHBBH", 0x45, 0, 20 + len(body), 1, 0, 64, protocol, 0)
    return head + source + destination + body


def over_tcp(*pieces: tuple[int, bytes]) -> list[bytes]:
    """Segments of one connection to port 500."""
    sequence = [1, 1]
    segments = []
    for direction, data in pieces:
        ports = (40000, 500) if direction == SENT else (500, 40000)
        head = struct.pack(">HHIIBBHHH", *ports, sequence[direction], 1, 0x50, 0x18, 65535, 0, 0)
        ends = (PC, PLC) if direction == SENT else (PLC, PC)
        segments.append(over_ip(6, *ends, head + data))
        sequence[direction] += len(data)
    return segments


def over_udp(direction: int, data: bytes) -> bytes:
    ports, ends = ((40001, 500), (PC, PLC)) if direction == SENT else ((500, 40001), (PLC, PC))
    return over_ip(17, *ends, struct.pack(">HHHH", *ports, 8 + len(data), 0) + data)


def infos(packets: list[Packet]) -> list[str]:
    return [packet[INFO] for packet in packets if packet["fatek.station"] or packet["fatek.noise"]]


def test_decode_as_over_tcp_and_udp(tshark: Tshark) -> None:
    """A stream splits and joins frames anywhere; a datagram stands by itself."""
    tcp = over_tcp(
        (SENT, ASKS[:1]),
        (SENT, ASKS[1:9]),
        (SENT, ASKS[9:]),
        (RECEIVED, b"x" + ANSWERS[:7]),
        (RECEIVED, ANSWERS[7:]),
        (SENT, ASKS + ASKS),
        (RECEIVED, ANSWERS + ANSWERS),
    )
    udp = [over_udp(SENT, ASKS), over_udp(RECEIVED, ANSWERS), over_udp(RECEIVED, ANSWERS[:-1])]
    found = tshark(capture([*tcp, *udp], RAW_IP), "-d", "tcp.port==500,facon", "-d", "udp.port==500,facon")
    assert infos(found) == [
        WORDS["asks"],
        "[1 byte: noise outside a frame]",
        WORDS["answers"],
        f"{WORDS['asks']}; {WORDS['asks']}",
        f"{WORDS['answers']}; station 1 answer: 46",
        WORDS["asks"],
        WORDS["answers"],
        "[20 bytes: a frame that is cut off: no ETX]",
    ]
    assert found[len(tcp) + 1]["fatek.time"] == "0.125000000"
