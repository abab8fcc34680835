"""``watch`` on a terminal: its keys, a value that is written, a line that is lost."""

from __future__ import annotations

import re
from contextlib import contextmanager
from typing import TYPE_CHECKING, Any

import pytest
from hypothesis import given
from hypothesis import strategies as st

from fatektool.cli.elements.watch.view import WatchView
from tests.cli.live_terminal import LiveTerminal
from tests.cli.running import Door, served

if TYPE_CHECKING:
    from collections.abc import Iterator

UP, DOWN, PGUP, PGDN = "\x1b[A", "\x1b[B", "\x1b[5~", "\x1b[6~"
KEYS = "q end   space pause   w write   arrows PgUp PgDn move"


@contextmanager
def watched(*words: object, interval: float = 0.01, **more: Any) -> Iterator[tuple[LiveTerminal, Door]]:
    with served() as door:
        options = ["--interval", interval, "-p", door.target]
        with LiveTerminal("watch", *words, *options, **more) as terminal:
            terminal.until("q end")
            yield terminal, door


def rows(lines: list[str]) -> dict[str, str]:
    """The values that are shown, by element."""
    found = (re.match(r"([RMXY]\d+) +(\S+)", line) for line in lines)
    return {each[1]: each[2] for each in found if each}


@pytest.mark.parametrize("interval", [0, 0.01, 3600])
def test_q_ends_it_at_once_and_leaves_the_table(interval: float) -> None:
    """With 0, though an element is refused: it was ended as it is meant to be."""
    with watched("R0", "R9000", interval=interval) as (terminal, _):
        assert not terminal.shows_keys
        terminal.type("q")
        assert terminal.end() == 0
        assert terminal.shows_keys
    last = terminal.raw.rpartition("\x1b[1A")[2]
    assert "R9000" in terminal.text
    assert "w write" not in last


def test_ctrl_c_is_an_interruption() -> None:
    with watched("R0") as (terminal, _):
        terminal.type("\x03")
        assert terminal.end() == 130
        assert terminal.shows_keys
    assert terminal.text.rstrip().endswith("fatektool: interrupted")


def test_keys_move_it() -> None:
    def first_and_last(first: str, last: str) -> list[str]:
        return terminal.until(lambda lines: [*rows(lines)][:1] == [first] and [*rows(lines)][-1:] == [last])

    with watched("R0-R19", lines=12) as (terminal, _):
        assert "and 12 more" in "\n".join(first_and_last("R0", "R7"))
        terminal.type(DOWN)
        first_and_last("R1", "R8")
        terminal.type(PGDN)
        first_and_last("R9", "R16")
        terminal.type(PGDN)
        assert "more" not in "\n".join(first_and_last("R12", "R19"))
        terminal.type(UP)
        first_and_last("R11", "R18")
        terminal.type(PGUP + PGUP)
        first_and_last("R0", "R7")
        terminal.type("G")
        first_and_last("R12", "R19")
        terminal.type("g")
        first_and_last("R0", "R7")
        terminal.resize(80, 8)
        first_and_last("R0", "R3")
        terminal.type("q")
        assert terminal.end() == 0


def test_space_pauses_it() -> None:
    with watched("R0", "R1") as (terminal, door):
        asked: list[int] = []
        memory = door.simulation.plcs[1].memory
        read = memory.read_words

        def counted(symbol: str, address: int, count: int) -> list[int]:
            asked.append(address)
            return read(symbol, address, count)

        memory.read_words = counted  # type: ignore[method-assign]  # a PLC that counts
        terminal.type(" ")
        terminal.until("PAUSED")
        terminal.type("w")
        terminal.until("write, such as R12=5: _")
        terminal.type("\x1b")
        terminal.until(KEYS)
        before = len(asked)
        memory.registers["R"][0] = 77
        for _ in range(3):
            terminal.type("w")
            terminal.until("write, such as")
            terminal.type("\x1b")
            terminal.until(KEYS)
        assert len(asked) == before
        terminal.type(" ")
        terminal.until(lambda lines: rows(lines)["R0"].rstrip("*") == "77")
        assert "PAUSED" not in "\n".join(terminal.lines)
        terminal.type("q")
        assert terminal.end() == 0


def test_w_writes_a_value_after_a_question() -> None:
    """At once, however long it is to the next round; and what is read then is what was written."""
    with watched("R0", "M3", interval=3600) as (terminal, door):
        memory = door.simulation.plcs[1].memory
        terminal.type("wR0=-5x\x7f\r")
        lines = terminal.until(f"Write R0=-5 into station 1 on {door.target}? [y/N]")
        assert rows(lines)["R0"] == "0"
        terminal.type("n")
        terminal.until("nothing was written")
        assert memory.registers["R"][0] == 0
        terminal.type("wR0=-5 M3=on\r")
        terminal.until("[y/N]")
        terminal.type("y")
        lines = terminal.until("R0=-5 M3=on: written and read back")
        terminal.until(lambda lines: rows(lines)["R0"].rstrip("*") == "-5")
        assert (memory.registers["R"][0], memory.status["M"][3]) == (0xFFFB, 1)
        terminal.type("wR0=xyz\r")
        terminal.until("'xyz'")
        terminal.type("wR9000=1\ry")
        terminal.until(
            lambda lines: lines[-1].startswith("R9000") or any("R9000: " in each for each in lines)
        )
        terminal.type("w\x1b")
        terminal.until(KEYS)
        terminal.type("q")
        assert terminal.end() == 0


def test_nothing_is_written_on_a_read_only_line() -> None:
    with watched("R0", "--read-only") as (terminal, _):
        terminal.type("w")
        terminal.until("this line is read-only")
        terminal.type("q")
        assert terminal.end() == 0


def test_a_line_that_is_lost_and_comes_again() -> None:
    with watched("R0", "--timeout", "0.05", "--retries", "0") as (terminal, door):
        gone = door.simulation.plcs.pop(1)
        lines = terminal.until("LINE LOST since")
        assert rows(lines)["R0"] == "?"
        assert sum("LINE LOST" in line for line in lines) == 1
        gone.memory.registers["R"][0] = 12
        door.simulation.plcs[1] = gone
        lines = terminal.until(lambda lines: rows(lines)["R0"].rstrip("*") == "12")
        assert "LINE LOST" not in "\n".join(lines)
        terminal.type("q")
        assert terminal.end() == 0


def test_a_terminal_with_ascii_alone() -> None:
    with watched("R0-R3", columns=40, PYTHONUTF8="0", PYTHONIOENCODING="ascii") as (terminal, _):
        terminal.until(lambda lines: rows(lines)["R3"] == "0" and "___" in "".join(lines))
        terminal.type("q")
        assert terminal.end() == 0
    assert terminal.raw.isascii()


@given(st.lists(st.sampled_from(["down", "up", "pgdn", "pgup", "home", "end", *"wRyn 5=q", "enter", "esc"])))
def test_any_keys(keys: list[str]) -> None:
    """Only y behind a question writes; all else stays within the elements."""
    written: list[str] = []
    view = WatchView(30, "station 1", lambda text, _: written.append(text))
    asked = False
    for key in keys:
        before = len(written)
        view.press(key)
        assert (len(written) > before) <= (asked and key == "y")
        asked = view.foot.endswith("[y/N]")
        places = view.fit(7)
        assert len(places) == 7
        assert places.stop <= 30
