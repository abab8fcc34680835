"""Questions and progress bars, on a terminal and without one."""

from __future__ import annotations

import re
from pathlib import Path

import pytest

from fatektool.program.archive import load_backup
from tests.cli.running import NEW, OLD, Press, process, served
from tests.cli.terminal import Terminal
from tests.pictures.screen import screen_of, text_of
from tests.program.samples import program

CTRL_C, CTRL_D = "\x03", "\x04"


# --- questions ------------------------------------------------------------------------------------------


def test_restore_asks_and_yes_is_yes(press: Press) -> None:
    with Terminal("restore", press.new, "-p", press.target) as terminal:
        terminal.read_until("? [y/N]: ")
        (safety,) = press.safety  # on disk before the question
        assert load_backup(safety).program == OLD
        assert press.program == OLD
        for line in (
            "The PLC's program differs in pages 1-7 (448 words).",
            f"Previous program saved in {safety.name}",
            "All 8 pages will be written, then all read back.",
            "--changed-only writes only the 7 pages that differ.",
            "PLC    station 1 on sim:plc.state",
            "model  MC, 28 points, OS 3.1",
            "mode   STOP",
            "file   new.json",
            "from   station 1 on sim:plc.state, 2026-11-22T03:15:00Z",
            "time   ",
            "Write the program into station 1 on sim:plc.state? [y/N]: ",
        ):
            assert line in terminal.text.replace(f"{press.folder}/", "").replace("\n", " ")
        terminal.type("y\n")
        assert terminal.end() == 0
        assert any(line.endswith("? [y/N]: y") for line in text_of(screen_of(terminal.raw, 80, 60))), "erased"
    assert press.program == NEW


@pytest.mark.parametrize("command", ["restore", "run", "stop"])
@pytest.mark.parametrize(
    ("keys", "code"),
    [("n\n", 2), ("\n", 2), (CTRL_D, 2), (CTRL_C, 130), ("maybe\nno\n", 2), ("maybe\nYES\n", 0)],
    ids=["n", "enter", "ctrl-d", "ctrl-c", "maybe no", "maybe yes"],
)
def test_an_answer(press: Press, command: str, keys: str, code: int) -> None:
    if command == "stop":
        press.set("running")
    words = [command, press.new] if command == "restore" else [command]
    with Terminal(*words, "-p", press.target) as terminal:
        terminal.read_until("? [y/N]: ")
        if command != "restore":
            mode = "RUN" if command == "run" else "STOP"
            assert f"Station 1 on {press.target} is in" in terminal.text.replace("\n", "")
            assert f"{mode}? [y/N]: " in terminal.text
        terminal.type(keys)
        assert terminal.end() == code
        last = terminal.text.rstrip("\n").rsplit("\n", 1)[-1]
    if code == 0:
        assert (press.program == NEW) == (command == "restore")
        assert press.running == (command == "run")
        return
    assert press.program == OLD
    assert press.safety == []  # nothing needs a way back
    assert press.running == (command == "stop")
    assert "Traceback" not in terminal.text
    if code == 130:
        stays = {"restore": "nothing was written", "run": "the PLC stays in STOP"}
        assert last == f"fatektool: interrupted: {stays.get(command, 'the PLC stays in RUN')}"
    else:
        assert "fatektool: Aborted. " in terminal.text
    if "maybe" in keys:
        assert "please answer y or n" in terminal.text


def test_a_question_is_on_stderr_and_stdout_is_the_document_alone(press: Press) -> None:
    with (
        Path("out").open("wb") as out,
        Terminal("run", "--json", "-p", press.target, stdout=out.fileno()) as one,
    ):
        one.read_until("[y/N]: ")
        one.type("y\n")
        assert one.end() == 0
    text = Path("out").read_text()
    assert text.startswith("{\n")
    assert text.endswith("}\n")
    assert "mode_after" not in one.text


def test_nothing_is_asked_if_stdin_is_no_terminal(press: Press) -> None:
    for redirect in ("< /dev/null", "<&-"):
        done = process("run", "-p", press.target, redirect=redirect)
        assert done.code == 2
        assert "add --yes" in done.err
    assert not press.running


# --- progress bars --------------------------------------------------------------------------------------


@pytest.mark.parametrize("columns", [60, 100])
def test_a_bar_shows_pages_rate_and_time_left(place: Path, columns: int) -> None:
    with served(program(1000)) as door, Terminal(
        "backup", "x.json", "-p", door.target, columns=columns
    ) as terminal:  # fmt: skip
        assert terminal.end() == 0
        text = terminal.text
    assert re.search(r"\b34/34\b", text)
    assert re.search(r"\bpages\b", text)
    assert re.search(r"\d+\.\d/s", text)
    assert re.search(r"\d:\d\d:\d\d", text)
    assert "…" not in text
    assert load_backup(place / "x.json").program == program(1000)


def test_the_longest_bar_fits_into_sixty_columns(press: Press) -> None:
    with served() as door, Terminal(
        "restore", press.new, "-p", door.target, "--yes", columns=60
    ) as terminal:  # fmt: skip
        assert terminal.end() == 0
        lines = terminal.text.splitlines()
    for phase, pages in (("reading", 16), ("writing", 8), ("reading back", 8)):
        # A phase that took no time has no rate, and a busy computer takes longer.
        bar = rf"{phase} +━+ {pages}/{pages} pages +(?:[0-9.]+/s +)?\d:\d\d:\d\d"
        assert any(re.fullmatch(bar, line) for line in lines), lines


def test_no_bar_where_nobody_looks(press: Press) -> None:
    for done in (
        process("backup", "a.json", "-p", press.target),
        process("backup", "b.json", "-p", press.target, redirect="2>&1 | cat"),
    ):
        assert done.code == 0
        assert "\x1b" not in done.out + done.err
        assert "pages" not in done.err
        assert done.out.count("\n") == 5
        assert done.err == ""


def test_quiet_has_no_bar_on_a_terminal_either(press: Press) -> None:
    with Terminal("backup", "x.json", "-p", press.target, "-q") as terminal:
        assert terminal.end() == 0
        assert "\x1b" not in terminal.raw
        assert "/s" not in terminal.text


def test_no_color(press: Press) -> None:
    colors = re.compile(r"\x1b\[[0-9;]*[1-9][0-9;]*m")
    with Terminal("backup", "x.json", "-p", press.target) as terminal:
        assert terminal.end() == 0
        assert colors.search(terminal.raw)
    with Terminal("backup", "y.json", "-p", press.target, NO_COLOR="1") as terminal:
        assert terminal.end() == 0
        assert not colors.search(terminal.raw)


@pytest.mark.parametrize(("columns", "lines"), [(0, 0), (1, 1), (3, 1), (20, 2), (65535, 65535)])
def test_a_broken_terminal_size(press: Press, columns: int, lines: int) -> None:
    with Terminal("backup", "x.json", "-p", press.target, columns=columns, lines=lines) as terminal:
        assert terminal.end() == 0
    with Terminal("--help", columns=columns, lines=lines) as terminal:
        assert terminal.end() == 0
        assert "Programs" in terminal.text


@pytest.mark.parametrize("setting", ["COLUMNS=x", "COLUMNS=-5", "COLUMNS=0", "LINES=x", "TERM=dumb", "TERM="])
def test_a_broken_environment(press: Press, monkeypatch: pytest.MonkeyPatch, setting: str) -> None:
    name, _, value = setting.partition("=")
    monkeypatch.setenv(name, value)
    with Terminal("backup", "x.json", "-p", press.target) as terminal:
        assert terminal.end() == 0


def test_a_backup_to_stdout_is_not_disturbed_by_the_bar(press: Press) -> None:
    with (
        Path("out").open("wb") as out,
        Terminal("backup", "-", "-p", press.target, stdout=out.fileno()) as one,
    ):
        assert one.end() == 0
    assert load_backup(Path("out")).program == OLD
    assert "/s" in one.text


def test_redirected_stdout_is_utf_8_also_where_latin_1_is_asked_for(press: Press) -> None:
    name = "塔.json"
    press.old.replace(name)
    done = process("inspect", name, PYTHONIOENCODING="latin-1")
    assert done.code == 0
    assert f"{name}: complete" in done.out
