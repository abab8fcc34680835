from __future__ import annotations

from tests.jobs.elements.conftest import plant

__all__ = ["plant"]
