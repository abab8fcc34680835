"""The JSON documents of ``schema`` and ``simulate``."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

if TYPE_CHECKING:
    from collections.abc import Iterable


def schemas_document(names: Iterable[str]) -> dict[str, Any]:
    """``fatektool.schemas/1``: the names of all documents."""
    return {"schema": "fatektool.schemas/1", "names": list(names)}


def simulate_document(addresses: Iterable[str]) -> dict[str, Any]:
    """``fatektool.simulate/1``: where simulated PLCs can be reached."""
    return {"schema": "fatektool.simulate/1", "listening": list(addresses)}
