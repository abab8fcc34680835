"""Tests of many rows of one shape, each of which takes less time than pytest needs to count it."""

from __future__ import annotations

import functools
import inspect
from typing import TYPE_CHECKING, Any, Final

import pytest

if TYPE_CHECKING:
    from collections.abc import Callable, Iterable

_MOST_SHOWN: Final = 5


def each(
    names: str | tuple[str, ...], rows: Iterable[Any], ids: Callable[[Any], object] = repr
) -> Callable[[Callable[..., None]], Callable[..., None]]:
    """As ``pytest.mark.parametrize``, in one test: for rows that need no fixture of their own.

    All rows are tried. The test fails with the number of those that failed and the errors of the first, each
    with its row.

    Args:
        names: of the arguments that a row gives; one name for rows that are no tuples.
        rows: the rows.
        ids: names a row.
    """
    tried = list(rows)
    assert tried

    def decorate(test: Callable[..., None]) -> Callable[..., None]:
        given = [names] if isinstance(names, str) else list(names)

        @functools.wraps(test)
        def all_rows(**fixtures: Any) -> None:
            failed: list[BaseException] = []
            for row in tried:
                try:
                    test(
                        **fixtures, **dict(zip(given, [row] if isinstance(names, str) else row, strict=True))
                    )
                except (Exception, pytest.fail.Exception) as error:  # noqa: BLE001  # raised again below
                    error.add_note(f"in the row {ids(row)!s:.300}")
                    failed.append(error)
            if failed:
                message = f"{len(failed)} of {len(tried)} rows of {test.__name__} failed"
                raise BaseExceptionGroup(message, failed[:_MOST_SHOWN])

        signature = inspect.signature(test)
        others = [each for each in signature.parameters.values() if each.name not in given]
        all_rows.__signature__ = signature.replace(parameters=others)  # type: ignore[attr-defined]
        return all_rows

    return decorate
