"""At which line a key stands, whatever TOML allows before it."""

from __future__ import annotations

import tomllib

import pytest
from hypothesis import given
from hypothesis import strategies as st

from fatektool.inventory.lines import key_lines, line_of

CASES = {
    "a = 1": {("a",): 1},
    "\n\n# a = 1\na = 1 # b = 2": {("a",): 4},
    "[t]\na = 1\n\n[t.u] # x\nb = 2": {("t",): 1, ("t", "a"): 2, ("t", "u"): 4, ("t", "u", "b"): 5},
    "a.b = 1\nc = 2": {("a",): 1, ("a", "b"): 1, ("c",): 2},
    "\"a=b\" = 1\n'c]d' = 2": {("a=b",): 1, ("c]d",): 2},
    '["x.y"."]"]\na = 1': {("x.y",): 1, ("x.y", "]"): 1, ("x.y", "]", "a"): 2},
    '"\\u0061" = 1': {("a",): 1},
    'a = """\nb = 1\n[c]\n"""\nd = 2': {("a",): 1, ("d",): 5},
    'a = """x""\\""""\nd = 2': {("a",): 1, ("d",): 2},
    "a = '''\nb = 1''\n'''\nd = 2": {("a",): 1, ("d",): 4},
    "a = [\n  1, # ]\n  '[',\n]\nd = 2": {("a",): 1, ("d",): 5},
    'a = {b = "}", c = 1}\nd = 2': {("a",): 1, ("d",): 2},
    "[[i]]\na = 1\n[[i]]\na = 2": {("i",): 1, ("i", "a"): 2},
    "a = '#'\nb = \"#\"\nc = 1": {("a",): 1, ("b",): 2, ("c",): 3},
}


@pytest.mark.parametrize(("text", "lines"), CASES.items())
def test_where_a_key_stands(text: str, lines: dict[tuple[str, ...], int]) -> None:
    tomllib.loads(text)
    assert key_lines(text) == lines


def test_the_nearest_table_around() -> None:
    lines = {("plc",): 2, ("plc", "p"): 3}
    assert line_of(lines, "plc", "p", "x") == 3
    assert line_of(lines, "plc", "q", "x") == 2
    assert line_of(lines, "y") is None


KEYS = st.text("ab\"'#=[]. ", min_size=1, max_size=4)
VALUES = st.sampled_from(
    ["1", '"a = 1"', "'#'", '"""\nx = 1\n"""', "'''\n[t]'''", "[\n1,\n# ]\n]", '{a = "}"}', '"\\\\"', "[[1]]"]
)


def quoted(key: str) -> str:
    return '"' + key.replace("\\", "\\\\").replace('"', '\\"') + '"'


@given(st.dictionaries(KEYS, VALUES, max_size=6), st.dictionaries(KEYS, VALUES, max_size=6))
def test_any_document(first: dict[str, str], second: dict[str, str]) -> None:
    text, expected = "", {}
    for table, pairs in (((), first), (("t",), second)):
        if table:
            expected[table] = text.count("\n") + 1
            text += "[t] # t = 1\n"
        for key, value in pairs.items():
            expected[*table, key] = text.count("\n") + 1
            text += f"{quoted(key)} = {value} # x\n\n"
    tomllib.loads(text)
    assert key_lines(text) == expected
