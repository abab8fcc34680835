"""Test modules compiled once: pytest rewrites their assertions, which takes longer than to import them.

With two processes each would do all of it. So the second one begins with the last module: where they meet,
each finds what the other has compiled. Where Python is told to write no compiled files, they go into a folder
of this run alone, for the processes that the tests start, too.
"""

from __future__ import annotations

import atexit
import contextlib
import importlib
import os
import shutil
import sys
import tempfile
from typing import TYPE_CHECKING

from tests.root import ROOT

if TYPE_CHECKING:
    import pytest


def keep_compiled() -> None:
    """Have compiled files written, beside their sources or in a folder that goes with this process."""
    if not sys.dont_write_bytecode:
        return
    folder = tempfile.mkdtemp(prefix="fatektool-compiled-")
    atexit.register(shutil.rmtree, folder, ignore_errors=True)
    sys.dont_write_bytecode, sys.pycache_prefix = False, folder
    os.environ.pop("PYTHONDONTWRITEBYTECODE", None)
    os.environ["PYTHONPYCACHEPREFIX"] = folder


def import_from_the_end(config: pytest.Config) -> None:
    """In the second of the processes that collect all tests: import them, the last one first."""
    if os.environ.get("PYTEST_XDIST_WORKER") != "gw1" or config.args != config.getini("testpaths"):
        return
    for path in sorted((ROOT / "tests").rglob("test_*.py"), reverse=True):
        with contextlib.suppress(BaseException):  # pytest imports it again, and tells
            importlib.import_module(".".join(path.relative_to(ROOT).with_suffix("").parts))
