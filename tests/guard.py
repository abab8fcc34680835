"""How long a test may wait for what comes: no measure, only an end to what would wait for ever."""

from __future__ import annotations

GUARD_S = 600.0
