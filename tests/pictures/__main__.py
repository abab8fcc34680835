"""Makes the pictures anew: ``python -m tests.pictures``."""

from __future__ import annotations

import contextlib
import io
import os
import shutil
import sys
import tempfile
from pathlib import Path

from tests.pictures.scenes import SCREENS, fingerprint, report
from tests.report.browser import Browser
from tests.root import DOCS

with tempfile.TemporaryDirectory() as name:
    folder = Path(name)
    os.environ |= {"FATEKTOOL_LOCK_DIR": name, "FATEKTOOL_STATE_DIR": str(folder / "state"), "TERM": "xterm"}
    for scene, draw in SCREENS.items():
        place = folder / scene
        place.mkdir()
        os.chdir(place)
        (DOCS / "pictures" / f"{scene}.svg").write_text(draw(place).svg, encoding="utf-8")
    place = folder / "report"
    place.mkdir()
    os.chdir(place)
    with contextlib.redirect_stdout(io.StringIO()):
        html = report(place)
    (place / "shown.html").write_text(html, encoding="utf-8")
    chromium = shutil.which("chromium") or sys.exit(
        "chromium is not installed: needed for docs/pictures/report.png"
    )
    (folder / "home").mkdir()
    with Browser(chromium, folder / "home") as browser:
        page = browser.page()
        page.show(width=900)
        page.open(place / "shown.html")
        (DOCS / "pictures" / "report.png").write_bytes(page.picture(whole=False))
    (DOCS / "pictures" / "report.sha256").write_text(fingerprint(html) + "\n", encoding="utf-8")
