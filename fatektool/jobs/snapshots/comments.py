"""The comments of an engineer's project beside the elements of a snapshot."""

from __future__ import annotations

from dataclasses import replace
from typing import TYPE_CHECKING

if TYPE_CHECKING:
    from collections.abc import Mapping

    from fatektool.jobs.snapshots.snapshot import Snapshot


def snapshot_with_comments(snapshot: Snapshot, comments: Mapping[str, str]) -> Snapshot:
    """The same snapshot, each element with its comment where there is one.

    Args:
        snapshot: what was read.
        comments: element -> comment, of a project.
    """
    if not comments:
        return snapshot
    from fatektool.project.comments import comment_of

    elements = {}
    for key, part in snapshot.elements.items():
        comment = comment_of(part["element"], comments)
        elements[key] = part if comment is None else {**part, "comment": comment}
    return replace(snapshot, elements=elements)
