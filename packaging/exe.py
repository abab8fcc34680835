"""Build ``fatektool.exe``, one file without a Python: python packaging/exe.py [FOLDER].

For a Python of Windows that has fatektool and PyInstaller. PyInstaller does not see modules that are imported
by name, so all of them are named.
"""

from __future__ import annotations

import sys
import tempfile
from pathlib import Path

ROOT = Path(__file__).parent.parent
ENTRY = "from fatektool.cli import main\nmain()\n"
BY_NAME = ("fatektool", "pymodbus", "serial", "dulwich")
LEFT_OUT = ("dulwich.tests", "tkinter", "pytest", "hypothesis", "numpy", "PIL", "IPython", "matplotlib")


def main(folder: str = "dist") -> None:
    """Build it."""
    import PyInstaller.__main__

    with tempfile.TemporaryDirectory(ignore_cleanup_errors=True) as work:
        entry = Path(work) / "entry.py"
        entry.write_text(ENTRY, encoding="utf-8")
        words = ["--onefile", "--console", "--noconfirm", "--log-level", "INFO", "--name", "fatektool"]
        words += ["--distpath", folder, "--workpath", f"{work}/build", "--specpath", work]
        words += ["--paths", str(ROOT), "--add-data", f"{ROOT / 'fatektool' / 'schemas'}:fatektool/schemas"]
        for name in BY_NAME:
            words += ["--collect-submodules", name]
        for name in LEFT_OUT:
            words += ["--exclude-module", name]
        PyInstaller.__main__.run([*words, str(entry)])
    print(Path(folder) / "fatektool.exe")


if __name__ == "__main__":
    main(*sys.argv[1:])
