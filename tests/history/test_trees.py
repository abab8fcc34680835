"""Trees by their bytes, against what dulwich makes of them and what the format says."""

from __future__ import annotations

import pytest
from dulwich.objects import ObjectID, Tree
from hypothesis import given
from hypothesis import strategies as st

from fatektool.history.trees import Item, entries, file_in, files, item, with_file

HASHES = st.binary(min_size=20, max_size=20)
NAMES = st.from_regex(r"[a-z0-9_][a-z0-9_.-]{0,8}", fullmatch=True)
PATHS = NAMES.map(lambda name: f"{name}.json".encode()) | NAMES.map(str.encode)
MODES = st.sampled_from([0o100644, 0o100755, 0o100664, 0o120000, 0o040000, 0o160000])
TREES = st.dictionaries(PATHS, st.tuples(MODES, HASHES), max_size=12)

PRESS = bytes.fromhex("00112233445566778899aabbccddeeff00112233")
NOTES = bytes.fromhex("0a" * 20)
LITERAL = b"40000 notes\0" + NOTES + b"100644 press.json\0" + PRESS


def test_a_tree_as_git_stores_it() -> None:
    first, second = entries(LITERAL)
    assert item(first) == Item(0o040000, b"notes", NOTES.hex())
    assert item(second) == Item(0o100644, b"press.json", PRESS.hex())
    assert files([first, second]) == {"press": PRESS.hex()}
    assert file_in(LITERAL, "press") == PRESS.hex()
    assert file_in(LITERAL, "notes") is None
    assert file_in(b"", "press") is None
    assert entries(b"") == []


@given(TREES)
def test_as_dulwich_reads_it(found: dict[bytes, tuple[int, bytes]]) -> None:
    tree = Tree()
    for path, (mode, sha) in found.items():
        tree[path] = (mode, ObjectID(sha.hex().encode()))
    data = tree.as_raw_string()
    assert [item(entry) for entry in entries(data)] == [
        Item(mode, path, sha.decode()) for path, mode, sha in tree.items()
    ]
    named = files(entries(data))
    for path in found:
        name = path.decode().removesuffix(".json")
        assert file_in(data, name) == named.get(name)


@given(TREES, NAMES, HASHES)
def test_a_file_put_in_as_dulwich_does_it(
    found: dict[bytes, tuple[int, bytes]], name: str, sha: bytes
) -> None:
    tree = Tree()
    for path, (mode, its) in found.items():
        tree[path] = (mode, ObjectID(its.hex().encode()))
    before = tree.as_raw_string()
    tree[f"{name}.json".encode()] = (0o100644, ObjectID(sha.hex().encode()))
    assert with_file(before, name, sha.hex()) == tree.as_raw_string()


def test_git_s_order_of_names() -> None:
    """A folder stands where its name with a slash would: behind ``a.json``, before ``a0.json``."""
    folder = b"40000 a\0" + NOTES
    with_one = with_file(folder, "a", PRESS.hex())
    both = with_file(with_one, "a0", PRESS.hex())
    assert both == b"100644 a.json\0" + PRESS + folder + b"100644 a0.json\0" + PRESS


@pytest.mark.parametrize(
    "data",
    [LITERAL[:-1], LITERAL + b"1", b"x" + LITERAL, LITERAL[:12] + b"100644 press.json" + PRESS, b"100644 a\0",
     b"100648 a\0" + PRESS, b"100644 \0" + PRESS],
)  # fmt: skip
def test_what_is_no_tree(data: bytes) -> None:
    with pytest.raises(ValueError, match="something else than entries"):
        entries(data)


@pytest.mark.parametrize("mode", [b"120000", b"040000", b"160000", b"00644"])
def test_a_name_that_is_no_plain_file(mode: bytes) -> None:
    assert file_in(mode + b" press.json\0" + PRESS, "press") is None


def test_a_name_within_a_hash_or_another_name() -> None:
    inside = b"xx press.json\0yyyyyy"
    tree = b"100644 a.json\0" + inside + b"100644 my-press.json\0" + NOTES + b"100644 press.json\0" + PRESS
    assert len(inside) == 20
    assert file_in(tree, "press") == PRESS.hex()
