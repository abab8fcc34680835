"""A commit as the rest of the history sees it: plain values, and text that no terminal obeys."""

from __future__ import annotations

from dataclasses import dataclass

from dulwich.objects import Commit as GitCommit


@dataclass(frozen=True, slots=True)
class Commit:
    """One change of the history.

    Attributes:
        revision: its hash, 40 hex digits.
        tree: hash of its tree.
        parents: hashes of those before it, the first the one it was made from.
        time: when it was recorded, seconds since 1970.
        author: who it was made for: ``press-3 <station-1@host>``.
        message: subject, empty line, body; characters that no terminal should get are replaced.
    """

    revision: str
    tree: str
    parents: tuple[str, ...]
    time: int
    author: str
    message: str

    @property
    def subject(self) -> str:
        """The message's first line."""
        return self.message.partition("\n")[0]


def parse_commit(sha: str, data: bytes) -> Commit:
    """A commit from its bytes; dulwich's errors for what is none.

    Args:
        sha: its hash, 40 hex digits.
        data: its bytes.
    """
    found = GitCommit.from_string(data)
    return Commit(
        sha,
        found.tree.decode(),
        tuple(parent.decode() for parent in found.parents),
        int(found.commit_time),
        printable(found.author.decode(errors="replace")),
        printable(found.message.decode(errors="replace")),
    )


def printable(text: str) -> str:
    """The text without what could steer a terminal: other characters stand as ``?``, lines stay lines."""
    if text.replace("\n", "").isprintable():
        return text
    return "".join(char if char.isprintable() or char == "\n" else "?" for char in text)
