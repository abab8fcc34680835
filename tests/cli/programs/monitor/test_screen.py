"""``monitor`` on a real terminal: states, keys, sizes, a line that is lost, and the terminal as it was."""

from __future__ import annotations

import signal
from contextlib import ExitStack
from typing import TYPE_CHECKING

import pytest

from tests.cli.live_terminal import LiveTerminal
from tests.cli.programs.monitor.plant import press, switch

if TYPE_CHECKING:
    from tests.cli.running import Door

UP, DOWN, PGUP, PGDN = "\x1b[A", "\x1b[B", "\x1b[5~", "\x1b[6~"


def terminal(door: Door, *words: object, **options: object) -> LiveTerminal:
    more = ["--interval", "0.01", "--encoding", "cp1250"]
    return LiveTerminal("monitor", "press.pdw", "-p", door.target, *more, *words, **options)  # type: ignore[arg-type]


def test_networks_with_what_the_plc_has() -> None:
    with press() as door:
        switch(door, M421=1)
        with terminal(door) as shown:
            lines = shown.until("M421=1")
            assert lines[0].startswith("N0000-N0003 of N0011  RUN  ")
            assert "rounds/s" in lines[0]
            at = lines.index("N0001")
            assert lines[at + 1 : at + 4] == [
                "┃ X0=0   M421=1   Y4=0",
                "┣━━┤ ├─────┫ ┣─────( )",
                "┃ START   Wył.",
            ]
            switch(door, X0=1, Y4=1)
            lines = shown.until("Y4=1")
            assert lines[at + 2] == "┣━━┫ ┣━━━━━┫ ┣━━━━━(●)"
            cell = shown.screen.buffer[at + 2][4]
            assert (cell.bold, cell.fg) == (True, "green")
            shown.type("q")
            assert shown.end() == 0
            assert shown.shows_keys
        assert shown.raw.count("\x1b[?1049h") == shown.raw.count("\x1b[?1049l") == 1
        assert shown.raw.count("\x1b[?25l") <= shown.raw.count("\x1b[?25h")  # the cursor is back


def test_keys_move_between_networks() -> None:
    with press() as door, terminal(door, lines=12) as shown:
        shown.until("N0000-N0001 of")
        shown.type(DOWN)
        shown.until("N0001-")
        shown.type(PGDN)
        shown.until(lambda lines: lines[0].startswith("N0002"))
        shown.type(UP)
        shown.until(lambda lines: lines[0].startswith("N0001"))
        shown.type("G")
        shown.until(lambda lines: lines[0].startswith("N0011 of"))
        shown.type(PGUP)
        shown.until(lambda lines: lines[0].startswith("N0010"))
        shown.type("/m403x\x7f")
        shown.until(lambda lines: lines[-1] == "/m403_")
        shown.type("\r")
        shown.until("M403: 1 of 2 networks; n for the next")
        shown.until(lambda lines: lines[0].startswith("N0009"))
        shown.until("M403=0")
        shown.type("n")
        shown.until("M403: 2 of 2 networks")
        shown.type("/Q7\r")
        shown.until("no element 'Q7' of a program")
        shown.type("/Y99\r")
        shown.until("Y99 is in none of the networks")
        shown.type("/\x1b")
        shown.until("q end")
        shown.type("q")
        assert shown.end() == 0


@pytest.mark.parametrize("columns", [60, 80, 120, 200])
def test_a_width(columns: int) -> None:
    with press() as door, terminal(door, "--network", "5-7", columns=columns, lines=30) as shown:
        lines = shown.until("M300=0")
        assert lines[0].startswith("N0005-N0007 of N0007  RUN")
        assert lines[-1] == "arrows PgUp PgDn: move   / find   q end"
        assert all(len(line) <= columns for line in lines)
        assert "┃       ┃" not in "\n".join(lines)
        switch(door, M0=1)
        shown.until("┣━━┫ ┣━━┳")
        shown.type("\x03")
        assert shown.end() == 130
        assert shown.shows_keys


def test_another_size() -> None:
    with press() as door, terminal(door, columns=100, lines=40) as shown:
        shown.until("\nN0004")
        shown.resize(60, 12)
        shown.until(lambda lines: lines[0].startswith("N0000-N0001 of") and lines[-1].startswith("arrows"))
        shown.resize(120, 45)
        shown.until("\nN0004")
        shown.type("q")
        assert shown.end() == 0


def test_a_line_that_is_lost_and_comes_again() -> None:
    with press() as door, terminal(door, "--timeout", "0.05", "--retries", "0", columns=60) as shown:
        switch(door, M421=1)
        shown.until("M421=1")
        gone = door.simulation.plcs.pop(1)
        lines = shown.until("LINE LOST since")
        assert "trying again" in " ".join(lines)
        assert "M421=?" in "\n".join(lines)  # what is not known now is not shown as if it were
        assert "rounds/s" not in lines[0]
        shown.type(DOWN)  # keys are heard meanwhile
        shown.until(lambda lines: lines[0].startswith("N0001"))
        door.simulation.plcs[1] = gone
        lines = shown.until("M421=1")
        assert "LINE LOST" not in "\n".join(lines)
        shown.type("q")
        assert shown.end() == 0


def test_without_colours_and_without_box_characters() -> None:
    with press() as door:
        switch(door, X0=1, M421=1, Y4=1)
        with terminal(door, NO_COLOR="1", PYTHONUTF8="0", PYTHONIOENCODING="ascii") as shown:
            lines = shown.until("Y4=1")
            at = lines.index("N0001")
            assert lines[at + 1 : at + 3] == ["# X0=1    M421=1    Y4=1", "#==# #======# #======(*)"]
            assert "Wy\\u0142. zaw\\xf3r" in "".join(lines) or "Wy\\u0142." in "".join(lines)
            assert shown.screen.buffer[at + 2][4].fg == "default"
            shown.type("q")
            assert shown.end() == 0
        assert shown.raw.isascii()


def test_a_terminal_whose_cursor_cannot_be_moved() -> None:
    with press() as door:
        words = ["--network", "1", "--count", "3"]
        with terminal(door, *words, TERM="dumb", columns=60) as shown:
            assert shown.end() == 0
        assert "\x1b" not in shown.raw
        assert shown.raw.count("Y4=0") == 1  # once, as nothing changed


@pytest.mark.parametrize("number", [signal.SIGTERM, signal.SIGINT])
def test_a_signal_leaves_the_terminal_as_it_was(number: signal.Signals) -> None:
    with press() as door, terminal(door) as shown:
        shown.until("M421=0")
        assert not shown.shows_keys
        shown.process.send_signal(number)
        assert shown.end() == 130
        assert shown.shows_keys
    assert "Traceback" not in shown.text


def test_it_ends_where_there_is_no_pause_between_two_rounds() -> None:
    with press() as door, terminal(door, "--interval", "0") as shown:
        shown.until("rounds/s")
        shown.type("q")
        assert shown.end() == 0


def test_it_ends_while_no_connection_can_be_made() -> None:
    with ExitStack() as stack:
        door = stack.enter_context(press())
        with terminal(door, "--timeout", "0.05", "--retries", "0", "--interval", "0") as shown:
            shown.until("rounds/s")
            stack.close()
            shown.until("LINE LOST since")
            shown.type("q")
            assert shown.end() == 0


def test_no_plc_from_the_beginning() -> None:
    with press() as door:
        del door.simulation.plcs[1]
        with terminal(door, "--timeout", "0.05", "--retries", "0") as shown:
            assert shown.end() == 3
            assert shown.shows_keys
        assert "fatektool: no answer" in shown.text


def test_what_is_refused_and_another_program_are_said() -> None:
    with press(program_commands=False) as door:
        door.simulation.plcs[1].memory._sizes["M"] = 300
        with terminal(door, "--network", "1", columns=60) as shown:
            lines = shown.until("M421: ")
            said = " ".join(lines)
            assert "M421=?" in said
            assert "could not be compared with press.pdw" in said
            shown.type("q")
            assert shown.end() == 0
        assert "warning: the PLC's program could not be compared" in shown.text  # and again behind the screen
