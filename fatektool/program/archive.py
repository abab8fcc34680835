"""The backup file, ``fatektool.backup/1``: JSON with one page on each line, so that ``git diff`` shows pages.

Keys in this order::

    schema created tool source{target station protocol line} plc{status system}
    header{valid family signature byte_order ladder_words code_words capacity_words
           checksum{stored computed valid} sums{settings labels ror}}
    ladder_words page_count passes proof{known_from pages_known pages_read_twice}
    sha256 pages[256 hex digits, …] data{…}

``data`` is there if the PLC's data were saved too: see ``fatektool.program.data.part``. A version from before
there were data ignores it, and takes the program alone.

Keys that are not known are ignored: another program, or a later version, may write more. Older files have no
``proof``, or only ``valid``, ``signature`` and ``ladder_words`` in ``header``.
``sha256`` is of all pages' bytes in order. A backup file is always checked completely: an invalid file is
refused, with what is wrong and where, before anything is done with it.
"""

from __future__ import annotations

import re
from dataclasses import dataclass, replace
from pathlib import Path
from typing import TYPE_CHECKING, Any, Final

from fatektool.errors import DataError
from fatektool.files.atomic import read_bounded, write_whole
from fatektool.files.indented_json import indented_json
from fatektool.files.strict_json import read_json
from fatektool.files.times import is_utc
from fatektool.program.checked_document import CheckedDocument, short
from fatektool.program.headers.families import short_document
from fatektool.program.headers.header import PAGE_BYTES
from fatektool.program.image import Program, is_whole, page_count
from fatektool.program.plc_record import fault_of, known_keys

if TYPE_CHECKING:
    from fatektool.program.data.part import DataPart

SCHEMA: Final = "fatektool.backup/1"
LARGEST_FILE: Final = 4 << 20  # the largest image takes 270 kB
_RIGHT_FILE: Final = "check that it is the right file"
_PAGE: Final = re.compile(r"[0-9A-Fa-f]{256}", re.ASCII)
_PROJECT: Final = b"Fatek WinProladder"


@dataclass(frozen=True, slots=True)
class Source:
    """The PLC that a program was read from.

    Attributes:
        target: as the user wrote it.
        station: 1 to 254.
        protocol: ``facon``.
        line: port parameters, ``9600 7E1``; None if it has none.
    """

    target: str
    station: int
    protocol: str
    line: str | None


@dataclass(frozen=True, slots=True)
class Proof:
    """How the pages of a program were verified.

    Attributes:
        known_from: the file or revision whose pages they were compared with; None if there was none.
        pages_known: pages that were read once and are the same as in that file.
        pages_read_twice: pages that were read until two readings in a row were identical.
    """

    known_from: str | None
    pages_known: int
    pages_read_twice: int

    def document(self) -> dict[str, Any]:
        """For a backup file."""
        return {
            "known_from": self.known_from,
            "pages_known": self.pages_known,
            "pages_read_twice": self.pages_read_twice,
        }

    def text(self, passes: int) -> str:
        """As text.

        Args:
            passes: how many times the whole program was read.
        """
        if not self.pages_known:
            times = "twice" if passes <= 2 else f"{passes} times"
            return f"read {times}, identical" if self.pages_read_twice else "read once, not compared"
        again = f", {self.pages_read_twice} read twice" if self.pages_read_twice else ""
        return f"{self.pages_known} as in {self.known_from}{again}"


@dataclass(frozen=True, slots=True)
class Backup:
    """A program, with source and time.

    Attributes:
        program: the image.
        created: UTC, RFC 3339.
        tool: name and version of the program that wrote it.
        source: the PLC that it was read from.
        plc: the status document's ``status`` and ``system``.
        passes: how many times the whole program was read.
        proof: how its pages were verified; None in older files.
        data: the PLC's data; None if the program alone was saved.
    """

    program: Program
    created: str
    tool: str
    source: Source
    plc: dict[str, Any]
    passes: int
    proof: Proof | None = None
    data: DataPart | None = None

    @property
    def proof_words(self) -> str:
        """How the pages were verified, as text."""
        twice = len(self.program.pages) if self.passes > 1 else 0
        return (self.proof or Proof(None, 0, twice)).text(self.passes)

    @property
    def header_document(self) -> dict[str, Any]:
        """The header for the file."""
        return self.program.header.document()

    def to_bytes(self) -> bytes:
        """The file's bytes."""
        program = self.program
        head = {
            "schema": SCHEMA,
            "created": self.created,
            "tool": self.tool,
            "source": {
                "target": self.source.target,
                "station": self.source.station,
                "protocol": self.source.protocol,
                "line": self.source.line,
            },
            "plc": self.plc,
            "header": self.header_document,
            "ladder_words": program.ladder_words,
            "page_count": len(program.pages),
            "passes": self.passes,
            **({} if self.proof is None else {"proof": self.proof.document()}),
            "sha256": program.sha256,
        }
        text = indented_json(head, 1).removesuffix("\n}")
        pages = ",\n".join(f'  "{page.hex().upper()}"' for page in program.pages)
        data = "" if self.data is None else f',\n "data": {_indented(self.data.document())}'
        return f'{text},\n "pages": [\n{pages}\n ]{data}\n}}\n'.encode()

    @classmethod
    def parse(cls, data: bytes, name: str = "backup") -> Backup:
        """Parse and check the bytes of a backup file.

        Args:
            data: the bytes.
            name: the file's name, for messages.

        Raises:
            DataError: anything is invalid.
        """
        try:
            return _Reader(name).backup(_json(data, name))
        except DataError as error:
            error.details.setdefault("file", name)
            raise


def save_backup(backup: Backup, path: Path | str, *, overwrite: bool = False) -> None:
    """Write a backup file, completely or not at all.

    Raises:
        UsageError: it exists and ``overwrite`` is False, or the folder cannot be written.
        DataError: the disk is full or damaged.
    """
    write_whole(Path(path), backup.to_bytes(), overwrite=overwrite)


def load_backup(path: Path | str) -> Backup:
    """Read and check a backup file.

    Raises:
        UsageError: there is no such file.
        DataError: it is damaged, or not a backup file.
    """
    return Backup.parse(read_bounded(Path(path), LARGEST_FILE), str(path))


def _json(data: bytes, name: str) -> dict[str, Any]:
    if data.startswith(_PROJECT):
        raise DataError(
            f"{name}: a WinProladder project, expected a backup of a PLC",
            hint="inspect, listing, xref, diff and verify also read projects",
        )
    try:
        document = read_json(data)
    except ValueError as error:  # UnicodeDecodeError and JSONDecodeError among them
        raise DataError(
            f"{name}: not a backup file: {error}", hint="check that it is the right file"
        ) from error
    if not isinstance(document, dict) or document.get("schema") != SCHEMA:
        got = short(document.get("schema") if isinstance(document, dict) else document)
        raise DataError(
            f"{name}: not a backup file of this version: expected schema {SCHEMA!r}, got {got}",
            hint=_RIGHT_FILE,
        )
    return document


def _indented(document: dict[str, Any]) -> str:
    return indented_json(document, 1).replace("\n", "\n ")


class _Reader(CheckedDocument):
    """Parses a document; raises the first fault."""

    def backup(self, document: dict[str, Any]) -> Backup:
        ladder_words = self.number(document, "ladder_words", 1, 0xFFFF)
        program = Program(ladder_words, self.pages(document, ladder_words))
        found = Backup(
            program=program,
            created=self.text(document, "created"),
            tool=self.text(document, "tool"),
            source=self.source(self.part(document, "source")),
            plc=self.part(document, "plc"),
            passes=self.number(document, "passes", 1, 1000),
            proof=self.proof(document, len(program.pages)),
        )
        self.same("sha256", program.sha256, self.text(document, "sha256").lower())
        header = self.part(document, "header")
        whole = "family" in header
        computed = found.header_document if whole else short_document(program.pages[0], ladder_words)
        for key, value in computed.items():
            self.same(f"header.{key} (page 0)", value, header.get(key))
        if not is_utc(found.created):
            raise self.fault("created: expected a UTC time such as 2026-11-22T03:15:00Z", found.created)
        fault = fault_of(found.plc)
        if fault is not None:
            raise self.fault(*fault)
        found = replace(found, plc=known_keys(found.plc))
        system = found.plc["system"]
        self.same("plc.system.ladder_words", ladder_words, system["ladder_words"])
        if "data" not in document:
            return found
        from fatektool.program.data.reader import read_part

        return replace(found, data=read_part(self, self.part(document, "data"), system))

    def pages(self, document: dict[str, Any], ladder_words: int) -> tuple[bytes, ...]:
        pages = document.get("pages")
        if not isinstance(pages, list):
            raise self.fault("pages: expected an array", pages)
        for number, page in enumerate(pages):
            if not isinstance(page, str) or not _PAGE.fullmatch(page):
                error = self.fault(f"page {number}: expected {2 * PAGE_BYTES} hex digits", page)
                error.details["page"] = number
                raise error
        found = tuple(bytes.fromhex(page) for page in pages)
        if not is_whole(found, ladder_words):
            expected = page_count(ladder_words)
            raise self.fault(f"pages: expected {expected} for {ladder_words} words", len(pages))
        self.same("page_count", len(pages), document.get("page_count"))
        return found

    def proof(self, document: dict[str, Any], count: int) -> Proof | None:
        if "proof" not in document:
            return None
        part = self.part(document, "proof")
        known_from = part.get("known_from")
        if known_from is not None and not isinstance(known_from, str):
            raise self.fault("proof.known_from: expected a text or null", known_from)
        known = self.number(part, "pages_known", 0, count, "proof.")
        return Proof(known_from, known, self.number(part, "pages_read_twice", 0, count - known, "proof."))

    def source(self, part: dict[str, Any]) -> Source:
        line = part.get("line")
        if line is not None and not isinstance(line, str):
            raise self.fault("source.line: expected a text or null", line)
        return Source(
            self.text(part, "target", "source."),
            self.number(part, "station", 1, 254, "source."),
            self.text(part, "protocol", "source."),
            line,
        )
