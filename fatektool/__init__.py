r"""Back up, verify and restore ladder programs of FATEK/FACON PLCs, read and write them, and diagnose them.

::

    import fatektool

    with fatektool.connect("/dev/ttyUSB0", station=1) as plc:
        plc.read("R12", "D4:f32", "X0-X7")
        plc.write({"R12": 5, "Y0": True})
        program = fatektool.backup(plc)

``dir(fatektool)`` shows all that is meant to be used, ``docs/library.md`` has an example of each. A name is
loaded when it is first used, so that ``import fatektool`` costs next to nothing and never loads the command
line's libraries.
"""

from __future__ import annotations

import importlib
from typing import TYPE_CHECKING, Any

from fatektool.version import __version__

if TYPE_CHECKING:
    from fatektool.address import PlcAddress
    from fatektool.errors import (
        DataError,
        FatektoolError,
        LineError,
        LineReadOnly,
        NoAnswer,
        PlcError,
        PlcRefused,
        PortBusy,
        RestoreIncomplete,
        UsageError,
    )
    from fatektool.jobs.command_words import parse_command
    from fatektool.jobs.programs.backup import backup
    from fatektool.jobs.programs.restore import RestoreOptions, RestorePlan, RestoreResult, restore
    from fatektool.jobs.programs.verify import verify
    from fatektool.jobs.status import StatusReport, read_status
    from fatektool.library import Plc, connect
    from fatektool.program.archive import Backup, load_backup, save_backup
    from fatektool.program.compare import Comparison, compare
    from fatektool.program.headers.header import Header
    from fatektool.program.image import Program
    from fatektool.project.program_file import ProgramFile, load_program
    from fatektool.protocol.elements import Element
    from fatektool.protocol.frames import checksum, error_text, frame
    from fatektool.served import SimulatedTarget, simulate

_HOMES = {
    "address": ["PlcAddress"],
    "errors": [
        "DataError",
        "FatektoolError",
        "LineError",
        "LineReadOnly",
        "NoAnswer",
        "PlcError",
        "PlcRefused",
        "PortBusy",
        "RestoreIncomplete",
        "UsageError",
    ],
    "jobs.command_words": ["parse_command"],
    "jobs.programs.backup": ["backup"],
    "jobs.programs.restore": ["RestoreOptions", "RestorePlan", "RestoreResult", "restore"],
    "jobs.programs.verify": ["verify"],
    "jobs.status": ["StatusReport", "read_status"],
    "library": ["Plc", "connect"],
    "program.archive": ["Backup", "load_backup", "save_backup"],
    "program.compare": ["Comparison", "compare"],
    "program.headers.header": ["Header"],
    "program.image": ["Program"],
    "project.program_file": ["ProgramFile", "load_program"],
    "protocol.elements": ["Element"],
    "protocol.frames": ["checksum", "error_text", "frame"],
    "served": ["SimulatedTarget", "simulate"],
}
_HOME_OF = {name: f"fatektool.{home}" for home, names in _HOMES.items() for name in names}

__all__ = [
    "Backup",
    "Comparison",
    "DataError",
    "Element",
    "FatektoolError",
    "Header",
    "LineError",
    "LineReadOnly",
    "NoAnswer",
    "Plc",
    "PlcAddress",
    "PlcError",
    "PlcRefused",
    "PortBusy",
    "Program",
    "ProgramFile",
    "RestoreIncomplete",
    "RestoreOptions",
    "RestorePlan",
    "RestoreResult",
    "SimulatedTarget",
    "StatusReport",
    "UsageError",
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
    "simulate",
    "verify",
]


def __getattr__(name: str) -> Any:
    """Load a public name from its home when it is first asked for."""
    if name not in _HOME_OF:
        raise AttributeError(f"module {__name__!r} has no attribute {name!r}")
    value = getattr(importlib.import_module(_HOME_OF[name]), name)
    globals()[name] = value
    return value


def __dir__() -> list[str]:
    return list(__all__)
