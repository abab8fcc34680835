r"""Back up, verify and restore ladder programs of FATEK/FACON PLCs, and diagnose them.

A library user needs three names::

    import fatektool

    with fatektool.connect("/dev/ttyUSB0", station=1) as plc:
        program = fatektool.backup(plc)

``Plc`` has a method for each command, ``is_open``, ``is_alive()``, and ``station``, which can be set to ask
another PLC on the same line. Who sends and reads bytes himself has these::

    asked = fatektool.parse_command("46", "R12", "3").request
    fatektool.frame(asked, station=1, protocol="facon")  # b"\x02014603R0001275\x03"
    fatektool.checksum(b"\x02014603R00012")  # b"75"
    fatektool.error_text(0xA)  # "illegal address, past what this PLC has"

Everything here is loaded when it is first used, so that ``import fatektool`` costs next to nothing
and never loads the command line's libraries.
"""

from __future__ import annotations

import importlib
from typing import TYPE_CHECKING, Any

from fatektool.version import __version__

if TYPE_CHECKING:
    from fatektool.address import PlcAddress
    from fatektool.client import Plc
    from fatektool.connection import connect
    from fatektool.errors import FatektoolError
    from fatektool.jobs.command_words import parse_command
    from fatektool.jobs.programs.backup import backup
    from fatektool.jobs.programs.restore import restore
    from fatektool.jobs.programs.verify import verify
    from fatektool.jobs.status import read_status
    from fatektool.program.archive import Backup, load_backup, save_backup
    from fatektool.program.compare import compare
    from fatektool.program.headers.header import Header
    from fatektool.program.image import Program
    from fatektool.project.program_file import ProgramFile, load_program
    from fatektool.protocol.elements import Element
    from fatektool.protocol.frames import checksum, error_text, frame

_HOMES = {
    "Backup": "fatektool.program.archive",
    "Element": "fatektool.protocol.elements",
    "FatektoolError": "fatektool.errors",
    "Header": "fatektool.program.headers.header",
    "Plc": "fatektool.client",
    "PlcAddress": "fatektool.address",
    "Program": "fatektool.program.image",
    "ProgramFile": "fatektool.project.program_file",
    "backup": "fatektool.jobs.programs.backup",
    "checksum": "fatektool.protocol.frames",
    "compare": "fatektool.program.compare",
    "connect": "fatektool.connection",
    "error_text": "fatektool.protocol.frames",
    "frame": "fatektool.protocol.frames",
    "load_backup": "fatektool.program.archive",
    "load_program": "fatektool.project.program_file",
    "parse_command": "fatektool.jobs.command_words",
    "read_status": "fatektool.jobs.status",
    "restore": "fatektool.jobs.programs.restore",
    "save_backup": "fatektool.program.archive",
    "verify": "fatektool.jobs.programs.verify",
}

__all__ = [
    "Backup",
    "Element",
    "FatektoolError",
    "Header",
    "Plc",
    "PlcAddress",
    "Program",
    "ProgramFile",
    "__version__",
    "backup",
    "checksum",
    "compare",
    "connect",
    "error_text",
    "frame",
    "load_backup",
    "load_program",
    "parse_command",
    "read_status",
    "restore",
    "save_backup",
    "verify",
]


def __getattr__(name: str) -> Any:
    """Load a public name from its home when it is first asked for."""
    if name not in _HOMES:
        raise AttributeError(f"module {__name__!r} has no attribute {name!r}")
    value = getattr(importlib.import_module(_HOMES[name]), name)
    globals()[name] = value
    return value


def __dir__() -> list[str]:
    return sorted(set(globals()) | set(__all__))
