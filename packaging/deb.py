"""Build a Debian package, ``fatektool_VERSION_all.deb``: python3 packaging/deb.py [FOLDER].

All that fatektool needs is in it, so that a gateway without internet can take it: ``dpkg -i`` asks for Python
alone. Manual pages and the completions of bash, zsh and fish are in their places, the documentation in
``/usr/share/doc/fatektool``.
"""

from __future__ import annotations

import gzip
import os
import shutil
import subprocess
import sys
import tempfile
from email.utils import formatdate
from pathlib import Path

from bundle import ROOT, make_bundle, version

LIBRARY = "usr/lib/fatektool"
COMPLETIONS = {
    "bash": "usr/share/bash-completion/completions/fatektool",
    "zsh": "usr/share/zsh/vendor-completions/_fatektool",
    "fish": "usr/share/fish/vendor_completions.d/fatektool.fish",
}
CONTROL = """\
Package: fatektool
Version: {version}
Architecture: all
Maintainer: fatektool <fatektool@localhost.localdomain>
Installed-Size: {size}
Depends: python3 (>= 3.11)
Section: utils
Priority: optional
Description: back up, verify and restore programs of FATEK and FACON PLCs
 A command for the programs, registers and lines of FATEK/FACON PLCs: FB, FBE,
 FBN, FBs and M-series. It backs up, verifies and restores ladder programs,
 reads and writes elements, and diagnoses lines.
"""
CHANGES = """\
fatektool ({version}) unstable; urgency=medium

  * See CHANGELOG.md.gz.

 -- fatektool <fatektool@localhost.localdomain>  {date}
"""
COMMAND = """\
#!/usr/bin/python3 -sP
import sys
sys.path.insert(0, "/usr/lib/fatektool")
from fatektool.cli import main
main()
"""
AFTER = f'#!/bin/sh\nset -e\n[ "$1" != configure ] || python3 -m compileall -q /{LIBRARY}\n'
BEFORE_REMOVAL = f"#!/bin/sh\nset -e\nfind /{LIBRARY} -name __pycache__ -type d -prune -exec rm -rf {{}} +\n"


def main(folder: str = "dist") -> None:
    """Build it."""
    if shutil.which("dpkg-deb") is None:
        sys.exit("dpkg-deb is missing: build the package on Debian or Ubuntu")
    target = Path(folder)
    target.mkdir(parents=True, exist_ok=True)
    with tempfile.TemporaryDirectory() as work:
        root = Path(work) / "root"
        root.mkdir()
        root.chmod(0o755)
        make_bundle(root / LIBRARY)
        _add(root, "usr/bin/fatektool", COMMAND, 0o755)
        for shell, place in COMPLETIONS.items():
            _add(root, place, _python(root, "-m", "fatektool", "completion", shell))
        pages = root / "usr/share/man/man1"
        _python(root, ROOT / "packaging" / "man.py", pages)
        for page in pages.iterdir():
            _packed(page.with_suffix(".1.gz"), page.read_bytes())
            page.unlink()
        documents = root / "usr/share/doc/fatektool"
        documents.mkdir(parents=True)
        shutil.copy(ROOT / "LICENSE", documents / "copyright")
        shutil.copy(ROOT / "README.md", documents)
        shutil.copytree(ROOT / "docs", documents / "docs")
        _packed(documents / "CHANGELOG.md.gz", (ROOT / "CHANGELOG.md").read_bytes())
        _packed(documents / "changelog.gz", CHANGES.format(version=version(), date=formatdate()).encode())
        shutil.copytree(
            ROOT / "examples", documents / "examples", ignore=shutil.ignore_patterns("__pycache__")
        )
        size = sum(path.stat().st_size for path in root.rglob("*") if path.is_file()) // 1024
        _add(root, "DEBIAN/control", CONTROL.format(version=version(), size=size))
        _add(root, "DEBIAN/postinst", AFTER, 0o755)
        _add(root, "DEBIAN/prerm", BEFORE_REMOVAL, 0o755)
        subprocess.run(["chmod", "-R", "u=rwX,go=rX", root], check=True)
        file = target / f"fatektool_{version()}_all.deb"
        subprocess.run(
            ["dpkg-deb", "--root-owner-group", "--build", root, file], check=True, stdout=subprocess.DEVNULL
        )
    print(file)


def _add(root: Path, place: str, text: str, mode: int = 0o644) -> None:
    path = root / place
    path.parent.mkdir(parents=True, exist_ok=True)
    path.write_text(text, encoding="utf-8")
    path.chmod(mode)


def _packed(path: Path, data: bytes) -> None:
    path.write_bytes(gzip.compress(data, mtime=0))


def _python(root: Path, *words: str | Path) -> str:
    """The output of Python with the packages that are in the package."""
    environment = os.environ | {"PYTHONPATH": str(root / LIBRARY), "PYTHONDONTWRITEBYTECODE": "1"}
    command = [sys.executable, "-P", *words]
    return subprocess.run(command, check=True, stdout=subprocess.PIPE, text=True, env=environment).stdout


if __name__ == "__main__":
    main(*sys.argv[1:])
