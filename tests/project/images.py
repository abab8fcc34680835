"""Images of the FBs family for the tests, made from code words: header, sums, code, labels, ROR."""

from __future__ import annotations

import random
import struct
from typing import NamedTuple

ERASED = 0xFFFF
MEMORY_BYTES = 0xA000 + 24832


class Model(NamedTuple):
    digits: bytes
    image_bytes: int
    capacity: int
    image_type: int
    other_type: int


FBS = Model(b"0003", 40960, 0x4F00, 0x180A, 0x180B)
B1 = Model(b"0110", 16384, 0x1F00, 0x182A, 0x182B)
B1Z = Model(b"0109", 8192, 0x0F00, 0x181A, 0x181B)


class Image(NamedTuple):
    """The image's bytes, low byte of a word first, and the memory from A000 on."""

    image: bytes
    other: bytes

    @property
    def memory(self) -> bytes:
        return self.image.ljust(0xA000, b"\xff") + self.other


def image_of(
    main: list[int],
    sub: list[int] | None = None,
    *,
    model: Model = FBS,
    settings: int = 0,
    ror: list[int] | None = None,
    labels: list[int] | None = None,
) -> Image:
    """An image with this code; ``settings`` varies what is no code."""
    sub, ror, labels = sub or [], ror or [], labels or []
    words = [ERASED] * (MEMORY_BYTES // 2)
    words[0:4] = struct.unpack("<4H", b"FBS4" + model.digits)
    words[64] = 0x6944
    code = [*main, ERASED, *sub]
    used = len(main) + len(sub)
    words[256 : 256 + len(code)] = code
    words[128:136] = [
        *(0x0143, 0x0040, model.capacity, used, model.capacity - 1 - used, 0x0200),
        *(0x0200 + 2 * (len(main) + 1), 0x0200 + 2 * (used + 1)),
    ]
    words[138] = 0xA800 - 2 * len(labels)
    words[139:141] = 0xA800, 0xBFFF
    words[141] = words[143] = 0xC000
    words[237:239] = settings, 1
    words[239] = len(ror)
    words[254:256] = 0xAA55, 0xFF00
    words[0x5400 - len(labels) : 0x5400] = labels
    words[0x5400 : 0x5400 + len(ror)] = ror
    words[100] = sum(words[104:256]) & ERASED
    words[101] = sum(words[256 : 256 + used + 1]) & ERASED
    words[102] = sum(labels) & ERASED if labels else ERASED
    words[103] = sum(ror) & ERASED if ror else ERASED
    memory = struct.pack(f"<{len(words)}H", *words)
    return Image(memory[: model.image_bytes], memory[0xA000:])


CODE = [0x0040, 0x10A8, 0x0090, 0x00C1]
"""ORG X0, OR M0, AND NOT X0, OUT Y0."""


def much_code(words: int, seed: int = 1) -> list[int]:
    """Networks of contacts, coils and moves in about the mixture of a machine's program."""
    choose = random.Random(seed)  # noqa: S311  # a fixed seed
    code: list[int] = []
    while len(code) < words:
        number = choose.randrange(200)
        code += [0x48 | (0x10 + number) << 8 & 0xFF00, 0x89 | number << 8, 0x0098 | number << 8]
        if choose.random() < 0.3:
            code += [0xACF5, choose.randrange(100) << 8, (2 * choose.randrange(100) << 8) | 0x0A]
        code += [0x00C1 | choose.randrange(48) << 8]
    return code[:words]
