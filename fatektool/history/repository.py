"""Reading a history: the one door to dulwich, behind which every object is what its hash says.

::

    HEAD -> refs/heads/main -> commit -> tree -> {NAME.json: blob}
                                 └─ parent -> tree …

A reference that cannot be read is an error here, never "there is none yet": a commit without its parent
would cut the whole history off. dulwich's ``read_ref`` makes no difference between the two.
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
    """What a history holds now.

    Attributes:
        tip: the newest commit's hash; None before the first.
        items: what its tree names: every PLC's file.
    """

    tip: str | None
    items: Sequence[Item]


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
        self._newest: Newest | None = None
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
            self.rights = self._require_format()
        except BaseException:
            self.git.close()
            raise

    def __enter__(self) -> Self:
        return self

    def __exit__(self, *_: object) -> None:
        self.close()

    def close(self) -> None:
        """Let its files go."""
        self.git.close()

    def _require_format(self) -> Rights:
        with self.door("config"):
            rights = rights_of(self.folder)
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
        return rights

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
            let_go(error)
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
        loose = read_loose(self.folder, sha)
        if loose is not None:
            return loose
        with self.door(f"object {sha}"):
            try:
                number, data = self.git.object_store.get_raw(ObjectID(sha.encode()))
            except KeyError:
                raise self.damaged(f"object {sha} is missing") from None
            head = object_header(number, len(data))
        kind = head.partition(b" ")[0].decode()
        if hashlib.sha1(head + data, usedforsecurity=False).hexdigest() != sha:
            raise self.damaged(f"{kind} {sha} is damaged: its bytes have another hash")
        return kind, data

    @cached_property
    def cut(self) -> frozenset[str]:
        """The commits at which a shallow clone ends: those before them are not in it. Empty if it is none.

        Raises:
            DataError: git's list of them does not hold.
        """
        with self.door("shallow"):
            return frozenset(sha.decode() for sha in self.git.get_shallow())

    def commit(self, sha: str) -> Commit:
        """A commit; one at which a shallow clone ends has no parents.

        Raises:
            DataError: it does not hold.
        """
        data = self.read(sha, "commit")
        with self.door(f"commit {sha}"):
            found = parse_commit(sha, data)
        return replace(found, parents=()) if sha in self.cut else found

    def items(self, tree: str) -> list[Item]:
        """What a tree names, in its order.

        Raises:
            DataError: the tree is not there, of another kind, or damaged.
        """
        data = self.read(tree, "tree")
        with self.door(f"tree {tree}"):
            return list(parse_tree(data, _HASH_BYTES))

    def newest(self) -> Newest:
        """What the newest commit holds; read once as long as the branch names that commit.

        Raises:
            DataError: the branch, its commit or its tree does not hold.
        """
        tip = self.tip()
        if self._newest is None or self._newest.tip != tip:
            self._newest = Newest(tip, [] if tip is None else self.items(self.commit(tip).tree))
        return self._newest

    def is_now(self, newest: Newest) -> None:
        """Take for the newest what has just been written, so that it need not be read."""
        self._newest = newest

    def chain(self, start: str | None) -> Iterator[Commit]:
        """A commit and those it was made from, newest first; of a merge, the side it was made on.

        Raises:
            DataError: one does not hold.
        """
        while start is not None:
            found = self.commit(start)
            yield found
            start = found.parents[0] if found.parents else None


def let_go(error: BaseException | None) -> None:
    """Drop the frames that an error holds: a pack or a socket in them could not be closed."""
    while error is not None:
        clear_frames(error.__traceback__)
        error.__traceback__ = None
        error = error.__cause__ or error.__context__


def is_repository(folder: Path) -> bool:
    """True for a bare git repository: HEAD is the last that is made of one."""
    return (folder / "HEAD").is_file() and (folder / "objects").is_dir() and (folder / "refs").is_dir()
