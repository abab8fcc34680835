"""Values compare, hash and print as the dataclasses that they are."""

from __future__ import annotations

import ast
import copy
import pickle
from dataclasses import FrozenInstanceError, fields, replace
from typing import ClassVar

import pytest

from fatektool.protocol.commands import Loopback, ReadBriefStatus, ReadDetailedStatus, ReadPage, WritePage
from fatektool.value import Value, frozen
from tests.tree import PACKAGE


@frozen
class Point(Value):
    """A place."""

    x: int
    y: str = "b"
    name: ClassVar[str] = "point"


@frozen
class Even(Value):
    x: int

    def __post_init__(self) -> None:
        if self.x % 2:
            raise ValueError(self.x)


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
    with pytest.raises(FrozenInstanceError, match="'x'"):
        point.x = 2  # type: ignore[misc]
    with pytest.raises(FrozenInstanceError, match="'x'"):
        del point.x
    with pytest.raises(FrozenInstanceError, match="'z'"):
        point.z = 2
    assert point == Point(1)
    assert replace(point, x=2) == Point(2)


def test_its_fields_are_those_of_a_dataclass() -> None:
    assert [field.name for field in fields(Point)] == ["x", "y"]
    assert Point.__slots__ == ("x", "y")
    assert Point.__doc__ == "A place."
    assert not hasattr(Point(1), "__dict__")


def test_it_is_made_by_place_or_by_name() -> None:
    assert Point(1, "a") == Point(y="a", x=1)
    for words in ((), (1, "a", 2)):
        with pytest.raises(TypeError, match="__init__"):
            Point(*words)
    with pytest.raises(TypeError, match="z"):
        Point(1, z=2)  # type: ignore[call-arg]


def test_it_is_checked_when_it_is_made() -> None:
    assert Even(2).x == 2
    with pytest.raises(ValueError, match="3"):
        Even(3)
    with pytest.raises(ValueError, match="5"):
        replace(Even(2), x=5)


def test_it_is_copied_and_pickled() -> None:
    point = Point(1, "a")
    assert copy.copy(point) == copy.deepcopy(point) == point
    assert pickle.loads(pickle.dumps(point)) == point  # noqa: S301  # of our own


def test_every_dataclass_has_a_docstring() -> None:
    """Without one, ``dataclass`` makes it from the signature: 2 ms at each start, and more the first time."""
    missing = [
        f"{path.relative_to(PACKAGE)}: {node.name}"
        for path in PACKAGE.rglob("*.py")
        for node in ast.walk(ast.parse(path.read_text("utf-8")))
        if isinstance(node, ast.ClassDef) and _is_dataclass(node) and not ast.get_docstring(node)
    ]
    assert not missing


def _is_dataclass(node: ast.ClassDef) -> bool:
    words = [ast.unparse(each).partition("(")[0] for each in node.decorator_list]
    return "dataclass" in words or "frozen" in words
