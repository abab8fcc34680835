"""Read a history with dulwich. The hash of each object is checked, and errors are in the project's words.

::

    HEAD -> refs/heads/main -> commit -> tree -> {NAME.json: blob}
                                 └─ parent -> tree …

A branch that cannot be read is an error here, and never "no commit yet": a commit without its parent would
cut off the history. dulwich's ``read_ref`` returns None in both cases.
"""

from __future__ import annotations

import hashlib
import re
from contextlib import contextmanager
from dataclasses import dataclass, replace
from functools import cached_property
from traceback import clear_frames
from typing import TYPE_CHECKING, Final

from dulwich.objects import ObjectID, object_header, parse_tree
from dulwich.refs import Ref
from dulwich.repo import Repo

from fatektool.errors import DataError, FatektoolError, UsageError
from fatektool.files.atomic import file_error
from fatektool.history.commits import Commit, parse_commit
from fatektool.history.loose import read_loose
from fatektool.history.sharing import Rights, rights_of
from fatektool.system.shell import command_line

if TYPE_CHECKING:
    from collections.abc import Iterator, Sequence
    from pathlib import Path
    from typing import Self

    from fatektool.history.trees import Item

_HASH_BYTES: Final = 20
_SHA: Final = re.compile(rb"[0-9a-f]{40}")
_BRANCH: Final = re.compile(rb"ref: (refs/heads/[^\0\s]+)\s*")


@dataclass(frozen=True, slots=True)
class Newest:
    """The newest commit of a history.

    Attributes:
        tip: its hash; None before the first commit.
        items: the items of its tree: the files of all PLCs.
    """

    tip: str | None
    items: Sequence[Item]


class Repository:
    """A history on disk, open for reading.

    Args:
        folder: the bare repository.

    Raises:
        UsageError: the folder does not exist or cannot be read.
        DataError: it is not a bare git repository of version 0.
    """

    def __init__(self, folder: Path) -> None:
        self.folder = folder
        self._newest: Newest | None = None
        if not folder.is_dir():
            raise UsageError(
                f"there is no history {folder}",
                hint="'fatektool history record' creates it",
                file=str(folder),
            )
        if (folder / ".git").exists():
            clone = command_line(["git", "clone", "--bare", str(folder), "OTHER"])
            raise DataError(
                f"{folder} has a work tree: expected a bare repository",
                hint=f"use another folder, or create one: {clone}",
                file=str(folder),
            )
        with self.guard("the repository"):
            if not is_repository(folder):
                raise DataError(
                    f"{folder} is not a git repository",
                    hint="give the folder of the history",
                    file=str(folder),
                )
            self.git = Repo(str(folder), bare=True)
        try:
            self.rights = self._require_format()
        except BaseException:
            self.git.close()
            raise

    def __enter__(self) -> Self:
        return self

    def __exit__(self, *_: object) -> None:
        self.close()

    def close(self) -> None:
        """Close its files."""
        self.git.close()

    def _require_format(self) -> Rights:
        with self.guard("config"):
            rights = rights_of(self.folder)
            try:
                form = self.git.get_config().get((b"core",), b"repositoryformatversion")
            except KeyError:
                form = b"0"
        if form != b"0":
            raise DataError(
                f"{self.folder} is a git repository of another format: expected version 0, got {form!r}",
                hint="use another folder",
                file=str(self.folder),
            )
        return rights

    @contextmanager
    def guard(self, what: str) -> Iterator[None]:
        """Turn every error into one of the project's.

        Args:
            what: what is read, for the message.

        Raises:
            DataError: dulwich cannot read it.
            UsageError: a file cannot be read or written.
        """
        try:
            yield
        except FatektoolError:
            raise
        except OSError as error:
            raise file_error("use", self.folder, error) from error
        except Exception as error:  # dulwich raises any error for damaged bytes: KeyError, AssertionError, …
            reason = " ".join(f"{type(error).__name__} {error}".split())[:200]
            release(error)
            raise self.damaged(f"{what} cannot be read ({reason})") from error

    def damaged(self, what: str) -> DataError:
        """The error for damage in this repository."""
        return DataError(
            f"{self.folder}: {what}",
            hint="run 'fatektool history check' and 'git fsck'; a clone or the pushed copy may be undamaged",
            file=str(self.folder),
        )

    def branch(self) -> str:
        """The branch that HEAD names, in full: ``refs/heads/main``.

        Raises:
            DataError: HEAD does not name a branch.
        """
        with self.guard("HEAD"):
            found = _BRANCH.fullmatch((self.folder / "HEAD").read_bytes())
            if found is None or b".." in found[1]:
                raise self.damaged("HEAD: expected 'ref: refs/heads/BRANCH'")
            return found[1].decode()

    def tip(self) -> str | None:
        """The hash of the newest commit; None before the first.

        Raises:
            DataError: the branch cannot be read.
        """
        branch = self.branch()
        with self.guard(branch):
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
        """Read an object and check its hash.

        Args:
            sha: 40 hex digits.
            kind: ``commit``, ``tree`` or ``blob``.

        Raises:
            DataError: it is missing, damaged or of another kind.
        """
        got, data = self.any_object(sha)
        if got != kind:
            raise self.damaged(f"{sha}: expected a {kind}, got a {got}")
        return data

    def any_object(self, sha: str) -> tuple[str, bytes]:
        """Read an object of any kind: its kind and its bytes.

        Raises:
            DataError: it is missing or damaged.
        """
        loose = read_loose(self.folder, sha)
        if loose is not None:
            return loose
        with self.guard(f"object {sha}"):
            try:
                number, data = self.git.object_store.get_raw(ObjectID(sha.encode()))
            except KeyError:
                raise self.damaged(f"object {sha} is missing") from None
            head = object_header(number, len(data))
        kind = head.partition(b" ")[0].decode()
        if hashlib.sha1(head + data, usedforsecurity=False).hexdigest() != sha:
            raise self.damaged(f"{kind} {sha} is damaged: its bytes do not match its hash")
        return kind, data

    @cached_property
    def cut(self) -> frozenset[str]:
        """The commits at which a shallow clone ends: older ones are missing. Empty if it is not shallow.

        Raises:
            DataError: git's list of them cannot be read.
        """
        with self.guard("shallow"):
            return frozenset(sha.decode() for sha in self.git.get_shallow())

    def commit(self, sha: str) -> Commit:
        """Read a commit. One at which a shallow clone ends has no parents.

        Raises:
            DataError: it is missing or damaged.
        """
        data = self.read(sha, "commit")
        with self.guard(f"commit {sha}"):
            found = parse_commit(sha, data)
        return replace(found, parents=()) if sha in self.cut else found

    def items(self, tree: str) -> list[Item]:
        """The items of a tree, in its order.

        Raises:
            DataError: the tree is missing or damaged.
        """
        data = self.read(tree, "tree")
        with self.guard(f"tree {tree}"):
            return list(parse_tree(data, _HASH_BYTES))

    def newest(self) -> Newest:
        """The newest commit; read again only if the branch names another one.

        Raises:
            DataError: the branch, its commit or its tree is damaged.
        """
        tip = self.tip()
        if self._newest is None or self._newest.tip != tip:
            self._newest = Newest(tip, [] if tip is None else self.items(self.commit(tip).tree))
        return self._newest

    def is_now(self, newest: Newest) -> None:
        """Set the newest commit after a write, so that it need not be read."""
        self._newest = newest

    def chain(self, start: str | None) -> Iterator[Commit]:
        """A commit and its ancestors, newest first; of a merge, the first parent.

        Raises:
            DataError: one of them is missing or damaged.
        """
        while start is not None:
            found = self.commit(start)
            yield found
            start = found.parents[0] if found.parents else None


def release(error: BaseException | None) -> None:
    """Release the frames of an error: a pack or a socket in them could not be closed."""
    while error is not None:
        clear_frames(error.__traceback__)
        error.__traceback__ = None
        error = error.__cause__ or error.__context__


def is_repository(folder: Path) -> bool:
    """True for a bare git repository. HEAD is the last file that is written of a new one."""
    return (folder / "HEAD").is_file() and (folder / "objects").is_dir() and (folder / "refs").is_dir()
