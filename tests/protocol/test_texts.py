"""Text in registers: two characters in each, in either order."""

from __future__ import annotations

import pytest
from hypothesis import given
from hypothesis import strategies as st

from fatektool.errors import UsageError
from fatektool.protocol.texts import characters, divided, text_bits, text_of
from fatektool.protocol.values import TEXTS, ValueType, decode, encode

LATIN = st.text(st.characters(max_codepoint=255, exclude_characters="\0"), max_size=40)


@pytest.mark.parametrize(
    ("raw", "bits", "kind", "text"),
    [
        (0x4241, 16, "str", "AB"), (0x4142, 16, "strh", "AB"), (0x0041, 16, "str", "A"), (0, 16, "str", ""),
        (0x44434241, 32, "str", "ABCD"), (0x41424344, 32, "strh", "ABCD"), (0x00E9, 16, "str", "\u00e9"),
        (0x4100, 16, "str", "\0A"),
    ],
)  # fmt: skip
def test_both_ways(raw: int, bits: int, kind: str, text: str) -> None:
    assert decode(raw, ValueType(kind), bits) == text
    assert encode(text, ValueType(kind), bits) == raw


@given(LATIN, st.sampled_from(sorted(TEXTS.values())))
def test_a_text_in_registers_comes_back(text: str, order: str) -> None:
    widths = [16] * 20
    parts = divided(text, widths)
    words = [(text_bits(part, 16, "little" if order == "little" else "big"), 16) for part in parts]
    assert text_of(words, "little" if order == "little" else "big") == text
    assert characters(0, 32, "big") == ""


@pytest.mark.parametrize(
    ("text", "message"),
    [("ABC", "expected at most 2 characters, got 3"), ("\u20ac", "expected characters of Latin-1")],
)
def test_what_does_not_fit_is_refused(text: str, message: str) -> None:
    with pytest.raises(UsageError, match=message):
        encode(text, ValueType.STR, 16)
