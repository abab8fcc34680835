"""The progress of a job."""

from __future__ import annotations

from collections.abc import Callable

Progress = Callable[[str, int, int], None]
"""Called with a phase in words, the pages or elements done and those in all; of several passes all count."""
