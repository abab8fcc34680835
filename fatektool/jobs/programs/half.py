"""Is the program in a PLC half of a restore, as the record of one that did not complete leads to expect?

The record alone does not prove it: another PLC may be connected to that port by now, or its program may have
been loaded in another way.
"""

from __future__ import annotations

from pathlib import Path
from typing import TYPE_CHECKING

from fatektool.callbacks import ignore
from fatektool.errors import FatektoolError
from fatektool.jobs.programs.reading import read_program
from fatektool.jobs.programs.safety import is_between
from fatektool.program.archive import load_backup

if TYPE_CHECKING:
    from fatektool.client import Plc
    from fatektool.jobs.progress import Progress
    from fatektool.jobs.write_back.record import Unfinished


def is_half(plc: Plc, record: Unfinished, progress: Progress = ignore) -> bool:
    """True if the PLC has pages of the file that was restored, and pages of the program before it.

    False if the program is one of the two, or another one, and if that is not known: the files are gone, or
    the PLC does not give its program.

    Args:
        plc: the PLC.
        record: of a restore that did not complete.
        progress: called for each page.
    """
    if record.file is None or record.safety_backup is None:
        return False
    try:
        wanted = load_backup(Path(record.file)).program
        before = load_backup(Path(record.safety_backup)).program
        present = read_program(plc, progress=progress).program
    except FatektoolError as error:
        plc.link.note(f"whether the program is half of {record.file} is not known: {error.message}")
        return False
    if len(present.pages) > len(wanted.pages):
        return False
    return present not in {wanted, before} and is_between(present, before, wanted)
