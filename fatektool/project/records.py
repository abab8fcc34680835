"""A project file's frame: 256 bytes, then records to the end.

::

    000  Fatek WinProladder, File Format 1        0A0  model
    080  FB-PLC        090  WinProladder
    100  record: type u16 · length u16 · bytes · two bytes more, but for type 180A
     ..  the last: FFFF · 0

Numbers have their low byte first. In the types 1001 to 1004 and 1006 the two bytes are the sum of the
record's bytes, modulo 65536; in others they hold something else. If no record can begin where the next one
should, but one can two bytes before or behind, it is that one.
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
"""No project is near it: the memories take 66 kB, comments as much again."""
_MODEL: Final = slice(0xA0, 0x100)
_END: Final = 0xFFFF
_MOST_RECORDS: Final = 200_000
_SUMMED: Final = frozenset({0x1001, 0x1002, 0x1003, 0x1006})
"""Those of them that are read: what nobody reads may be as it is."""
_BARE: Final = 0x180A


@dataclass(frozen=True, slots=True)
class Record:
    """One record.

    Attributes:
        type: what it holds.
        place: where it begins in the file.
        data: its bytes, without the two behind them.
    """

    type: int
    place: int
    data: bytes


def is_project(data: bytes) -> bool:
    """True if a file begins as a project of the vendor's program does."""
    return data.startswith(SIGNATURE[:18])


def model(data: bytes) -> str | None:
    """The model that the file's first 256 bytes name; None if they name none."""
    text = data[_MODEL].partition(b"\0")[0].rstrip(b"\xff ")
    return text.decode("ascii") if text and all(0x20 <= byte < 0x7F for byte in text) else None


def records(data: bytes) -> Iterator[Record]:
    """Take a project file apart.

    Raises:
        DataError: it is none, it is cut short, or a sum does not hold.
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
    raise DataError(f"more than {_MOST_RECORDS} records: that is no project", hint="is it the right file?")


def _tail(data: bytes, kind: int, end: int) -> int:
    """How many bytes follow a record's own: what its type has, unless only the other makes sense."""
    usual = 0 if kind == _BARE else 2
    only_the_other = not _is_record(data, end + usual) and _is_record(data, end + 2 - usual)
    return 2 - usual if only_the_other else usual


def _is_record(data: bytes, place: int) -> bool:
    """True if a record can begin here: a type of a known kind, in the file with all its bytes."""
    if place + 4 > len(data):
        return False
    kind, length = _u16(data, place), _u16(data, place + 2)
    if kind == _END:
        return length == 0
    return kind >> 8 in {0x10, 0x18} and place + 4 + length <= len(data)


def _check_sum(record: Record, head: bytes, stored: int) -> None:
    """Refuse a record whose sum does not hold. Whether its type and length count is taken either way."""
    if record.type not in _SUMMED:
        return
    computed = sum(record.data) & 0xFFFF
    if stored not in {computed, (computed + sum(head)) & 0xFFFF}:
        raise DataError(
            f"record {record.type:04X} at byte {record.place}: expected the sum {stored:04X}, "
            f"got {computed:04X}",
            hint="the file is damaged: take it again from where it came from",
        )


def _cut(what: str) -> DataError:
    return DataError(f"the project file is cut short: {what}", hint="take it again from where it came from")


def _u16(data: bytes, place: int) -> int:
    return int.from_bytes(data[place : place + 2], "little")
