"""``listing --ladder``: the networks drawn, as wide as what they are drawn on."""

from __future__ import annotations

import re
from pathlib import Path
from random import Random
from typing import TYPE_CHECKING

import pytest

from fatektool.ladder.drawing.text.letters import width_of
from fatektool.simulator.program.fbs_code import random_code
from tests.cli.running import process
from tests.cli.terminal import Terminal
from tests.project.files import ELEMENTS, IMAGE, project_file
from tests.project.images import image_of

if TYPE_CHECKING:
    from tests.cli.running import Cli

DRAWN = """\
unit MAIN
N0000  Motor
│  X0      X0      Y0
├──┤ ├──┬──┤/├─────( )
│ START │ START   MOTOR
│  M0   │
├──┤ ├──┘

N0001
│  M0    ┌─FUN 08 MOV──┐
├──┤ ├───┤EN S:5       │
│        │   D:R8 TIME │
│        └─────────────┘

N0002
│  X1    ┌─T30 .01──────┐   M0
├──┤ ├───┤EN R8 TIME TUP├───( )
│        └──────────────┘

N0003
│  T30     Y0
├──┤ ├─────( )
│         MOTOR

N0004
not drawn: ?? 3FF4 9041 is not known, and its number of words is not known either (instruction 0014)
  0013  ORG X2
  0014  ?? 3FF4 9041

N0005
│┌─~FUN 65 LBL SETID0─┐
││                    │
│└────────────────────┘
│┌─~FUN 68 RTS────────┐
││                    │
│└────────────────────┘
"""


@pytest.fixture(autouse=True)
def press(place: Path) -> Path:
    project_file("press.pdw", IMAGE, elements=ELEMENTS, networks={0x0200: b"Motor"})
    return place / "press.pdw"


def test_a_project_drawn(cli: Cli, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setenv("COLUMNS", "100")
    done = cli("listing", "press.pdw", "--ladder")
    assert (done.code, done.out) == (0, DRAWN)
    assert "2 of 25 words of code are not known" in done.err
    one = cli("listing", "press.pdw", "--ladder", "--network", "3").out
    assert one == DRAWN[DRAWN.index("N0003") : DRAWN.index("\nN0004")]


def test_what_is_piped_has_80_columns_and_is_utf8(press: Path) -> None:
    for more in ({}, {"LC_ALL": "C", "PYTHONIOENCODING": ""}):
        done = process("listing", press, "--ladder", redirect="| cat", **more)
        assert "├──┤ ├──┬──┤/├─────( )" in done.out
        assert max(map(width_of, done.out.splitlines())) <= 80
        assert re.search(r"^not drawn: .*\n {8}.*\(instruction 0014\)$", done.out, re.MULTILINE)


@pytest.mark.parametrize("columns", [60, 80, 120, 200, 300])
def test_a_program_on_a_terminal_is_as_wide_as_that(columns: int) -> None:
    code = random_code(Random(3), 1200)  # noqa: S311  # a fixed seed
    comments = {f"X{number}": f"Czujnik położenia {number}".encode("cp1250") for number in range(100)}
    comments |= {f"M{number}": "Zawór główny".encode("cp1250") for number in range(200)}
    project_file("big.pdw", image_of(code), elements=comments)
    with Terminal("listing", "big.pdw", "--ladder", columns=columns) as terminal:
        assert terminal.end() == 0
    lines = terminal.text.splitlines()
    widest = max(map(width_of, lines))
    assert widest <= min(columns, 200)
    assert widest > 50
    assert sum(line.startswith("N0") for line in lines) > 100
    assert ("►" in terminal.text) == (columns == 60)


def test_ascii_on_a_terminal_that_has_nothing_else(press: Path) -> None:
    with Terminal("listing", press, "--ladder", "-q", PYTHONIOENCODING="ascii") as terminal:
        assert terminal.end() == 0
    assert terminal.text.isascii()
    assert "+--] [--+--]/[-----( )" in terminal.text


def test_a_heading_that_is_too_wide_is_broken(cli: Cli, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setenv("COLUMNS", "60")
    project_file("press.pdw", IMAGE, networks={0x0200: b"word " * 30})
    lines = cli("listing", "press.pdw", "--ladder", "--network", "0").out.splitlines()
    assert lines[1].startswith("N0000 word word")
    assert lines[2].startswith("        word word")
    assert max(map(width_of, lines)) <= 60


def test_a_page_beside_it(cli: Cli) -> None:
    assert cli("listing", "press.pdw", "--ladder", "--report", "press.html").code == 0
    assert Path("press.html").exists()
