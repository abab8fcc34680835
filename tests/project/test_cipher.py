"""The key is found from the file, however full the memory is; a memory without a key is reported."""

from __future__ import annotations

import random

import pytest

from fatektool.errors import DataError
from fatektool.project.cipher import decipher, solve
from fatektool.project.file import Project
from tests.project.images import B1, B1Z, CODE, FBS, Image, Model, image_of, much_code
from tests.project.pdw import enciphered, key_of, project


@pytest.mark.parametrize("model", [FBS, B1, B1Z], ids=["FBs", "B1", "B1z"])
@pytest.mark.parametrize("share", [0.0, 0.4, 0.8, 1.0])
@pytest.mark.parametrize("seed", [1, 2])
def test_the_key_is_found(model: Model, share: float, seed: int) -> None:
    room = min(model.capacity - 1, model.image_bytes // 2 - 257)
    image = image_of(much_code(int(share * room), seed), model=model)
    found = Project.parse(project(image, model, seed=seed))
    assert found.memory.image == image.image
    assert found.memory.other == image.other


def test_all_memory_full_but_the_header() -> None:
    noise = random.Random(1)  # noqa: S311  # a fixed seed
    image = image_of(much_code(0x4EFF))
    other = bytes(noise.choice(b"abcdefgh\0\0\0\0") for _ in image.other)
    full = Image(image.image, other)
    found = Project.parse(project(full, FBS))
    assert (found.memory.image, found.memory.other) == full


def test_a_memory_full_of_the_same_network() -> None:
    image = image_of([0x0040, 0x00C1] * (0x4EFF // 2))
    full = Image(image.image, random.Random(3).randbytes(len(image.other)))  # noqa: S311  # a fixed seed
    assert Project.parse(project(full, FBS)).memory.image == image.image


def test_only_xor_of_both_keys_counts() -> None:
    data = bytes(5000)
    key = key_of(3)
    assert solve([enciphered(b"\xff" * 5000, key)], {}) == key
    assert decipher(enciphered(data, key), key) == data
    assert decipher(b"", key) == b""


def test_a_full_memory_without_known_words_says_why() -> None:
    noise = random.Random(2)  # noqa: S311  # a fixed seed
    full = Image(noise.randbytes(40960), noise.randbytes(24832))
    with pytest.raises(DataError, match="more than half of it is used"):
        Project.parse(project(full, FBS))


@pytest.mark.parametrize("place", [0, 300, 520, 40000])
def test_a_byte_that_changed_in_the_image_is_damage(place: int) -> None:
    image = image_of(CODE * 5000)
    broken = bytearray(image.image)
    broken[place] ^= 0x20
    with pytest.raises(DataError, match=r"invalid program|cannot be decrypted"):
        Project.parse(project(Image(bytes(broken), image.other), FBS))
