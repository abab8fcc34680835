"""Values compare, hash and print as the dataclasses that they are."""

from __future__ import annotations

from dataclasses import FrozenInstanceError, dataclass, replace

import pytest

from fatektool.protocol.commands import Loopback, ReadBriefStatus, ReadDetailedStatus, ReadPage, WritePage
from fatektool.value import Value


@dataclass(frozen=True, slots=True, eq=False, repr=False)
class Point(Value):
    x: int
    y: str = "b"


def test_equal_fields_are_equal_and_hash_alike() -> None:
    assert Point(1, "a") == Point(1, "a")
    assert hash(Point(1, "a")) == hash(Point(1, "a"))
    assert {ReadPage(3), ReadPage(3), ReadPage(4)} == {ReadPage(3), ReadPage(4)}


@pytest.mark.parametrize("other", [Point(2, "a"), Point(1), (1, "a"), 1, None])
def test_other_fields_and_other_things_are_not(other: object) -> None:
    assert Point(1, "a") != other


def test_another_class_with_the_same_fields_is_not_equal() -> None:
    assert ReadBriefStatus() != ReadDetailedStatus()
    assert ReadBriefStatus() == ReadBriefStatus()
    assert Loopback(b"x") != WritePage(0, bytes(128))


def test_its_text_is_a_dataclasss() -> None:
    assert repr(Point(1, "a")) == "Point(x=1, y='a')"
    assert repr(ReadBriefStatus()) == "ReadBriefStatus()"
    assert repr(ReadPage(7)) == "ReadPage(page=7)"


def test_it_stays_frozen_and_can_be_replaced() -> None:
    point = Point(1)
    with pytest.raises(FrozenInstanceError):
        point.x = 2  # type: ignore[misc]
    assert replace(point, x=2) == Point(2)
