"""The memories of a project: the program's image and the memory after it, decrypted.

::

    180A  182A  181A   the image of FBs and LA (40960 bytes), B1 and HB1 (16384), B1z (8192): header, code
    180B  182B  181B   other memory, 24832 bytes: byte 0 is address A000: labels, R5000 on, comments
    1800               the image of an FBE, 32768 bytes: code at 2800, settings at 6700 (one file seen)

The key is right if the image begins with ``FBS4`` and two of its sums are correct, as in all known files:
that of the settings covers a whole period of the longer key, and that of the code all code.
"""

from __future__ import annotations

import struct
from collections import Counter
from dataclasses import dataclass
from typing import TYPE_CHECKING, Final

from fatektool.errors import DataError
from fatektool.project.cipher import PERIOD, decipher, solve

if TYPE_CHECKING:
    from collections.abc import Mapping, Sequence

    from fatektool.project.records import Record


@dataclass(frozen=True, slots=True)
class Family:
    """The format of the program in projects of one kind of models.

    Attributes:
        image: the type of the image's record.
        other: the type of the other memory's record; None if there is none.
        start: the beginning of the image; empty if not known.
    """

    image: int
    other: int | None
    start: bytes


FAMILIES: Final = (
    Family(0x180A, 0x180B, b"FBS40003"),
    Family(0x182A, 0x182B, b"FBS40110"),
    Family(0x181A, 0x181B, b"FBS40109"),
    Family(0x1800, None, b""),
)
OTHER_AT: Final = 0xA000
"""The address of the other memory's byte 0."""
_LEAST_BYTES: Final = 0x400

_SURE: Final = 100
_LIKELY: Final = 40
_WEAK: Final = 10
_TRUST: Final = (1, 10, 100)
"""The weight of the known words: first like the rest; then, for a full memory, more than all of it."""
_SIGNATURE_BYTES: Final = 8
_MARK_FBE: Final = 0x67FC
_DAMAGED: Final = "the file is damaged: get it again from its source"


@dataclass(frozen=True, slots=True)
class Memory:
    """The memory of the PLC in a project.

    Attributes:
        family: the kind of PLC.
        image: the program, decrypted.
        other: the memory from address A000 on, decrypted; None if the project has none.
    """

    family: Family
    image: bytes
    other: bytes | None


def memory_of(records: Sequence[Record]) -> Memory:
    """Find and decrypt the memories of a project.

    Raises:
        DataError: none or several images, a wrong size, or the key cannot be found.
    """
    family, image = _image(records)
    other = next((record.data for record in records if record.type == family.other), None)
    memories = [image] if other is None else [image, other]
    faults = []
    for trust in _TRUST:
        key = solve(memories, _known(family, trust))
        plain = [decipher(memory, key) for memory in memories]
        fault = _fault(family, plain[0])
        if fault is None:
            return Memory(family, plain[0], None if other is None else plain[1])
        faults.append(fault)
    raise _unsolved(memories, faults[0])


def _image(records: Sequence[Record]) -> tuple[Family, bytes]:
    by_type = {family.image: family for family in FAMILIES}
    found = [record for record in records if record.type in by_type]
    if len(found) != 1:
        raise DataError(
            f"expected one program image in the project, got {len(found)}",
            hint="check that it is a complete project of an FBs, B1 or FBE",
        )
    family = by_type[found[0].type]
    size = len(found[0].data)
    if size < _LEAST_BYTES or size % 2 or (not family.start and size <= _MARK_FBE + 1):
        raise DataError(f"record {family.image:04X}, the program's image, has {size} bytes", hint=_DAMAGED)
    return family, found[0].data


def _known(family: Family, trust: int) -> Mapping[int, tuple[int, int]]:
    """Bytes of the image that are the same in every file, each with its weight."""
    if not family.start:
        return {_MARK_FBE: (0x55, trust * _SURE), _MARK_FBE + 1: (0xAA, trust * _SURE)}
    unsure = {*range(200, 208), *range(256, 288), *range(474, 508)}  # sums; sizes; settings
    likely = {place: (0xFF, _LIKELY) for place in range(512) if place not in unsure}
    weak = {place: (byte, _WEAK) for place, byte in enumerate(family.start)}
    sure = {
        **dict(enumerate(family.start[:4])),
        **dict.fromkeys(range(_SIGNATURE_BYTES, 128), 0xFF),
        **dict(enumerate(b"\x44\x69", 128)),
        **dict(enumerate(b"\x00\x02", 266)),
        **dict(enumerate(b"\x55\xaa\x00\xff", 508)),
    }
    votes = likely | weak | {place: (byte, _SURE) for place, byte in sure.items()}
    return {place: (byte, trust * weight) for place, (byte, weight) in votes.items()}


def _fault(family: Family, image: bytes) -> str | None:
    """The fault of an image; None if it is valid."""
    if not family.start:
        marked = image[_MARK_FBE : _MARK_FBE + 2] == b"\x55\xaa"
        return None if marked else f"no 55 AA at byte {_MARK_FBE:04X} of the image"
    if not image.startswith(b"FBS4"):
        return "the image does not begin with FBS4"
    words = struct.unpack(f"<{len(image) // 2}H", image)
    used = words[131]
    if 256 + used + 1 > len(words):
        return f"word 131: expected code that ends in the {len(words)} words of the image, got {used}"
    for name, stored, part in (
        ("settings", words[100], words[104:256]),
        ("code", words[101], words[256 : 256 + used + 1]),
    ):
        computed = sum(part) & 0xFFFF
        if computed != stored:
            return f"checksum of the {name}: expected {stored:04X} as stored, got {computed:04X}"
    return None


def _unsolved(enciphered: Sequence[bytes], what: str) -> DataError:
    """The error if the memory cannot be decrypted: it is full, or the file is damaged."""
    places = range(PERIOD)
    erased = sum(
        max(Counter(memory[place::PERIOD]).values(), default=0) for memory in enciphered for place in places
    )
    share = erased / sum(len(memory) for memory in enciphered)
    if share < 1 / 2:
        return DataError(
            f"the project cannot be decrypted: {what}; the key is found from unused memory, "
            "but more than half of it is used",
            hint="save the project with fewer comments, or remove unused networks in a copy, and try again",
        )
    return DataError(f"invalid program in the project: {what}", hint=_DAMAGED)
