from __future__ import annotations

from tests.cli.conftest import cli, place
from tests.jobs.elements.conftest import plant

__all__ = ["cli", "place", "plant"]
