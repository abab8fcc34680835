"""The pictures of the documents show what the commands print; python -m tests.pictures makes them anew."""

from __future__ import annotations

import re
from html import unescape
from typing import TYPE_CHECKING

import pytest

from tests.pictures.scenes import SCREENS, fingerprint, report
from tests.root import DOCS, ROOT

if TYPE_CHECKING:
    from pathlib import Path

PICTURES = DOCS / "pictures"


@pytest.fixture(autouse=True)
def place(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> Path:
    monkeypatch.setenv("FATEKTOOL_LOCK_DIR", str(tmp_path))
    monkeypatch.setenv("TERM", "xterm")
    for name in ("FATEKTOOL_PORT", "COLUMNS", "LINES", "NO_COLOR", "FORCE_COLOR"):
        monkeypatch.delenv(name, raising=False)
    monkeypatch.chdir(tmp_path)
    return tmp_path


def words_of(svg: str) -> list[str]:
    """The lines of text in a picture, without their spaces."""
    rows = re.findall(r"<text [^>]*>(.*?)</text>", svg)
    return ["".join(unescape(re.sub(r"<[^>]+>", "", row)).split()) for row in rows]


@pytest.mark.parametrize("name", SCREENS)
def test_a_screen(place: Path, name: str) -> None:
    shown = (PICTURES / f"{name}.svg").read_text(encoding="utf-8")
    assert words_of(shown) == ["".join(line.split()) for line in SCREENS[name](place).lines]


def test_a_report(place: Path) -> None:
    """The screenshot is of this page."""
    shown = (PICTURES / "report.sha256").read_text(encoding="utf-8").strip()
    assert shown == fingerprint(report(place))


def test_each_picture_is_in_a_document() -> None:
    pages = "".join(path.read_text(encoding="utf-8") for path in [ROOT / "README.md", *DOCS.glob("*.md")])
    for path in PICTURES.glob("*.*g"):
        assert f"pictures/{path.name})" in pages, path.name
