"""Does a program fit a PLC? Its ladder size, its pages and its family must; the rest is worth a warning."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

from fatektool.errors import DataError
from fatektool.program.headers.header import FBS, SWAPPED
from fatektool.program.plc_record import model_words

if TYPE_CHECKING:
    from collections.abc import Mapping

    from fatektool.program.headers.header import Header
    from fatektool.program.image import Program

_HINT = "restore a backup of this PLC, or of one of the same model"


def require_size(wanted: Program, words: int) -> None:
    """Refuse a program of another ladder size.

    Raises:
        DataError: it has another.
    """
    if words != wanted.ladder_words:
        raise DataError(
            f"the program does not fit this PLC: expected a ladder size of {words} words, "
            f"got {wanted.ladder_words} in the file",
            hint=_HINT,
            plc_ladder_words=words,
            file_ladder_words=wanted.ladder_words,
        )


def require_kin(wanted: Program, present: Program, *, any_header: bool) -> None:
    """Refuse a program with more pages than this PLC has, or of another family of PLC.

    Args:
        wanted: the program on file.
        present: the program in the PLC.
        any_header: take one of the same family with other letters or another byte order.

    Raises:
        DataError: it must not be written into this PLC.
    """
    ours, theirs = len(wanted.pages), len(present.pages)
    if ours > theirs:
        raise DataError(
            f"the program does not fit this PLC: expected at most {theirs} pages, got {ours} in the file",
            hint=_HINT,
            plc_page_count=theirs,
            file_page_count=ours,
        )
    file, plc = wanted.header, present.header
    if file.family is None or plc.family is None or _kind(file) == _kind(plc):
        return
    if any_header and file.family == plc.family:
        return
    raise DataError(
        f"the program is of another family of PLC: expected {_kind(plc)} as in the PLC, "
        f"got {_kind(file)} in the file",
        hint=_HINT if file.family != plc.family else f"{_HINT}; or --any-header, if it is meant",
        plc_signature=plc.signature,
        file_signature=file.signature,
    )


def model_warning(file: Mapping[str, Any], plc: Mapping[str, Any]) -> str | None:
    """What to say if a program was read from another unit type, number of points or OS than it goes to.

    Args:
        file: the record of the PLC that it was read from, ``system``.
        plc: the same of this one.
    """
    keys = ("unit_type", "main_unit_points", "os_version")
    if all(file[key] == plc[key] for key in keys):
        return None
    return (
        f"the program was read from another model, {model_words(file)}, and goes into {model_words(plc)}: "
        f"inputs, outputs and instructions may differ"
    )


def _kind(header: Header) -> str:
    """The letters of the signature and the order of the bytes: ``FB``, ``FBS4, bytes swapped``."""
    letters = "FBS4" if header.family == FBS else (header.signature or "")[:2]
    return f"{letters}, bytes swapped" if header.byte_order == SWAPPED else letters
