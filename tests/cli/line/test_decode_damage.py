"""A damaged trace: what stands before the damage is shown, then what is wrong."""

from __future__ import annotations

import json
from typing import TYPE_CHECKING

from fatektool import cli

if TYPE_CHECKING:
    from pathlib import Path

    import pytest


def damaged(folder: Path) -> str:
    path = folder / "line.ndjson"
    good = {"time": "2026-11-22T03:15:00.000000Z", "direction": "tx", "hex": "0230313430433703"}
    path.write_text(json.dumps(good) + "\ngarbage\n", encoding="utf-8")
    return str(path)


def test_the_good_records_are_shown(tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    assert cli.run(["decode", damaged(tmp_path)]) == 5
    out, err = capsys.readouterr()
    assert "read brief status" in out
    assert "line 2" in err


def test_with_json_there_is_one_document(tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    assert cli.run(["decode", damaged(tmp_path), "--json"]) == 5
    assert json.loads(capsys.readouterr().out)["schema"] == "fatektool.error/1"
