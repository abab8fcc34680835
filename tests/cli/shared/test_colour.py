"""Colour: where it is shown, and what has it; without it the text is the same."""

from __future__ import annotations

import io
import re
from typing import TYPE_CHECKING

import pytest
from hypothesis import given
from hypothesis import strategies as st

from fatektool.cli.shared.colour import (
    Coloured,
    Style,
    bad,
    coloured,
    diff_line,
    joined,
    rendered,
    shows_colour,
    word,
)
from fatektool.cli.shared.output import table, visible
from fatektool.program.archive import save_backup
from tests.cli.running import process
from tests.cli.terminal import Terminal
from tests.program.samples import backup, changed, program

if TYPE_CHECKING:
    from pathlib import Path

    from tests.cli.running import Press

RED, GREEN, YELLOW, CYAN = "\x1b[31m", "\x1b[32m", "\x1b[33m", "\x1b[36m"
FAULT, END = "\x1b[1;31m", "\x1b[0m"
CODES = re.compile(r"\x1b\[[0-9;]*m")


class Screen(io.StringIO):
    """A stream that is a terminal."""

    def isatty(self) -> bool:
        return True


@pytest.mark.parametrize(
    ("variables", "terminal", "shown"),
    [
        ({}, True, True),
        ({}, False, False),
        ({"NO_COLOR": "1"}, True, False),
        ({"NO_COLOR": ""}, True, True),
        ({"TERM": "dumb"}, True, False),
        ({"FORCE_COLOR": "1"}, False, True),
        ({"FORCE_COLOR": "0"}, True, False),
        ({"FORCE_COLOR": ""}, False, False),
        ({"FORCE_COLOR": "1", "TERM": "dumb"}, False, True),
        ({"FORCE_COLOR": "1", "NO_COLOR": "1"}, True, False),
    ],
)
def test_where_colour_is_shown(
    monkeypatch: pytest.MonkeyPatch, variables: dict[str, str], terminal: bool, shown: bool
) -> None:
    for name in ("NO_COLOR", "FORCE_COLOR"):
        monkeypatch.delenv(name, raising=False)
    monkeypatch.setenv("TERM", "xterm")
    for name, value in variables.items():
        monkeypatch.setenv(name, value)
    assert shows_colour(Screen() if terminal else io.StringIO()) is shown


@pytest.fixture
def forced(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.delenv("NO_COLOR", raising=False)
    monkeypatch.setenv("FORCE_COLOR", "1")


@pytest.mark.usefixtures("forced")
@pytest.mark.parametrize(
    ("text", "written"),
    [
        (word("RUN"), f"{GREEN}RUN{END}"),
        (word("STOP"), f"{YELLOW}STOP{END}"),
        (word("FAILED"), f"{FAULT}FAILED{END}"),
        (word("unknown"), "unknown"),
        (bad("LOW", ": replace it"), f"{FAULT}LOW{END}: replace it"),
        (diff_line("-AND X0"), f"{RED}-AND X0{END}"),
        (diff_line("+AND X0"), f"{GREEN}+AND X0{END}"),
        (diff_line("@@ N0 @@"), f"{CYAN}@@ N0 @@{END}"),
        (diff_line(" OUT Y0"), " OUT Y0"),
        (joined("it is in ", word("RUN"), ", ", bad("LOW")), f"it is in {GREEN}RUN{END}, {FAULT}LOW{END}"),
        (coloured("\x1b[2J", Style.BAD), f"{FAULT}\\x1b[2J{END}"),
        (coloured("", Style.BAD), ""),
        ("plain \x07", "plain \\x07"),
    ],
)  # fmt: skip
def test_what_is_written(text: str, written: str) -> None:
    assert rendered(text, io.StringIO(), visible) == written


@given(st.lists(st.tuples(st.text(max_size=8), st.sampled_from([*Style, None])), max_size=6))
def test_the_text_is_the_same_in_colour_and_without(parts: list[tuple[str, Style | None]]) -> None:
    made = joined(*(coloured(text, style) for text, style in parts))
    plain = "".join(text for text, _ in parts)
    assert made == plain
    with pytest.MonkeyPatch.context() as patch:
        patch.delenv("NO_COLOR", raising=False)
        patch.setenv("FORCE_COLOR", "1")
        in_colour = rendered(made, io.StringIO(), visible)
        patch.setenv("NO_COLOR", "1")
        assert rendered(made, io.StringIO(), visible) == visible(plain)
    assert CODES.sub("", in_colour) == visible(plain)
    assert in_colour.count(END) == sum(bool(text) and style is not None for text, style in parts)


def test_a_table_keeps_styles_and_columns() -> None:
    rows = list(table([("mode", word("RUN")), ("emergency stop", "no")]))
    assert rows == ["mode            RUN", "emergency stop  no"]
    assert isinstance(rows[0], Coloured)
    assert rows[0].spans == ((16, 19, Style.GOOD),)


# --- on a real screen -----------------------------------------------------------------------------------


def test_a_status_on_a_terminal(press: Press) -> None:
    mode = f"{GREEN}RUN{END}" if press.running else f"{YELLOW}STOP{END}"
    with Terminal("status", "--brief", "-p", press.target, NO_COLOR="", FORCE_COLOR="", TERM="xterm") as one:
        assert one.end() == 0
        assert f"mode             {mode}" in one.raw
    with Terminal("status", "--brief", "-p", press.target, NO_COLOR="1") as one:
        assert one.end() == 0
        assert "\x1b" not in one.raw
    with Terminal("status", "--brief", "-p", press.target, TERM="dumb") as one:
        assert one.end() == 0
        assert "\x1b" not in one.raw


def test_errors_and_warnings(press: Press, place: Path) -> None:
    with Terminal("inspect", "nowhere.json", TERM="xterm", NO_COLOR="", FORCE_COLOR="") as one:
        assert one.end() == 2
        assert f"{FAULT}fatektool:{END} " in one.raw
    save_backup(backup(program(400), target="/dev/ttyUSB7"), place / "other.json")
    done = process("restore", "other.json", "--dry-run", "-p", press.target)
    assert "\x1b" not in done.out + done.err
    assert "warning: " in done.err


def test_a_diff_in_a_pipe_that_wants_colour(place: Path) -> None:
    save_backup(backup(program(400)), place / "a.json")
    save_backup(backup(changed(program(400), 3)), place / "b.json")
    done = process("diff", "a.json", "b.json", FORCE_COLOR="1", NO_COLOR="")
    assert done.out.startswith(f"{FAULT}differs{END}: 1 word in 1 page")
    assert process("diff", "a.json", "b.json", NO_COLOR="", FORCE_COLOR="").out.startswith("differs: ")
