"""Build ``fatektool.exe``, one file without a Python: python packaging/exe.py [FOLDER [SCRIPT ...]].

For a Python of Windows with ``pip install .[exe]``. With SCRIPTs, ``fatektool-try.exe`` is built, too: of the
same parts, but it runs the SCRIPTs.
"""

from __future__ import annotations

import sys
import tempfile
from pathlib import Path

ROOT = Path(__file__).resolve().parent.parent
ENTRY = "from fatektool.cli import main\nmain()\n"
LEFT_OUT = ("markdown_it", "pygments", "setuptools", "tkinter")
"""What dependencies can use, and fatektool does not."""
SPEC = """
parts = Analysis(
    [*{scripts!r}, {entry!r}],
    pathex=[{root!r}],
    datas=[({schemas!r}, "fatektool/schemas")],
    hiddenimports={modules!r},
    excludes={left_out!r},
)
pure = PYZ(parts.pure)
for name, without in (("fatektool", {tries!r}), ("fatektool-try", ["entry"])):
    if name == "fatektool" or {tries!r}:
        scripts = [script for script in parts.scripts if script[0] not in without]
        EXE(pure, scripts, parts.binaries, parts.datas, name=name, console=True, upx=False)
"""


def by_name() -> list[str]:
    """The modules that are imported by name: commands of fatektool, URLs of pyserial."""
    import serial

    serial_folder = Path(serial.__file__).parent
    own, urls = (ROOT / "fatektool").rglob("*.py"), (serial_folder / "urlhandler").glob("*.py")
    found = [path.relative_to(ROOT) for path in own] + [
        path.relative_to(serial_folder.parent) for path in urls
    ]
    return sorted(".".join(path.with_suffix("").parts).removesuffix(".__init__") for path in found)


def main(folder: str = "dist", *scripts: str) -> None:
    """Build it."""
    import PyInstaller.__main__

    with tempfile.TemporaryDirectory(ignore_cleanup_errors=True) as work:
        entry, spec = Path(work) / "entry.py", Path(work) / "fatektool.spec"
        entry.write_text(ENTRY, encoding="utf-8")
        text = SPEC.format(
            scripts=[str(Path(script).resolve()) for script in scripts],
            tries=[Path(script).stem for script in scripts],
            entry=str(entry),
            root=str(ROOT),
            schemas=str(ROOT / "fatektool" / "schemas"),
            modules=by_name(),
            left_out=LEFT_OUT,
        )
        spec.write_text(text, encoding="utf-8")
        folders = ["--distpath", folder, "--workpath", f"{work}/build"]
        PyInstaller.__main__.run(["--noconfirm", "--log-level", "WARN", *folders, str(spec)])
    print(Path(folder) / "fatektool.exe")


if __name__ == "__main__":
    main(*sys.argv[1:])
