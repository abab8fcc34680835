"""A file with a program: a backup, or a project of the vendor's software, as its bytes show."""

from __future__ import annotations

from dataclasses import dataclass
from functools import cached_property
from typing import TYPE_CHECKING, Any, Final

from fatektool.errors import DataError
from fatektool.files.atomic import read_bounded
from fatektool.ladder.image import code_of, fbe_code
from fatektool.program.archive import LARGEST_FILE as LARGEST_BACKUP
from fatektool.program.archive import Backup
from fatektool.program.headers.header import PAGE_BYTES, PAGE_WORDS
from fatektool.program.image import Program
from fatektool.project.comments import Comments
from fatektool.project.file import Project
from fatektool.project.memory import OTHER_AT
from fatektool.project.records import LARGEST_FILE as LARGEST_PROJECT
from fatektool.project.records import is_project

if TYPE_CHECKING:
    from collections.abc import Mapping
    from pathlib import Path

    from fatektool.ladder.networks import Code, Network
    from fatektool.program.headers.header import Header

NO_COMMENTS: Final = Comments("", "", {}, {}, {}, "ascii", sure=True)


@dataclass(frozen=True)
class ProgramFile:
    """A program from a file.

    Attributes:
        name: the file, as the user wrote it.
        program: the image in pages; for a project with the memory after it, if the file has it.
        backup: the backup; None for a project.
        project: the project; None for a backup.
    """

    name: str
    program: Program
    backup: Backup | None = None
    project: Project | None = None

    @classmethod
    def parse(cls, data: bytes, name: str, encoding: str | None = None) -> ProgramFile:
        """Parse the bytes of a file.

        Args:
            data: the bytes.
            name: the file's name, for messages.
            encoding: the code page of a project's comments; None to detect it.

        Raises:
            DataError: it is neither, or invalid.
        """
        if is_project(data):
            project = Project.parse(data, name, encoding)
            return cls(name, _program_of(project), project=project)
        backup = Backup.parse(data, name)
        return cls(name, backup.program, backup=backup)

    @property
    def kind(self) -> str:
        """``backup`` or ``project``."""
        return "backup" if self.project is None else "project"

    @property
    def header(self) -> Header:
        """The header of the image."""
        return self.program.header

    @property
    def header_document(self) -> dict[str, Any]:
        """The header for JSON. For an FBE project no header is known, so there is no ladder size."""
        document = self.header.document()
        return document if self.project is None or document["family"] else {**document, "ladder_words": None}

    @property
    def sha256(self) -> str:
        """Hash of the program: of all pages; for a project only the image."""
        return self.program.sha256 if self.project is None else self.project.sha256

    @property
    def page_count(self) -> int:
        """The number of pages of the program, without the memory after it in a project."""
        if self.project is None:
            return len(self.program.pages)
        return -(-len(self.project.memory.image) // PAGE_BYTES)

    @cached_property
    def code(self) -> Code | None:
        """The program as instructions; None if its code is not known or the header is invalid."""
        if self.project is not None and not self.project.memory.family.start:
            return fbe_code(self.project.memory.image)
        return code_of(self.program)

    @property
    def networks(self) -> tuple[Network, ...]:
        """The program's networks.

        Raises:
            DataError: it has no known code.
        """
        return self.require_code().networks

    @property
    def comments(self) -> Comments:
        """The texts of the project; empty for a backup, because a PLC has no known comments."""
        return NO_COMMENTS if self.project is None else self.project.comments

    @property
    def element_comments(self) -> Mapping[str, str]:
        """``S3`` -> its comment."""
        return self.comments.elements

    def require_code(self) -> Code:
        """The program as instructions.

        Raises:
            DataError: it has no known code.
        """
        if self.code is not None:
            return self.code
        header = self.header
        if header.faults:
            why = f"invalid header: {'; '.join(header.faults)}"
        else:
            why = f"the code of the family {header.family!r} ({header.signature}) is not known"
        raise DataError(
            f"{self.name}: no mnemonics: {why}",
            hint="'fatektool diff' and 'verify' compare such programs by pages",
            file=self.name,
        )


def load_program(path: Path | str, *, encoding: str | None = None) -> ProgramFile:
    """Read a program from a file: a backup, or a project of the vendor's software (``.pdw``).

    Args:
        path: the file; its bytes show which it is.
        encoding: the code page of a project's comments (``cp1250``); None to detect it.

    Raises:
        UsageError: there is no such file.
        DataError: it is neither, or invalid.
    """
    from pathlib import Path

    data = read_bounded(Path(path), max(LARGEST_BACKUP, LARGEST_PROJECT))
    return ProgramFile.parse(data, str(path), encoding)


def _program_of(project: Project) -> Program:
    """A project's memory as pages, the gap between image and other memory erased."""
    memory = project.memory
    data = memory.image
    if memory.other is not None and len(data) <= OTHER_AT:
        data = data.ljust(OTHER_AT, b"\xff") + memory.other
    data = data.ljust(-(-len(data) // PAGE_BYTES) * PAGE_BYTES, b"\xff")
    pages = tuple(data[place : place + PAGE_BYTES] for place in range(0, len(data), PAGE_BYTES))
    return Program((len(pages) - 1) * PAGE_WORDS, pages)
