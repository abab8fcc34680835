"""A parsed project file: decrypted memories, decoded texts."""

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
    """A project of the vendor's software.

    Attributes:
        model: of the PLC, in the file's first bytes; None if there is none.
        memory: the memory of the PLC in it.
        comments: its texts.
        file_sha256: hash of the file's bytes.
    """

    model: str | None
    memory: Memory
    comments: Comments
    file_sha256: str

    @cached_property
    def sha256(self) -> str:
        """Hash of the image; it does not depend on the key and the comments."""
        return hashlib.sha256(self.memory.image).hexdigest()

    @classmethod
    def parse(cls, data: bytes, name: str = "project", encoding: str | None = None) -> Project:
        """Parse the bytes of a project file.

        Args:
            data: the bytes.
            name: the file's name, for messages.
            encoding: the code page of its texts; None to detect it.

        Raises:
            DataError: not a project, incomplete or damaged, or it cannot be decrypted.
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
