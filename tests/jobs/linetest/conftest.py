from __future__ import annotations

from tests.cli.conftest import cli, place

__all__ = ["cli", "place"]
