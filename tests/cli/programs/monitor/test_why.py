"""``monitor --why``: why an element is on or off, in words and as JSON."""

from __future__ import annotations

from typing import TYPE_CHECKING

import pytest

from tests.cli.programs.monitor.plant import IMAGE, NETWORKS, files, press, switch
from tests.ladder.circuits import words_of
from tests.plant import error_of
from tests.project.files import program_of
from tests.project.images import image_of

if TYPE_CHECKING:
    from tests.cli.running import Cli, Done, Door

RISING = "TU: conducts for one scan when it comes on"
ELSEWHERE = "a display, another PLC or the PLC itself may"


def why(cli: Cli, door: Door, element: str, *words: str, code: int = 0, file: str = "press.pdw") -> list[str]:
    done: Done = cli("monitor", file, "--why", element, "-p", door.target, *words, "--encoding", "cp1250")
    assert done.code == code, done
    return done.out.splitlines()


@pytest.mark.parametrize(
    ("element", "switched", "said"),
    [
        ("Y4", {"X0": 1}, ["Y4 is off: M421 (Wył. zawór) is off", "  N0001  OUT Y4"]),
        ("y4", {"M421": 1}, ["Y4 is off: X0 (START) is off", "  N0001  OUT Y4"]),
        (
            "Y4",
            {"X0": 1, "M421": 1, "Y4": 1},
            ["Y4 is on: X0 (START) is on and M421 (Wył. zawór) is on", "  N0001  OUT Y4"],
        ),
        ("Y0", {}, ["Y0 is off: X1 is off", "  N0000  OUT Y0"]),
        ("Y0", {"Y0": 1}, ["Y0 is on: Y0 is on and X0 (START) is off", "  N0000  OUT Y0"]),
        (
            "Y2",
            {"T204": 1},
            [
                "Y2 is off: M0 is off, and none of 3 ways conducts",
                "  way 1: T206 is off",
                "  way 2: T200 is off and M3 is off",
                "  way 3: T204 is on and T203 is off",
                "  N0005  OUT Y2",
            ],
        ),
        ("Y1", {"X0": 1}, ["Y1 is off: R6 [0] > 0 does not hold", "  N0006  OUT Y1"]),
        (
            "Y1",
            {"X0": 1, "R6": 7, "Y1": 1},
            ["Y1 is on: X0 (START) is on and R6 [7] > 0 holds", "  N0006  OUT Y1"],
        ),
        ("M0", {}, ["M0 is off: T30 is off", "  N0002  OUT M0"]),
        (
            "S3",
            {"X0": 1},
            [
                "S3 (Krok powrotu) is off: 2 instructions write it",
                "  N0003  SET( ) S3: off: X3 is off",
                "  N0004  RST( ) S3: off: X1 is off",
            ],
        ),
        (
            "M403",
            {"X1": 1, "M403": 1},
            [
                "M403 is on: 2 instructions write it",
                "  N0009  OUT M403: off: X0 (START) is off",
                "  N0010  OUT M403: on: X1 is on",
                "several OUT of one element: the last one in the program decides",
            ],
        ),
        (
            "T30",
            {"X1": 1},
            ["T30 is off: T30 .01 R8 writes it", "  N0002  T30 .01 R8: on: X1 is on"],
        ),
        (
            "R100",
            {"R100": 0xFFFE},
            [
                "R100 is -2: FUN 08 MOV S:C0 D:R100 writes it",
                f"  N0007  FUN 08 MOV S:C0 D:R100: off: M300 is off ({RISING})",
            ],
        ),
        ("X1", {"X1": 1}, ["X1 is on: an input, which the program does not write"]),
        (
            "M3",
            {},
            [f"M3 is off: no instruction that is known writes it; {ELSEWHERE}"],
        ),
        ("M99", {}, ["M99 is off: it is not in the program"]),
        ("M400", {"M0": 1}, ["M400 is off: the line before INV carries", "  N0008  OUT M400"]),
        (
            "M6",
            {"M0": 1},
            [
                "M6 is off: SET(P) M6 writes it",
                f"  N0011  SET(P) M6: not known: the line before TU carries ({RISING})",
            ],
        ),
    ],
)
def test_an_answer(cli: Cli, element: str, switched: dict[str, int], said: list[str]) -> None:
    with press() as door:
        switch(door, **switched)
        assert why(cli, door, element) == said
        words = ["--why", element, "-p", door.target, "--json", "--encoding", "cp1250"]
        assert cli("monitor", "press.pdw", *words).document("why")["says"] == said[0]


def test_a_coil_that_does_not_follow_its_line(cli: Cli) -> None:
    with press() as door:
        switch(door, X0=1, M421=1)
        said = why(cli, door, "Y4")
        assert said[0] == "Y4 is off, but its line carries: X0 (START) is on and M421 (Wył. zawór) is on"
        assert said[-1].startswith("its line says otherwise: it was read in another scan")
        door.simulation.plcs[1].running = False
        assert why(cli, door, "Y4")[-1].startswith("the PLC is in STOP: its program does not run")
        door.simulation.plcs[1].running = True
        assert cli("discrete", "disable", "Y4", "-p", door.target, "--yes").code == 0
        assert why(cli, door, "Y4")[0] == "Y4 is off and disabled: the program does not change it"


def test_a_network_that_is_no_circuit(cli: Cli) -> None:
    with press(program_of(image_of(list(words_of("ORG X0", "FUN 15 (+1) C0", "OUT Y0"))))) as door:
        assert cli("backup", "odd.json", "-p", door.target).code == 0
        done = cli("monitor", "odd.json", "--why", "Y0", "-p", door.target)
        (line,) = [line for line in done.out.splitlines() if line.startswith("  N0000")]
        reason = "the state of the line from FUN 15 (+1) C0 to OUT Y0 is not known"
        assert line == f"  N0000  OUT Y0: what reaches it is not known: {reason}"


@pytest.mark.parametrize("swapped", [False, True])
def test_the_program_is_compared_as_far_as_it_is_said(cli: Cli, swapped: bool) -> None:
    with press(program_of(IMAGE, swapped=swapped)) as door:
        done = cli("monitor", "press.pdw", "--why", "Y4", "-p", door.target, "--json")
        program = done.document("why")["program"]
        assert "press.pdw" not in done.err
        assert (program["compared"], program["pages"], program["checksum"]) == ("same", [1, 2, 4], True)


def test_another_program_is_a_warning(cli: Cli) -> None:
    """One contact is another: the checksum differs, and the page."""
    networks = ["ORG X0, AND X3, OUT Y4" if "Y4" in each else each for each in NETWORKS]
    other = image_of(list(words_of(*", ".join(networks).split(", "))))
    with press(program_of(other)) as door:
        done = cli("monitor", "press.json", "--why", "Y4", "-p", door.target)
        assert done.code == 0
        assert done.err.startswith(
            "warning: the PLC's program is not the one in press.json: pages 1, 4 of pages 1-2, 4 differ"
        )
        assert done.out.startswith("Y4 is off: ")


def test_a_plc_that_gives_no_program_out(cli: Cli) -> None:
    with press(program_commands=False) as door:
        done = cli("monitor", "press.json", "--why", "Y4", "-p", door.target)
        assert done.code == 0
        assert "could not be compared with press.json: the PLC refuses page 1 of its program (4F)" in done.err
        assert done.out.startswith("Y4 is off: ")


def test_an_element_that_the_plc_refuses(cli: Cli) -> None:
    with press() as door:
        door.simulation.plcs[1].memory._sizes["M"] = 400
        done = cli("monitor", "press.json", "--why", "Y4", "-p", door.target, "--json")
        document = done.document("why")
        assert (done.code, list(document["errors"])) == (0, ["M421"])
        assert document["says"].startswith("Y4 is off: X0 is off and M421 is not known")
        done = cli("monitor", "press.json", "--why", "M403", "-p", door.target)
        assert done.code == 4
        assert done.out.startswith("M403 is not known: ")


@pytest.mark.parametrize(("element", "code"), [("Q1", 2), ("Y999", 2), ("", 2), ("R", 2)])
def test_no_element(cli: Cli, element: str, code: int) -> None:
    files()
    assert "element" in error_of(cli("monitor", "press.json", "--why", element, "-p", "sim:"), code)


def test_it_reads_only(cli: Cli) -> None:
    with press() as door:
        before = door.pages
        assert why(cli, door, "Y4", "--read-only")
        assert door.pages == before
