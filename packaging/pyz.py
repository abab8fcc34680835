"""Build ``fatektool.pyz``, one file for any Python from 3.11 on: python3 packaging/pyz.py [FILE]."""

from __future__ import annotations

import sys
import tempfile
import zipapp
from pathlib import Path

from bundle import make_bundle


def main(file: str = "dist/fatektool.pyz") -> None:
    """Build it."""
    target = Path(file)
    target.parent.mkdir(parents=True, exist_ok=True)
    with tempfile.TemporaryDirectory() as work:
        folder = Path(work) / "bundle"
        make_bundle(folder)
        zipapp.create_archive(
            folder, target, interpreter="/usr/bin/env python3", main="fatektool.cli:main", compressed=True
        )
    print(target)


if __name__ == "__main__":
    main(*sys.argv[1:])
