"""A writer of project files for the tests, from the description of the format alone."""

from __future__ import annotations

import random
import struct
from typing import TYPE_CHECKING

if TYPE_CHECKING:
    from collections.abc import Mapping

    from tests.project.images import Image, Model


def key_of(seed: int) -> bytes:
    """A key of a period of 1280 bytes: two of 256 and of 5, one XORed with the other."""
    choose = random.Random(seed)  # noqa: S311  # a fixed seed
    long, short = choose.randbytes(256), choose.randbytes(5)
    return bytes(long[place % 256] ^ short[place % 5] for place in range(1280))


def enciphered(data: bytes, key: bytes) -> bytes:
    return bytes(byte ^ key[place % 1280] for place, byte in enumerate(data))


def record(kind: int, data: bytes, tail: int | None = None) -> bytes:
    """One record; ``tail`` stands for the two bytes behind, which are the sum where nothing else is said."""
    body = struct.pack("<HH", kind, len(data)) + data
    if kind == 0x180A:
        return body
    return body + struct.pack("<H", sum(data) % 65536 if tail is None else tail)


def text_of_element(element: str, text: bytes) -> bytes:
    name = element.encode("ascii")
    return record(0x1003, struct.pack("<H", len(name)) + name + struct.pack("<H", len(text)) + text + b"\0\0")


def head(model: bytes = b"FBs-24MA") -> bytes:
    data = bytearray(256)
    data[:33] = b"Fatek WinProladder, File Format 1"
    data[0x80:0x86] = b"FB-PLC"
    data[0x90:0x9C] = b"WinProladder"
    data[0xA0 : 0xA0 + len(model)] = model
    return bytes(data)


def project(
    image: Image,
    model: Model,
    *,
    seed: int = 1,
    name: bytes = b"PRESS",
    elements: Mapping[str, bytes] | None = None,
    networks: Mapping[int, bytes] | None = None,
    units: Mapping[int, bytes] | None = None,
) -> bytes:
    """A whole project file."""
    key = key_of(seed)
    plc = b"FBs-24MA"
    parts = [
        head(),
        record(0x1006, struct.pack("<HHHH", 0, len(name), len(plc), 0) + name + plc),
        record(model.image_type, enciphered(image.image, key), 0x1234),
        record(model.other_type, enciphered(image.other, key), 0x1234),
        record(0x1004, bytes(10)),
        record(0x1014, bytes(range(60)), 0xBEEF),
        record(0x1005, bytes(7), 0xBEEF),
        *(
            record(0x1001, struct.pack("<HHH", place, len(text), 0) + text)
            for place, text in (units or {0x0200: b"MAIN"}).items()
        ),
        *(
            record(0x1002, struct.pack("<HH", place, len(text)) + text)
            for place, text in (networks or {}).items()
        ),
        *(text_of_element(element, text) for element, text in (elements or {}).items()),
        record(0x1040, b"FBs-8EA".ljust(76, b"\0"), 0x0101),
        struct.pack("<HH", 0xFFFF, 0),
    ]
    return b"".join(parts)
