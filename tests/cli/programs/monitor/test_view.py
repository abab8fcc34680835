"""Moving between networks, on screens of all sizes."""

from __future__ import annotations

from hypothesis import given
from hypothesis import strategies as st

from fatektool.cli.programs.monitor.frame import Frames, News
from fatektool.cli.programs.monitor.view import View
from fatektool.ladder.drawing.text.letters import Letters, width_of
from fatektool.ladder.drawing.text.live import LivePen
from fatektool.project.comments import Comments
from tests.jobs.monitor.bench import Monitored

BENCH = Monitored()
LAST = len(BENCH.networks) - 1
NOTHING = News(None)
COMMENTS = Comments("press", "FBs", {}, {}, {}, "utf-8", sure=True)


def view() -> View:
    return View(BENCH.file.require_code(), BENCH.networks)


def frames(encoding: str = "utf-8") -> Frames:
    return Frames("press.json", "station 1 on sim:", COMMENTS, LivePen(Letters(encoding)))


def drawn(seen: View, columns: int = 80, lines: int = 24, news: News = NOTHING) -> list[str]:
    rows = frames().frame(seen, news, columns, lines)
    return ["".join(piece.text for piece in row) for row in rows]


def names(text: list[str]) -> list[str]:
    return [line for line in text if line.startswith("N00") and len(line) == 5]


def test_down_to_the_end_and_up_to_the_beginning_misses_no_network() -> None:
    for key, back, begin in (("down", "up", 0), ("pgdn", "pgup", 0), ("up", "down", LAST)):
        seen = view()
        seen.top = begin
        found: list[str] = []
        for _ in range(100):
            found += names(drawn(seen, lines=16))
            seen.press(key)
        assert {*found} == {each.network.name for each in BENCH.networks}, key
        seen.press(back)
        assert drawn(seen, lines=16)[0].startswith("N00")


def test_a_network_that_is_taller_than_the_screen_is_moved_within() -> None:
    whole = view()
    whole.top = 5
    tall = drawn(whole, lines=40)[1:-1]
    tall = tall[: tall.index("")]
    seen = view()
    seen.top = 5
    met: list[str] = []
    while seen.top == 5:
        met += drawn(seen, lines=6)[1:-1]
        seen.press("down")
    assert [*dict.fromkeys(line for line in tall if line)] == [*dict.fromkeys(line for line in met if line)][
        : len({*tall} - {""})
    ]
    seen.press("up")
    assert seen.top == 5


@given(
    st.lists(
        st.sampled_from(
            ["down", "up", "pgdn", "pgup", "home", "end", "/", "enter", "n", "Y", "4", "esc", "x"]
        ),
        max_size=30,
    ),
    st.integers(1, 210),
    st.integers(1, 60),
)
def test_any_keys_on_any_screen(keys: list[str], columns: int, lines: int) -> None:
    """What is drawn fits, and has a network on it; no key leads out of the program."""
    seen = view()
    for key in keys:
        seen.press(key)
        text = drawn(seen, columns, lines)
        assert len(text) == lines
        assert 0 <= seen.top <= LAST
        assert 0 <= seen.skipped < max(seen.rows_of_top, 1)
        assert seen.visible
        if columns >= 60:
            assert all(width_of(line) <= columns for line in text)


def test_find_and_find_again() -> None:
    seen = view()
    for key in ["/", *"m403", "enter"]:
        seen.press(key)
    assert (seen.top, seen.message) == (9, "M403: 1 of 2 networks; n for the next")
    seen.press("n")
    assert (seen.top, seen.message) == (10, "M403: 2 of 2 networks; n for the next")
    seen.press("n")
    assert seen.top == 9
    for key in ["/", *"WM400", "enter"]:  # it has M403 in it
        seen.press(key)
    assert seen.message.startswith("WM400: ")
    for key in ["/", "enter"]:
        seen.press(key)
    assert (seen.prompt, seen.is_over) == (None, False)
    seen.press("q")
    assert seen.is_over


def test_keys_that_end_it_are_text_while_an_element_is_typed() -> None:
    seen = view()
    for key in ["/", "q"]:
        seen.press(key)
    assert (seen.prompt, seen.is_over) == ("q", False)
    seen.press("")  # the end of all keys
    assert seen.is_over
