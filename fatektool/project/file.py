"""A project file, read: its memories out of their cipher, its texts in their code page."""

from __future__ import annotations

import hashlib
from dataclasses import dataclass
from functools import cached_property
from typing import TYPE_CHECKING

from fatektool.errors import DataError
from fatektool.project.comments import comments_of
from fatektool.project.memory import memory_of
from fatektool.project.records import is_project, model, records

if TYPE_CHECKING:
    from fatektool.project.comments import Comments
    from fatektool.project.memory import Memory


@dataclass(frozen=True)
class Project:
    """A project of the vendor's program.

    Attributes:
        model: of the PLC, as the file's first bytes name it; None if they name none.
        memory: what it holds of the PLC's memory.
        comments: what the engineer wrote.
        file_sha256: hash of the file's bytes.
    """

    model: str | None
    memory: Memory
    comments: Comments
    file_sha256: str

    @cached_property
    def sha256(self) -> str:
        """Hash of the image, which is the same whatever the key and the comments are."""
        return hashlib.sha256(self.memory.image).hexdigest()

    @classmethod
    def parse(cls, data: bytes, name: str = "project", encoding: str | None = None) -> Project:
        """Read a project file's bytes.

        Args:
            data: the bytes.
            name: the file's name, for messages.
            encoding: the code page of its texts; None finds it out.

        Raises:
            DataError: it is no project, it is cut or damaged, or its cipher cannot be solved.
        """
        try:
            found = list(records(data))
            return cls(model(data), memory_of(found), comments_of(found, encoding), _sha256(data))
        except DataError as error:
            error.details.setdefault("file", name)
            raise DataError(f"{name}: {error.message}", hint=error.hint, **error.details) from error


def _sha256(data: bytes) -> str:
    return hashlib.sha256(data).hexdigest()


__all__ = ["Project", "is_project"]
