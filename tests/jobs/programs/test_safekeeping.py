"""An image without a program is refused where it would replace a good backup; one with a little is not."""

from __future__ import annotations

import pytest

from fatektool.errors import DataError
from fatektool.jobs.programs.safekeeping import require_ladder
from fatektool.program.image import Program
from tests.program.samples import header, program
from tests.project.files import program_of
from tests.project.images import image_of

FACON = (program(400, page0=header(400)), 1)
FBS = (program_of(image_of([])), 4)
"""An image of each family, and the page in which its ladder begins."""


def image_with(image: Program, first: int, blank: int, ladder: dict[int, int]) -> Program:
    """The image with a ladder of blank bytes, but for some at their places."""
    data = bytearray(image.data)
    data[128 * first :] = bytes([blank]) * (len(data) - 128 * first)
    for place, byte in ladder.items():
        data[128 * first + place] = byte
    return Program(image.ladder_words, tuple(bytes(data[at : at + 128]) for at in range(0, len(data), 128)))


@pytest.mark.parametrize(("image", "first"), [FACON, FBS], ids=["facon", "fbs"])
def test_an_empty_ladder_is_told_from_one_with_a_single_byte(image: Program, first: int) -> None:
    assert image.header.valid
    for blank in (0x00, 0xFF, 0x55):
        with pytest.raises(DataError, match=f"the program is empty: every byte of its ladder is {blank:02X}"):
            require_ladder(image_with(image, first, blank, {}))
        require_ladder(image_with(image, first, blank, {0: 0x01}))
        require_ladder(image_with(image, first, blank, {127: 0x01}))
        require_ladder(image_with(image, first, blank, {-1 + 128 * (len(image.pages) - first): 0x01}))
