"""A commit as plain values, with text that is safe to print on a terminal."""

from __future__ import annotations

from dataclasses import dataclass

from dulwich.objects import Commit as GitCommit


@dataclass(frozen=True, slots=True)
class Commit:
    """One change of the history.

    Attributes:
        revision: its hash, 40 hex digits.
        tree: hash of its tree.
        parents: hashes of its parents; the first is the commit that it was made from.
        time: when it was recorded, seconds since 1970.
        author: the PLC: ``press-3 <station-1@host>``.
        message: subject, empty line, body; characters that are not printable are replaced.
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
    """Parse the bytes of a commit; dulwich's errors if they are not valid.

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
    """Replace characters that a terminal could obey with ``?``; line ends are kept."""
    if text.replace("\n", "").isprintable():
        return text
    return "".join(char if char.isprintable() or char == "\n" else "?" for char in text)
