from __future__ import annotations

from tests.cli.conftest import cli, place
from tests.cli.line.link.conftest import fb, fbs

__all__ = ["cli", "fb", "fbs", "place"]
