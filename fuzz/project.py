"""Project files of the vendor's program: read, or refused in one plain line.

An input is a file as it is; behind a zero byte it says where to spoil a good one: three bytes a place,
the fourth the byte to put there.
"""

from __future__ import annotations

from fatektool.errors import DataError
from fatektool.ladder.image import fbe_code, fbs_code, words_of_image
from fatektool.project.file import Project
from fuzz.words import require_plain
from tests.project.images import CODE, FBS, image_of
from tests.project.pdw import project

GOOD = project(image_of(CODE), FBS, elements={"X0": b"START"}, networks={0x0200: b"Motor"})


def one_input(data: bytes) -> None:
    """Read; what is taken has code whose words come back from its instructions."""
    try:
        found = Project.parse(_file(data), "press.pdw")
    except DataError as error:
        require_plain(error)
        return
    texts = [*found.comments.elements.values(), *found.comments.networks.values()]
    assert all(text.isprintable() for text in texts)
    image = found.memory.image
    code = fbs_code(words_of_image(image)) if found.memory.family.start else fbe_code(image)
    assert all(instruction.words for instruction in code.instructions)


def _file(data: bytes) -> bytes:
    if data[:1] != b"\0":
        return data
    spoiled = bytearray(GOOD)
    for at in range(1, len(data) - 3, 4):
        spoiled[int.from_bytes(data[at : at + 3], "big") % len(spoiled)] = data[at + 3]
    return bytes(spoiled)
