"""Build ``fatektool.pyz``, one file for any Python from 3.11 on: python3 packaging/pyz.py [FILE]."""

from __future__ import annotations

import sys
import tempfile
import zipapp
from pathlib import Path

from bundle import make_bundle

MAIN = """\
import sys

if sys.version_info < (3, 11):
    sys.stderr.write(
        "fatektool: this is Python %d.%d, expected 3.11 or later; start it with a later one, such as "
        "python3.12 fatektool.pyz (Windows: py -3.12 fatektool.pyz)\\n" % sys.version_info[:2]
    )
    sys.exit(2)

from fatektool.cli import main

main()
"""
"""What is run first; each Python since 2.7 understands it."""


def main(file: str = "dist/fatektool.pyz") -> None:
    """Build it."""
    target = Path(file)
    target.parent.mkdir(parents=True, exist_ok=True)
    with tempfile.TemporaryDirectory() as work:
        folder = Path(work) / "bundle"
        make_bundle(folder)
        (folder / "__main__.py").write_text(MAIN, encoding="utf-8")
        zipapp.create_archive(folder, target, interpreter="/usr/bin/env python3", compressed=True)
    target.chmod(0o755)  # for all users of the computer
    print(target)


if __name__ == "__main__":
    main(*sys.argv[1:])
