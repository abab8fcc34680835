"""A folder with fatektool and all that it needs, for any Python from 3.11 on and any system.

Only wheels without machine code are taken: one bundle serves Linux, macOS and Windows on every processor.
"""

from __future__ import annotations

import os
import shutil
import subprocess
import sys
import tomllib
from importlib.util import find_spec
from pathlib import Path

ROOT = Path(__file__).parent.parent
OLDEST = "3.11"
ELSEWHERE = ("colorama", "typing_extensions")
"""What the dependencies need on Windows and on the oldest Python: pip reads the markers of this system."""


def make_bundle(folder: Path) -> None:
    """Install into a folder, which is made.

    Args:
        folder: where; must be empty or absent.

    Raises:
        SystemExit: pip is missing or failed, or a package brought machine code.
    """
    if find_spec("pip") is None:
        sys.exit("this Python has no pip: install it (Debian: apt install python3-pip), or use another")
    project = tomllib.loads((ROOT / "pyproject.toml").read_text(encoding="utf-8"))["project"]
    pure = ["--only-binary", ":all:", "--platform", "any", "--implementation", "py", "--abi", "none"]
    wanted = [*project["dependencies"], *ELSEWHERE]
    _install(folder, "--python-version", OLDEST, *pure, *wanted)
    shutil.rmtree(folder / "bin")  # commands of the packages
    _install(folder, "--no-deps", str(ROOT))
    for name in ["bin", *(path.relative_to(folder) for path in folder.rglob("__pycache__"))]:
        shutil.rmtree(folder / name)
    native = [path.name for path in folder.rglob("*") if path.suffix in {".so", ".pyd", ".dylib"}]
    if native:
        sys.exit(f"machine code in the bundle: {', '.join(native)}")


def _install(folder: Path, *words: str) -> None:
    pip = [sys.executable, "-m", "pip", "-q", "--disable-pip-version-check", "install", "--target", folder]
    environment = os.environ | {"PIP_ROOT_USER_ACTION": "ignore"}
    if subprocess.run([*pip, *words], env=environment, check=False).returncode:
        sys.exit("pip failed: see above. A package index must be reachable from here")


def version() -> str:
    """The version of the project."""
    found: dict[str, str] = {}
    exec((ROOT / "fatektool" / "version.py").read_text(encoding="utf-8"), found)  # noqa: S102  # its own file
    return found["__version__"]
