"""The engineer's comments beside elements: ``read``, ``snapshot``, ``watch``, ``diff``, ``verify``."""

from __future__ import annotations

import json
from pathlib import Path
from typing import TYPE_CHECKING

import pytest

from fatektool.project.comments import comment_of, short_element
from tests.cli.running import check, served
from tests.project.files import IMAGE, MAIN, SUB, backup_file, program_of, project_file
from tests.project.images import image_of

if TYPE_CHECKING:
    from tests.cli.running import Cli

TEXTS = {
    "R8": b"PRESSURE",
    "M0": b"READY",
    "T5": b"OIL",
    "X0": "Błąd".encode("cp1250"),
    "R100": b"TEMPERATURE",
}


@pytest.fixture
def pdw(place: Path) -> Path:
    del place
    return project_file("press.pdw", IMAGE, elements=TEXTS)


def test_read(cli: Cli, pdw: Path) -> None:
    done = cli("read", "R7-R8", "DR8", "M0", "X0", "T5", "RT5", "--comments", pdw, "-p", "sim:")
    assert done.code == 0, done
    assert done.out.splitlines() == [
        "R7   0",
        "R8   0    PRESSURE",
        "DR8  0    PRESSURE",
        "M0   off  READY",
        "X0   off  Błąd",
        "T5   off  OIL",
        "RT5  0    OIL",
    ]
    document = cli("read", "R7-R8", "--comments", pdw, "-p", "sim:", "--json").document("read")
    assert document["elements"]["R8"]["comment"] == "PRESSURE"
    assert "comment" not in document["elements"]["R7"]
    assert "comment" not in cli("read", "R8", "-p", "sim:", "--json").out


def test_snapshot(cli: Cli, pdw: Path) -> None:
    done = cli("snapshot", "R7-R8", "--comments", pdw, "-p", "sim:", "-o", "x.json", "--json")
    assert done.document("snapshot")["elements"]["R8"]["comment"] == "PRESSURE"
    assert cli("snapshot", "diff", "x.json", "x.json").code == 0  # such a file is read again
    damaged = json.loads(Path("x.json").read_text("utf-8"))
    damaged["elements"]["R8"]["comment"] = 5
    Path("y.json").write_text(json.dumps(damaged), encoding="utf-8")
    assert cli("snapshot", "diff", "x.json", "y.json").code == 5


def test_watch(cli: Cli, pdw: Path) -> None:
    line = cli("watch", "R7-R8", "--count", "1", "--comments", pdw, "-p", "sim:").out
    document = json.loads(line)
    check(document, "watch")
    assert document["comments"] == {"R8": "PRESSURE"}


def test_the_project_of_the_inventory(cli: Cli, pdw: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setenv("FATEKTOOL_INVENTORY", "fatek.toml")
    Path("fatek.toml").write_text('[plc.press]\ntarget = "sim:press.state"\nproject = "press.pdw"\n')
    assert cli("read", "R8", "-p", "press").out == "R8  0  PRESSURE\n"
    assert cli("inventory", "list", "--json").document("inventory")["plcs"][0]["project"] == "press.pdw"
    assert cli("inventory", "check").code == 0
    pdw.write_bytes(pdw.read_bytes()[:5000])
    done = cli("read", "R8", "-p", "press")
    assert (done.code, done.out) == (0, "R8  0\n")
    assert "warning: no comments: press.pdw: the project file is incomplete" in done.err
    assert cli("read", "R8", "-p", "press", "--comments", pdw).code == 5
    checked = cli("inventory", "check")
    assert checked.code == 1
    assert "press: project: press.pdw" in checked.out


def test_a_backup_has_the_comments_of_the_plc_that_it_came_from(cli: Cli, pdw: Path) -> None:
    backup_file("press.json", IMAGE)  # from station 1 on /dev/ttyUSB0
    Path("fatek.toml").write_text('[plc.press]\ntarget = "/dev/ttyUSB0"\nproject = "press.pdw"\n')
    assert "ORG X0                        Błąd" in cli("listing", "press.json").out
    assert cli("xref", "press.json", "X0").out.startswith("X0  Błąd\n")
    assert "Błąd" not in cli("listing", "press.json", "--words").out
    Path("fatek.toml").write_text('[plc.press]\ntarget = "/dev/ttyUSB1"\nproject = "press.pdw"\n')
    assert cli("xref", "press.json", "X0").out.startswith("X0\n")
    Path("other.toml").write_text('[plc.press]\ntarget = "/dev/ttyUSB0"\nproject = "no.pdw"\n')
    done = cli("xref", "press.json", "X0", "--inventory", "other.toml")
    assert done.code == 0
    assert "warning: no comments: cannot read no.pdw" in done.err
    assert pdw.exists()


def test_diff_and_verify(cli: Cli, pdw: Path) -> None:
    other = image_of([*MAIN[:2], 0x0080, *MAIN[3:]], SUB)
    backup_file("other.json", other)
    backup_file("press.json", IMAGE)
    for words in (("other.json", pdw), ("other.json", "press.json", "--comments", pdw)):
        lines = cli("diff", *words).out.splitlines()
        assert lines[-5:] == [
            " ORG X0                         Błąd",
            " OR M0                          READY",
            "-AND X0                         Błąd",
            "+AND NOT X0                     Błąd",
            " OUT Y0",
        ]
        document = cli("diff", *words, "--json").document("diff")
        assert document["comments"] == {"M0": "READY", "X0": "Błąd"}
    with served(program_of(other)) as plc:
        for named in ((pdw,), ("press.json", "--comments", pdw)):
            done = cli("verify", *named, "-p", plc.target, "--json")
            assert done.document("verify")["comments"] == {"M0": "READY", "X0": "Błąd"}


def test_names() -> None:
    texts = {"R2": "a", "D7": "b", "T5": "c", "DR4": "d", "WM8": "e"}
    same = {"R2": "a", "DR2": "a", "DD7": "b", "D7": "b", "RT5": "c", "DRT5": "c", "DR4": "d", "DWM8": "e"}
    assert {name: comment_of(name, texts) for name in same} == same
    assert comment_of("R7", texts) is None
    assert short_element("R00012") == "R12"
    assert short_element(" x000 ") == "X0"
    assert {short_element(text) for text in ("Y", "", "12", "R1;")} == {None}
