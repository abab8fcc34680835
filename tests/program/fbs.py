"""FBs images for tests, made without the simulator: words, low byte first."""

from __future__ import annotations

import struct

from fatektool.program.image import Program

CAPACITY = 0x4F00
PRINTED: tuple[tuple[str, int], ...] = (
    ("", 0xFFFF),
    ("0040 00C1", 0x0100),
    (
        (
            "0140 00A1 0090 00C1 1048 11C8 12D8 00E0 1348 82FC 1408 1548 00EA 82F8 1608 00E0 1758 C4FC "
            "1408 1858 00E8 C4F8 1608 1B48 80FD 0A00 9003 FC6F 19C8 1C48 1D68 40F9 6400 9005 FC6F 1AC8"
        ),
        0x4A57,
    ),
    ("1C48 1D68 40F9 1900 9005 FC6F 1AC8 1B48 80FD 1900 9003 FC6F 19C8", 0x9663),
)
"""Code of public notes on real images, with the sum that word 101 has there."""

CODE = tuple(int(word, 16) for word in PRINTED[2][0].split())


def words_of(
    main: tuple[int, ...] = CODE,
    sub: tuple[int, ...] = (),
    *,
    pages: int = 512,
    digits: bytes = b"0003",
    capacity: int = CAPACITY,
    labels: tuple[int, ...] = (),
    ror: tuple[int, ...] = (),
) -> list[int]:
    """An image in words, whose header agrees with what is in it."""
    words = [0xFFFF] * 0x8000
    words[0:4] = struct.unpack("<4H", b"FBS4" + digits)
    used = len(main) + len(sub)
    words[104:256] = [0] * 152
    words[130:136] = [
        capacity,
        used,
        capacity - 1 - used,
        0x200,
        0x200 + 2 * (len(main) + 1),
        0x200 + 2 * (used + 1),
    ]
    words[138] = 0xA800 - 2 * len(labels)
    words[239] = len(ror)
    words[254:256] = [0xAA55, 0xFF00]
    words[256 : 257 + used] = [*main, 0xFFFF, *sub]
    words[0x5400 - len(labels) : 0x5400] = labels
    words[0x5400 : 0x5400 + len(ror)] = ror
    words[100] = sum(words[104:256]) % 65536
    words[101] = sum(words[256 : 257 + used]) % 65536
    words[102] = sum(labels) % 65536 if labels else 0xFFFF
    words[103] = sum(ror) % 65536 if ror else 0xFFFF
    return words[: 64 * pages]


def pages_of(words: list[int], *, swapped: bool = False) -> tuple[bytes, ...]:
    data = struct.pack(f"{'>' if swapped else '<'}{len(words)}H", *words)
    return tuple(data[at : at + 128] for at in range(0, len(data), 128))


def fbs_program(pages: int = 512, *, ladder_words: int = 0x8000, swapped: bool = False) -> Program:
    return Program(ladder_words, pages_of(words_of(pages=pages), swapped=swapped))
