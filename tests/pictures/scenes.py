"""What the pictures show: commands on simulated PLCs, with fixed times in place of those of a run."""

from __future__ import annotations

import hashlib
import re
from typing import TYPE_CHECKING, Final, NamedTuple

from fatektool.cli import run
from tests.cli.running import Press, served
from tests.cli.terminal import Terminal
from tests.pictures.screen import colours_of, screen_of, svg_of, text_of

if TYPE_CHECKING:
    from pathlib import Path

COLUMNS: Final = 92
LINES: Final = 40

_SAME_LENGTH: Final = (
    (re.compile(r"\d{4}-\d\d-\d\d([T ])\d\d:\d\d:\d\d(Z?)"), r"2026-11-22\g<1>03:15:00\g<2>"),
    (re.compile(r"(?<![T \d])\d\d:\d\d:\d\d(?=  )"), "03:15:00"),
    (re.compile(r"\d{8}T\d{6}Z"), "20261122T031500Z"),
    (re.compile(r"took(\s+)(?:under )?\d+ s"), r"took\g<1>8 s"),
    (re.compile(r"time(\s+)(?:about|under) \d+ s"), r"time\g<1>about 8 s"),
)
_BAR: Final = re.compile(r"\d+/\d+ pages.*")


class Picture(NamedTuple):
    """A screen: its lines, and the picture of them."""

    lines: list[str]
    svg: str


def _picture(raw: str, title: str, hidden: dict[str, str]) -> Picture:
    screen = screen_of(raw, COLUMNS, LINES)
    rows: list[tuple[str, list[str]]] = []
    for number, found in enumerate(text_of(screen)):
        line = found
        for there, here in hidden.items():
            line = line.replace(there, here)
        for pattern, fixed in _SAME_LENGTH:
            line = pattern.sub(fixed, line)
        if _BAR.search(line):
            continue  # a bar that is full says no more
        colours = colours_of(screen, number) + ["default"] * len(line)
        rows.append((line, colours))
    return Picture([line for line, _ in rows], svg_of(rows, COLUMNS, title))


def _prompt(command: str) -> str:
    return f"\x1b[1m$ fatektool {command}\x1b[0m\r\n"


def watch(_: Path) -> Picture:
    """Values that change while they are watched."""
    rounds = [(120, 3), (180, 1), (150, 0), (210, 5), (260, 7), (240, 6), (300, 2), (320, 4)]
    with served() as door:
        device = door.simulation.plcs[1]
        device.running = True

        def change(to: tuple[int, int]) -> None:
            device.write_words("R", 0, [to[0], 1000 - to[0], 7])
            device.write_discretes("Y", 0, bytes(to[1] >> bit & 1 for bit in range(3)))

        change(rounds[0])
        words = (
            "watch",
            "R0-R2",
            "Y0-Y2",
            "--interval",
            "0.1",
            "--count",
            str(len(rounds)),
            "-p",
            door.target,
        )
        with Terminal(*words, columns=COLUMNS, lines=LINES) as terminal:
            for at, values in enumerate(rounds[1:], 2):
                shown = f"{1000 - rounds[at - 2][0]}"
                terminal.read_until(shown)
                change(values)
            terminal.end()
        raw = _prompt("watch R0-R2 Y0-Y2 -p tcp://192.168.2.3") + terminal.raw
    return _picture(raw, "fatektool watch", {door.target: "tcp://192.168.2.3"})


def restore(folder: Path) -> Picture:
    """A restore with its question."""
    Press(folder, "sim:plc.state")
    words = ("restore", "new.json", "--run", "-p", "sim:plc.state")
    with Terminal(*words, columns=COLUMNS, lines=LINES) as terminal:
        terminal.read_until("[y/N]")
        terminal.type("y\n")
        assert terminal.end() == 0, terminal.text
    raw = _prompt("restore new.json --run -p /dev/ttyUSB0") + terminal.raw
    return _picture(raw, "fatektool restore", {"sim:plc.state": "/dev/ttyUSB0"})


def report(folder: Path) -> str:
    """The report of a comparison, as HTML."""
    Press(folder, "sim:plc.state")
    path = folder / "report.html"
    assert run(["diff", "old.json", "new.json", "--report", str(path), "-q"]) == 1
    found = path.read_text(encoding="utf-8")
    for pattern, fixed in _SAME_LENGTH[:2]:
        found = pattern.sub(fixed, found)
    return found.replace("sim:plc.state", "/dev/ttyUSB0")


def fingerprint(text: str) -> str:
    return hashlib.sha256(text.encode()).hexdigest()


SCREENS: Final = {"watch": watch, "restore": restore}
