"""The progress of a job."""

from __future__ import annotations

from collections.abc import Callable

Progress = Callable[[str, int, int], None]
"""Called with a phase in words, the pages done and the pages in all."""
