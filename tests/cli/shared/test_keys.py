"""Keys, by the bytes that terminals send for them."""

from __future__ import annotations

import pytest
from hypothesis import given
from hypothesis import strategies as st

from fatektool.cli.shared.keys import SEQUENCES, is_begun, keys_of


@pytest.mark.parametrize(
    ("typed", "keys"),
    [
        ("q", ["q"]),
        ("\x1b[A\x1b[B", ["up", "down"]),
        ("\x1bOA\x1bOH", ["up", "home"]),
        ("\x1b[5~\x1b[6~", ["pgup", "pgdn"]),
        ("/Y4\r", ["/", "Y", "4", "enter"]),
        ("/y\x7f\x1b", ["/", "y", "backspace", "esc"]),
        ("\x1b[1;5Aj", ["j"]),  # with Ctrl: unknown, and skipped as a whole
        ("\x1b[200~x", ["x"]),
        ("\x1bOPn", ["n"]),  # F1
        ("\x1bq", ["esc", "q"]),
        ("ł", ["ł"]),
        ("", []),
    ],
)
def test_what_is_typed(typed: str, keys: list[str]) -> None:
    assert [*keys_of(typed)] == keys


@pytest.mark.parametrize("typed", [*SEQUENCES, "\x1b[1;5A", "\x1b[200~", "ł", "€", "q"])
def test_a_key_in_pieces(typed: str) -> None:
    """All that is not whole yet is known as begun; what is whole is not, but for Esc, which may go on."""
    data = typed.encode()
    for end in range(1, len(data)):
        assert is_begun(data[:end]), (typed, end)
    assert is_begun(data) is (typed == "\x1b")


@given(st.text(alphabet="\x1b[O~ABHq15;ł/\r\x7f", max_size=12))
def test_any_text_comes_to_an_end(typed: str) -> None:
    assert all(key in {*SEQUENCES.values()} or len(key) == 1 for key in keys_of(typed))
