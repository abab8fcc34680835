"""The demonstration program of a model, in the form of its family."""

from __future__ import annotations

from functools import lru_cache
from typing import TYPE_CHECKING

from fatektool.simulator.program.facon_program import demonstration_program
from fatektool.simulator.program.fbs_program import fbs_program

if TYPE_CHECKING:
    from fatektool.simulator.models import Model


def program_of(model: Model, *, seed: int = 1, swapped: bool = False) -> list[bytes]:
    """Pages of 128 bytes, as many as the model has.

    Args:
        model: of the PLC.
        seed: which program.
        swapped: swap the bytes of each word of an FBs image.
    """
    return list(_pages(model, seed, swapped=swapped))


@lru_cache(maxsize=16)  # to make the same one again took longer than all else that a simulated PLC needs
def _pages(model: Model, seed: int, *, swapped: bool) -> list[bytes]:
    if model.image is not None and model.has_fbs_image:
        return fbs_program(model.image, model.page_count, seed=seed, swapped=swapped)
    return demonstration_program(model.ladder_words, seed=seed)
