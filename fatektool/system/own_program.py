"""How this program is started: the first words of a command line that a user copies from a message.

::

    fatektool                               it is installed, and its folder is in PATH
    /opt/tool/bin/fatektool                 it is installed elsewhere
    /usr/bin/python3 /srv/fatektool.pyz     one file, started by a Python
    /usr/bin/python3 -m fatektool           the package, without its command
"""

from __future__ import annotations

import os
import sys

NAME = "fatektool"


def own_words() -> list[str]:
    """The words that start this program in any folder; ``fatektool`` if they are not known."""
    started = sys.argv[0] if sys.argv else ""
    folder, name = os.path.split(started)
    if name == "__main__.py" and os.path.basename(folder) == NAME:  # noqa: PTH119  # pathlib is loaded later
        return [sys.executable, "-m", NAME]
    stem, suffix = os.path.splitext(name)  # noqa: PTH122
    if suffix.lower() == ".pyz":
        return [sys.executable, os.path.abspath(started)]  # noqa: PTH100
    if stem.lower() != NAME or _in_path(stem):
        return [NAME]
    return [os.path.abspath(started)]  # noqa: PTH100


def _in_path(stem: str) -> bool:
    """True if the shell finds a program of this name."""
    names = [f"{stem}.exe"] if os.name == "nt" else [stem]
    folders = os.environ.get("PATH", os.defpath).split(os.pathsep)
    return any(os.access(os.path.join(each, name), os.X_OK) for each in folders if each for name in names)  # noqa: PTH118
