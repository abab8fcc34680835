"""Find the commit of a revision.

::

    HEAD  HEAD~2          the newest commit; the second before it, of any PLC
    ~1                    the program of this PLC before its last change; ~2: the one before that
    a1b2c3d               a hash: four digits or more
    2026-11-22            the last commit on or before that day, UTC; 2026-11-22T03:15:00Z likewise
"""

from __future__ import annotations

import re
from datetime import UTC, datetime, timedelta
from itertools import islice
from typing import TYPE_CHECKING, Final

from fatektool.errors import UsageError
from fatektool.history.trees import file_in
from fatektool.system.shell import command_line, own_command_line

if TYPE_CHECKING:
    from collections.abc import Iterator

    from fatektool.history.commits import Commit
    from fatektool.history.repository import Repository

SHORT: Final = 10
_BACK: Final = re.compile(r"HEAD(?:~(\d{1,6}))?", re.ASCII)
_CHANGES_BACK: Final = re.compile(r"~(\d{1,6})", re.ASCII)
_HASH: Final = re.compile(r"[0-9a-f]{4,40}", re.ASCII | re.IGNORECASE)
_DAY: Final = re.compile(r"\d{4}-\d\d-\d\d", re.ASCII)
_TIME: Final = re.compile(r"\d{4}-\d\d-\d\dT\d\d:\d\d(:\d\d)?Z", re.ASCII)


def changes_of(name: str, repository: Repository, start: str | None) -> Iterator[tuple[Commit, str | None]]:
    """The commits that changed the file of one PLC, newest first, each with the blob of that file.

    The blob is None if the commit deleted the file.

    Raises:
        DataError: the history is damaged.
    """
    after: Commit | None = None
    seen: str | None = None
    for commit in repository.chain(start):
        if after is None or commit.tree != after.tree:
            blob = file_in(repository.items(commit.tree), name)
            if after is not None and blob != seen:
                yield after, seen
            seen = blob
        after = commit
    if after is not None and seen is not None:
        yield after, seen


def resolve(repository: Repository, name: str, revision: str) -> Commit:
    """The commit of a revision.

    Args:
        repository: the history.
        name: the PLC whose changes ``~N`` counts.
        revision: as the user gave it.

    Raises:
        UsageError: there is no such commit.
        DataError: the history is damaged.
    """
    chain = repository.chain(repository.tip())
    found: Commit | None
    if back := _BACK.fullmatch(revision):
        found = next(islice(chain, int(back[1] or 0), None), None)
    elif back := _CHANGES_BACK.fullmatch(revision):
        changes = changes_of(name, repository, repository.tip())
        found = next((commit for commit, _ in islice(changes, int(back[1]), None)), None)
    elif _DAY.fullmatch(revision) or _TIME.fullmatch(revision):
        last = _last_second(revision)
        found = next((commit for commit in chain if commit.time <= last), None)
    elif _HASH.fullmatch(revision):
        found = _by_hash(chain, revision.lower())
    else:
        raise UsageError(
            f"{revision!r} is not a revision: expected a hash such as a1b2c3d, HEAD~2, ~1, "
            f"or a date such as 2026-11-22"
        )
    if found is None:
        hint = f"to see all run: {own_command_line('history', 'log', name)}"
        if repository.cut:
            fetch = command_line(["git", "-C", str(repository.folder), "fetch", "--unshallow"])
            hint = f"older ones are missing, as it is a shallow clone; to fetch them run: {fetch}"
        raise UsageError(f"there is no revision {name}@{revision} in {repository.folder}", hint=hint)
    return found


def _by_hash(chain: Iterator[Commit], digits: str) -> Commit | None:
    found = [commit for commit in chain if commit.revision.startswith(digits)]
    if len(found) > 1:
        first = ", ".join(each.revision[:SHORT] for each in found[:5])
        raise UsageError(f"{len(found)} revisions begin with {digits}: {first}", hint="give more digits")
    return found[0] if found else None


def _last_second(text: str) -> int:
    try:
        began = datetime.fromisoformat(text).replace(tzinfo=UTC)
        return int((began + (timedelta(days=1, seconds=-1) if "T" not in text else timedelta())).timestamp())
    except (ValueError, OverflowError) as error:
        raise UsageError(f"{text} is not a valid date or time") from error
