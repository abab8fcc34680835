"""``watch``: a table that lives on a terminal, a line a round elsewhere."""

from __future__ import annotations

import json
import signal
from collections import deque
from typing import TYPE_CHECKING, Any

import pytest
from hypothesis import given
from hypothesis import strategies as st

from fatektool.cli.elements.watch.table import trend
from tests.cli.running import check, served, started
from tests.cli.terminal import Terminal
from tests.plant import cut_after, error_of, spied

if TYPE_CHECKING:
    from pathlib import Path

    from fatektool.simulator.memory import SimulatedMemory
    from tests.plant import Plant

BARS = "▁▂▃▄▅▆▇█"
pytestmark = pytest.mark.usefixtures("no_waiting")


@pytest.fixture
def no_waiting(monkeypatch: pytest.MonkeyPatch) -> list[float]:
    """No round waits for the next; gives how long each would have."""
    waits: list[float] = []
    monkeypatch.setattr("time.sleep", waits.append)
    return waits


def rounds(text: str) -> list[Any]:
    found = [json.loads(line) for line in text.splitlines()]
    for document in found:
        if document["schema"] != "fatektool.error/1":
            check(document, "watch")
    return found


def test_a_line_a_round(plant: Plant, no_waiting: list[float]) -> None:
    plant.write("R0=5", "D4:f32=1.5", "M0=on")
    done = plant.cli("watch", "R0", "D4:f32", "M0", "--interval", "60", "--count", "3")
    assert (done.code, done.err) == (0, "")
    assert [each["values"] for each in rounds(done.out)] == [{"R0": 5, "D4": 1.5, "M0": True}] * 3
    assert 59 < no_waiting[0] <= 60
    assert len(no_waiting) == 2


def test_refused_elements_are_null(plant: Plant) -> None:
    done = plant.cli("watch", "R0", "R9000", "--count", "2")
    assert done.code == 4
    assert [each["values"] for each in rounds(done.out)] == [{"R0": 0, "R9000": None}] * 2
    assert list(rounds(done.out)[0]["errors"]) == ["R9000"]


def test_the_pace_of_a_specification(plant: Plant, place: Path, no_waiting: list[float]) -> None:
    (place / "a.toml").write_text('interval_s = 7\n[[item]]\nelement = "R0"\nname = "x"\n')
    assert plant.cli("watch", "--spec", "a.toml", "--count", "2").code == 0
    assert 6 < no_waiting.pop() <= 7
    assert plant.cli("watch", "--spec", "a.toml", "--count", "2", "--interval", "90").code == 0
    assert 89 < no_waiting.pop() <= 90


@pytest.mark.parametrize(
    "words",
    [
        [],
        ["R0", "--interval", "nan"],
        ["R0", "--interval", "-1"],
        ["R0", "--count", "0"],
        ["R0", "--all"],
        ["Q0"],
    ],
)
def test_what_cannot_be(plant: Plant, words: list[str]) -> None:
    error_of(plant.cli("watch", *words), 2)


def test_only_its_own_options_are_named(plant: Plant) -> None:
    expected = "fatektool: expected one of: ELEMENTS, --spec FILE.toml"
    assert error_of(plant.cli("watch"), 2) == expected
    assert error_of(plant.cli("snapshot", "take"), 2) == f"{expected}, --all"


def test_a_line_that_comes_and_goes(plant: Plant, monkeypatch: pytest.MonkeyPatch) -> None:
    """A round that fails is told and tried again; many in a row end it."""
    seen: list[bytes] = []
    spied(monkeypatch, seen.append, lambda: not 8 < len(seen) < 16)
    done = plant.cli("watch", "R0", "--count", "6", "--retries", "0")
    assert done.code == 0
    assert len(rounds(done.out)) == 6
    assert "trying again" in done.err


def test_a_line_that_stays_dead(plant: Plant, monkeypatch: pytest.MonkeyPatch) -> None:
    cut_after(monkeypatch, 12)
    done = plant.cli("watch", "R0", "--json")
    assert done.code == 3
    *values, last = rounds(done.out)  # every line is JSON, the error too
    assert values
    check(last, "error")
    assert done.err.splitlines()[-1].startswith("fatektool: no answer")


def test_ctrl_c_without_a_terminal(plant: Plant) -> None:
    for words in ([], ["--json"]):
        job = started("watch", "R0", "--interval", "0.01", "-p", plant.target, *words)
        assert job.stdout is not None
        first = job.stdout.readline()
        job.send_signal(signal.SIGINT)
        out, err = job.communicate()
        assert job.returncode == 130
        assert err.splitlines()[-1] == "fatektool: interrupted"
        found = rounds(first + out)
        assert (found[-1]["schema"] == "fatektool.error/1") == bool(words)


def change_round_by_round(memory: SimulatedMemory) -> None:
    """A PLC whose R0 counts the times that it is read."""
    read = memory.read_words

    def counting(symbol: str, address: int, count: int) -> list[int]:
        memory.registers["R"][0] += 1
        return read(symbol, address, count)

    memory.read_words = counting  # type: ignore[method-assign]  # a PLC whose program counts


@pytest.mark.parametrize("columns", [100, 60, 24])
def test_the_table(columns: int) -> None:
    with served() as door:
        memory = door.simulation.plcs[1].memory
        change_round_by_round(memory)
        words = ["watch", "R0", "R5", "D4:f32", "M0", "R9000", "--interval", "0.01", "-p", door.target]
        with Terminal(*words, columns=columns, lines=20, PYTHONUTF8="1") as terminal:
            # On a busy machine a round may not be drawn, and then no trend has exactly one of each.
            terminal.read_until_like("▁+▂+▃+▄+▅+▆+▇+█+" if columns > 40 else "▁")
            terminal.read_until("*")
            terminal.type("\x03")
            assert terminal.end() == 130
        assert terminal.raw.count("\x1b[?25l") == terminal.raw.count("\x1b[?25h") == 1  # the cursor is back
        assert "\x1b[1;7m" in terminal.raw  # what changed stands out
        text = terminal.text.replace("\r", "\n").replace("^C", "")
        assert max(map(len, text.splitlines())) <= columns
        assert all(f"\n{name} " in text for name in ("element", "R0", "R5", "D4", "M0", "R9000"))
        assert "STOP" in text or columns < 40
        assert text.rstrip().endswith("fatektool: interrupted")
        assert "Traceback" not in text


def test_a_narrow_terminal_shows_the_end_of_the_trend() -> None:
    with served() as door:
        change_round_by_round(door.simulation.plcs[1].memory)
        words = ["watch", "R0", "D4:f32", "--count", "20", "--interval", "0", "-p", door.target]
        with Terminal(*words, columns=26) as terminal:
            assert terminal.end() == 0
        last = terminal.text.rpartition("\nR0 ")[2].splitlines()[0]
        assert last.strip().endswith("█")
        assert "▁" not in last  # the lowest was long ago
        assert "…" not in last


def test_more_elements_than_lines() -> None:
    with (
        served() as door,
        Terminal(
            "watch", "R0-R99", "--count", "2", "--interval", "0", "-p", door.target, lines=12
        ) as terminal,
    ):
        assert terminal.end() == 0
        assert "and 92 more" in terminal.text
        assert "R7 " in terminal.text
        assert "R8 " not in terminal.text


def test_a_target_that_looks_like_markup(place: Path) -> None:
    words = ["watch", "R0", "--count", "2", "--interval", "0", "-p", f"sim:{place}/[red]x[y]"]
    with Terminal(*words, columns=200) as terminal:
        assert terminal.end() == 0
    assert "[red]x[y]" in terminal.text


def test_units_and_changes(plant: Plant, place: Path) -> None:
    (place / "a.toml").write_text('[[item]]\nelement = "R0"\nname = "[b]oil"\nunit = "°C"\nscale = 0.5\n')
    plant.write("R0=43")
    with Terminal("watch", "--spec", "a.toml", "--count", "1", "-p", plant.target) as terminal:
        assert terminal.end() == 0
    assert "[b]oil" in terminal.text
    assert "21.5" in terminal.text
    assert "°C" in terminal.text


def test_the_trend() -> None:
    assert trend(deque(), BARS) == ""
    assert trend(deque([5.0, 5.0]), BARS) == "▁▁"
    assert trend(deque(map(float, range(8))), BARS) == "▁▂▃▄▅▆▇█"
    assert trend(deque([-1.7e308, 0.0, 1.7e308]), BARS) == "▁▅█"


@given(st.lists(st.floats(allow_nan=False, allow_infinity=False), max_size=24))
def test_the_trend_of_anything(values: list[float]) -> None:
    assert len(trend(deque(values), BARS)) == len(values)
