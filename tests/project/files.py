"""Backups and projects of the same program, as files."""

from __future__ import annotations

from pathlib import Path
from typing import TYPE_CHECKING, Any

from fatektool.program.archive import save_backup
from fatektool.program.image import Program
from tests.program.samples import backup
from tests.project.images import FBS, Image, image_of
from tests.project.pdw import project

if TYPE_CHECKING:
    from tests.project.images import Model


def program_of(image: Image, *, pages: int = 512, swapped: bool = False) -> Program:
    """What a PLC gives: all its memory in pages, in either byte order."""
    data = bytearray(image.memory.ljust(128 * pages, b"\xff")[: 128 * pages])
    if swapped:
        data[::2], data[1::2] = data[1::2], data[::2]
    return Program(64 * (pages - 1), tuple(bytes(data[at : at + 128]) for at in range(0, len(data), 128)))


def backup_file(name: str, image: Image, **options: Any) -> Path:
    path = Path(name)
    save_backup(backup(program_of(image, **options)), path)
    return path


def project_file(name: str, image: Image, model: Model = FBS, **options: Any) -> Path:
    path = Path(name)
    path.write_bytes(project(image, model, **options))
    return path


MAIN = [
    *(0x0040, 0x10A8, 0x0090, 0x00C1),  # ORG X0, OR M0, AND NOT X0, OUT Y0
    *(0x1048, 0xACF5, 0x0500, 0x100A),  # ORG M0, FUN 08 MOV S:5 D:R8
    *(0x0140, 0x80FC, 0x100A, 0xCC03, 0xFC6F, 0x10C8),  # ORG X1, T30 .01 R8, FO 0, OUT M0
    *(0x1E42, 0x81EE, 0x00C1),  # ORG T30, drawing, OUT Y0
    *(0x0240, 0x3FF4, 0x9041),  # ORG X2, an unknown function of D200
]
SUB = [0x53EF, 0xD422, 0xC424, 0x0018, 0x8EF4]  # LBL SETID0, RTS
IMAGE = image_of(MAIN, SUB)
ELEMENTS = {"X0": b"START", "Y0": b"MOTOR", "R8": b"TIME"}
