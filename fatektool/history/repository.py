"""Reading a history: the one door to dulwich, behind which every object is what its hash says.

::

    HEAD -> refs/heads/main -> commit -> tree -> {NAME.json: blob}
                                 └─ parent -> tree …

A reference that cannot be read is an error here, never "there is none yet": a commit without its parent
would cut the whole history off.
"""

from __future__ import annotations

import hashlib
import re
from contextlib import contextmanager
from dataclasses import dataclass
from traceback import clear_frames
from typing import TYPE_CHECKING, Final

from dulwich.objects import Commit as GitCommit
from dulwich.objects import ObjectID, Tree
from dulwich.refs import Ref
from dulwich.repo import Repo

from fatektool.errors import DataError, FatektoolError, UsageError
from fatektool.history.names import name_of
from fatektool.program.files import file_error

if TYPE_CHECKING:
    from collections.abc import Iterator
    from pathlib import Path
    from typing import Self

_KINDS: Final = {1: "commit", 2: "tree", 3: "blob", 4: "tag"}
_SHA: Final = re.compile(rb"[0-9a-f]{40}")
_BRANCH: Final = re.compile(rb"ref: (refs/heads/[^\0\s]+)\s*")
_PLAIN_FILES: Final = {0o100644, 0o100755, 0o100664}


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


class Repository:
    """A history on disk, open for reading.

    Args:
        folder: the bare repository.

    Raises:
        UsageError: there is no such folder, or it may not be read.
        DataError: it is no repository that holds a history.
    """

    def __init__(self, folder: Path) -> None:
        self.folder = folder
        if not folder.is_dir():
            raise UsageError(
                f"there is no history {folder}",
                hint="the first 'fatektool history record' makes it",
                file=str(folder),
            )
        if (folder / ".git").exists():
            raise DataError(
                f"{folder} has a work tree: expected a bare repository",
                hint=f"name another folder, or make one with 'git clone --bare {folder} OTHER'",
                file=str(folder),
            )
        with self.door("the repository"):
            if not is_repository(folder):
                raise DataError(
                    f"{folder} is no git repository", hint="name the history's folder", file=str(folder)
                )
            self.git = Repo(str(folder), bare=True)
        try:
            self._require_format()
        except BaseException:
            self.git.close()
            raise

    def __enter__(self) -> Self:
        return self

    def __exit__(self, *_: object) -> None:
        self.git.close()

    def _require_format(self) -> None:
        with self.door("config"):
            try:
                form = self.git.get_config().get((b"core",), b"repositoryformatversion")
            except KeyError:
                form = b"0"
        if form != b"0":
            raise DataError(
                f"{self.folder} is a git repository of another format: expected version 0, got {form!r}",
                hint="name another folder",
                file=str(self.folder),
            )

    @contextmanager
    def door(self, what: str) -> Iterator[None]:
        """Let errors out in the project's words only.

        Raises:
            DataError: what dulwich finds damaged.
            UsageError: a file may not be read or written.
        """
        try:
            yield
        except FatektoolError:
            raise
        except OSError as error:
            raise file_error("use", self.folder, error) from error
        except (
            Exception
        ) as error:  # damaged bytes come out of dulwich as anything: KeyError, AssertionError, …
            reason = " ".join(f"{type(error).__name__} {error}".split())[:200]
            _let_go(error)
            raise self.damaged(f"{what} cannot be read ({reason})") from error

    def damaged(self, what: str) -> DataError:
        """The error for something in here that does not hold."""
        return DataError(
            f"{self.folder}: {what}",
            hint="see 'fatektool history check' and 'git fsck'; a clone or the pushed copy may be whole",
            file=str(self.folder),
        )

    def branch(self) -> str:
        """The branch that HEAD names, in full: ``refs/heads/main``.

        Raises:
            DataError: HEAD names none.
        """
        with self.door("HEAD"):
            found = _BRANCH.fullmatch((self.folder / "HEAD").read_bytes())
            if found is None or b".." in found[1]:
                raise self.damaged("HEAD: expected 'ref: refs/heads/BRANCH'")
            return found[1].decode()

    def tip(self) -> str | None:
        """The newest commit's hash; None before the first.

        Raises:
            DataError: the branch does not hold.
        """
        branch = self.branch()
        with self.door(branch):
            try:
                sha = (self.folder / branch).read_bytes().strip()
            except (FileNotFoundError, IsADirectoryError):
                packed = self.git.refs.get_packed_refs().get(Ref(branch.encode()))
                if packed is None:
                    return None
                sha = bytes(packed)
        if not _SHA.fullmatch(sha):
            raise self.damaged(f"{branch}: expected 40 hex digits, got {sha[:50]!r}")
        return sha.decode()

    def read(self, sha: str, kind: str) -> bytes:
        """An object's bytes, proven by its hash.

        Args:
            sha: 40 hex digits.
            kind: ``commit``, ``tree`` or ``blob``.

        Raises:
            DataError: it is not there, of another kind, or damaged.
        """
        got, data = self.any_object(sha)
        if got != kind:
            raise self.damaged(f"{sha}: expected a {kind}, got a {got}")
        return data

    def any_object(self, sha: str) -> tuple[str, bytes]:
        """The same for an object of any kind, which is told with it.

        Raises:
            DataError: it is not there, or damaged.
        """
        with self.door(f"object {sha}"):
            try:
                number, data = self.git.object_store.get_raw(ObjectID(sha.encode()))
            except KeyError:
                raise self.damaged(f"object {sha} is missing") from None
            kind = _KINDS[number]
        header = f"{kind} {len(data)}\0".encode()
        if hashlib.sha1(header + data, usedforsecurity=False).hexdigest() != sha:
            raise self.damaged(f"{kind} {sha} is damaged: its bytes have another hash")
        return kind, data

    def commit(self, sha: str) -> Commit:
        """A commit.

        Raises:
            DataError: it does not hold.
        """
        data = self.read(sha, "commit")
        with self.door(f"commit {sha}"):
            found = GitCommit.from_string(data)
            return Commit(
                sha,
                found.tree.decode(),
                tuple(parent.decode() for parent in found.parents),
                int(found.commit_time),
                printable(found.author.decode(errors="replace")),
                printable(found.message.decode(errors="replace")),
            )

    def tree(self, sha: str) -> Tree:
        """A tree, as dulwich has it.

        Raises:
            DataError: it does not hold.
        """
        data = self.read(sha, "tree")
        with self.door(f"tree {sha}"):
            tree = Tree.from_string(data)
            tree.items()  # read now, while the door stands open
            return tree

    def files(self, tree: str) -> dict[str, str]:
        """The PLCs' files in a tree: name and blob. What else somebody put there is left out.

        Raises:
            DataError: the tree does not hold.
        """
        entries = ((name_of(path), mode, sha) for path, mode, sha in self.tree(tree).items())
        return {
            name: sha.decode() for name, mode, sha in entries if name is not None and mode in _PLAIN_FILES
        }

    def chain(self, start: str | None) -> Iterator[Commit]:
        """A commit and those it was made from, newest first; of a merge, the side it was made on.

        Raises:
            DataError: one does not hold.
        """
        while start is not None:
            found = self.commit(start)
            yield found
            start = found.parents[0] if found.parents else None


def printable(text: str) -> str:
    """The text without what could steer a terminal: other characters stand as ``?``, lines stay lines."""
    return "".join(char if char.isprintable() or char == "\n" else "?" for char in text)


def _let_go(error: BaseException | None) -> None:
    """Drop the frames that an error holds: views of a pack in them would keep it from being closed."""
    while error is not None:
        clear_frames(error.__traceback__)
        error.__traceback__ = None
        error = error.__cause__ or error.__context__


def is_repository(folder: Path) -> bool:
    """True for a bare git repository: HEAD is the last that is made of one."""
    return (folder / "HEAD").is_file() and (folder / "objects").is_dir() and (folder / "refs").is_dir()
