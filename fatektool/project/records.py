"""The records of a project file: 256 bytes, then records to the end.

::

    000  Fatek WinProladder, File Format 1        0A0  model
    080  FB-PLC        090  WinProladder
    100  record: type u16 · length u16 · bytes · two more bytes, except type 180A
     ..  the last: FFFF · 0

Numbers have their low byte first. In the types 1001 to 1004 and 1006 the two bytes are the sum of the
record's bytes, modulo 65536; in others they have another meaning. If no record can begin at the expected
place, but one can two bytes before or after, that one is used.
"""

from __future__ import annotations

from dataclasses import dataclass
from typing import TYPE_CHECKING, Final

from fatektool.errors import DataError

if TYPE_CHECKING:
    from collections.abc import Iterator

SIGNATURE: Final = b"Fatek WinProladder, File Format 1"
HEAD_BYTES: Final = 256
LARGEST_FILE: Final = 8 << 20
"""Far above any project: the memories have 66 kB, comments about the same."""
_MODEL: Final = slice(0xA0, 0x100)
_END: Final = 0xFFFF
_MOST_RECORDS: Final = 200_000
_SUMMED: Final = frozenset({0x1001, 0x1002, 0x1003, 0x1006})
"""The types that are read; others are not checked."""
_BARE: Final = 0x180A


@dataclass(frozen=True, slots=True)
class Record:
    """One record.

    Attributes:
        type: of its contents.
        place: its offset in the file.
        data: its bytes, without the two after them.
    """

    type: int
    place: int
    data: bytes


def is_project(data: bytes) -> bool:
    """True if a file has the signature of a project of the vendor's software."""
    return data.startswith(SIGNATURE[:18])


def model(data: bytes) -> str | None:
    """The model in the file's first 256 bytes; None if there is none."""
    text = data[_MODEL].partition(b"\0")[0].rstrip(b"\xff ")
    return text.decode("ascii") if text and all(0x20 <= byte < 0x7F for byte in text) else None


def records(data: bytes) -> Iterator[Record]:
    """Parse a project file.

    Raises:
        DataError: not a project, incomplete, or a wrong sum.
    """
    if not data.startswith(SIGNATURE):
        got = data[: len(SIGNATURE)].decode("latin-1")
        raise DataError(
            f"not a WinProladder project: expected {SIGNATURE.decode()!r} at its start, got {got!r}"
        )
    place = HEAD_BYTES
    for _ in range(_MOST_RECORDS):
        if place + 4 > len(data):
            raise _cut(f"the end record (FFFF) is missing at byte {place}")
        kind, length = _u16(data, place), _u16(data, place + 2)
        if kind == _END:
            return
        end = place + 4 + length
        if end > len(data):
            raise _cut(
                f"record {kind:04X} at byte {place} has {length} bytes, the file {len(data) - place - 4}"
            )
        record = Record(kind, place, data[place + 4 : end])
        yield record
        more = _tail(data, kind, end)
        if more:
            _check_sum(record, data[place : place + 4], _u16(data, end))
        place = end + more
    raise DataError(f"not a project: more than {_MOST_RECORDS} records", hint="check the name of the file")


def _tail(data: bytes, kind: int, end: int) -> int:
    """The number of bytes after a record: as usual for its type, unless only the other value is possible."""
    usual = 0 if kind == _BARE else 2
    only_the_other = not _is_record(data, end + usual) and _is_record(data, end + 2 - usual)
    return 2 - usual if only_the_other else usual


def _is_record(data: bytes, place: int) -> bool:
    """True if a record can begin here: of a known type, with all its bytes in the file."""
    if place + 4 > len(data):
        return False
    kind, length = _u16(data, place), _u16(data, place + 2)
    if kind == _END:
        return length == 0
    return kind >> 8 in {0x10, 0x18} and place + 4 + length <= len(data)


def _check_sum(record: Record, head: bytes, stored: int) -> None:
    """Refuse a record with a wrong sum; the sum may include its type and length or not."""
    if record.type not in _SUMMED:
        return
    computed = sum(record.data) & 0xFFFF
    if stored not in {computed, (computed + sum(head)) & 0xFFFF}:
        raise DataError(
            f"record {record.type:04X} at byte {record.place}: expected the sum {stored:04X}, "
            f"got {computed:04X}",
            hint="the file is damaged: get it again from its source",
        )


def _cut(what: str) -> DataError:
    return DataError(f"the project file is incomplete: {what}", hint="get it again from its source")


def _u16(data: bytes, place: int) -> int:
    return int.from_bytes(data[place : place + 2], "little")
