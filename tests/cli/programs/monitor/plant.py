"""A PLC with a program of one network of each kind, served over TCP, and files of that program."""

from __future__ import annotations

from contextlib import contextmanager
from typing import TYPE_CHECKING, Any

from tests.cli.running import served
from tests.ladder.circuits import words_of
from tests.project.files import backup_file, program_of, project_file
from tests.project.images import image_of

if TYPE_CHECKING:
    from collections.abc import Iterator

    from fatektool.program.image import Program
    from tests.cli.running import Door

NETWORKS = (
    "ORG X1, OR Y0, AND NOT X0, OUT Y0",
    "ORG X0, AND M421, OUT Y4",
    "ORG X1, T30 .01 R8, FO 0, OUT M0",
    "ORG X0, AND X3, SET( ) S3",
    "ORG X1, RST( ) S3",
    "ORG M0, LD T200, AND NOT T201, AND M3, LD NOT T204, AND T203, ORLD, LD T206, ORLD, ANDLD, OUT Y2",
    "ORG X0, ANDF 171 > Sa:R6 Sb:0, OUT Y1",
    "ORG TU M300, FUN 08 MOV S:C0 D:R100",
    "ORG M0, INV, OUT M400",
    "ORG X0, OUT M403",
    "ORG X1, OUT M403",
    "ORG M0, TU, SET(P) M6",
)
IMAGE = image_of(list(words_of(*", ".join(NETWORKS).split(", "))))
ELEMENTS = {"X0": b"START", "M421": "Wył. zawór".encode("cp1250"), "S3": "Krok powrotu".encode("cp1250")}


def files() -> None:
    """``press.json`` and ``press.pdw`` in the working folder."""
    backup_file("press.json", IMAGE)
    project_file("press.pdw", IMAGE, elements=ELEMENTS)


@contextmanager
def press(program: Program | None = None, *, running: bool = True, **options: Any) -> Iterator[Door]:
    """The PLC, in RUN."""
    files()
    with served(program or program_of(IMAGE), **options) as door:
        door.simulation.plcs[1].running = running
        yield door


def switch(door: Door, **elements: int) -> None:
    """Set discretes and registers, inputs too, as the machine would."""
    plc = door.simulation.plcs[1]
    for name, value in elements.items():
        symbol = name.rstrip("0123456789")
        address = int(name[len(symbol) :])
        if symbol == "X":
            plc.set_input(address, value)
        elif symbol in {"Y", "M", "S", "T", "C"}:
            plc.memory.status[symbol][address] = value
        else:
            plc.memory.registers[symbol][address] = value
