"""JSON with indentation is, character by character, that of ``json``."""

from __future__ import annotations

import json
from math import inf, nan

import pytest
from hypothesis import example, given
from hypothesis import strategies as st

from fatektool.files.indented_json import indented_json

leaves = st.one_of(
    st.none(), st.booleans(), st.integers(), st.floats(allow_nan=False, allow_infinity=False), st.text()
)
documents = st.recursive(
    leaves,
    lambda inner: st.lists(inner, max_size=4) | st.dictionaries(st.text(), inner, max_size=4),
    max_leaves=20,
)


@given(documents, st.integers(1, 3))
@example({"values": {"R0": 1, "R1": None}, "elements": {"R0": {"type": "i16"}}, "errors": {}}, 2)
@example({1: (2, (3,)), None: [()], 2.5: ("x",)}, 2)
@example({"a": [], "b": [{}], "c": [[1, 2], "x\ny"], "d": {"e": {"f": {"g": ["\x7f€"]}}}}, 1)
def test_as_json_writes_it(document: object, indent: int) -> None:
    assert indented_json(document, indent) == json.dumps(document, indent=indent, allow_nan=False)


@pytest.mark.parametrize("number", [nan, inf, -inf])
def test_a_number_that_json_does_not_have(number: float) -> None:
    for document in (number, [number], {"a": number}, {"a": {"b": [1, number]}}):
        with pytest.raises(ValueError, match="not JSON compliant"):
            indented_json(document, 2)


def test_a_value_that_json_does_not_have() -> None:
    for document in (object(), [object()], {"a": {"b": object()}}):
        with pytest.raises(TypeError, match="not JSON serializable"):
            indented_json(document, 2)
