"""A PLC's file in a tree: found among what git stores, and put in so that git stores it in its order."""

from __future__ import annotations

import pytest
from dulwich.objects import Blob, parse_tree

from fatektool.history.trees import Item, file_in, files, with_file

PRESS = bytes.fromhex("00112233445566778899aabbccddeeff00112233")
NOTES = bytes.fromhex("0a" * 20)
LITERAL = b"40000 notes\0" + NOTES + b"100644 press.json\0" + PRESS


def items(tree: bytes) -> list[Item]:
    return list(parse_tree(tree, 20))


def test_a_tree_as_git_stores_it() -> None:
    found = items(LITERAL)
    assert found == [
        (b"notes", 0o040000, NOTES.hex().encode()),
        (b"press.json", 0o100644, PRESS.hex().encode()),
    ]
    assert files(found) == {"press": PRESS.hex()}
    assert file_in(found, "press") == PRESS.hex()
    assert file_in(found, "notes") is None
    assert file_in([], "press") is None


@pytest.mark.parametrize("mode", [0o100644, 0o100755, 0o100664])
def test_a_plain_file(mode: int) -> None:
    assert file_in([(b"press.json", mode, b"1" * 40)], "press") == "1" * 40


@pytest.mark.parametrize("mode", [0o120000, 0o040000, 0o160000, 0o644])
def test_a_name_that_is_no_plain_file(mode: int) -> None:
    found = [(b"press.json", mode, b"1" * 40)]
    assert file_in(found, "press") is None
    assert files(found) == {}


def test_a_file_put_in_in_git_s_order() -> None:
    """A folder stands where its name with a slash would: behind ``a.json``, before ``a0.json``."""
    folder = b"40000 a\0" + NOTES
    blob, other = Blob.from_string(b"x"), Blob.from_string(b"y")
    x, y = (bytes.fromhex(each.id.decode()) for each in (blob, other))
    both = with_file(with_file(items(folder), "a", blob).items(), "a0", blob)
    assert both.as_raw_string() == b"100644 a.json\0" + x + folder + b"100644 a0.json\0" + x
    again = with_file(both.items(), "a", other)
    assert again.as_raw_string() == b"100644 a.json\0" + y + folder + b"100644 a0.json\0" + x
