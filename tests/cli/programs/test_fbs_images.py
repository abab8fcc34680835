"""FBs images on the command line: kept, shown, compared, put back, and what is said of them."""

from __future__ import annotations

import json
from typing import TYPE_CHECKING

import pytest

from fatektool.program.archive import load_backup
from fatektool.simulator.build import build_simulation

if TYPE_CHECKING:
    from pathlib import Path

    from tests.cli.running import Cli

ALL = "the PLC refused page 128 as past its end and gave 128 pages: all that the program's header announces"


@pytest.fixture
def plc(place: Path) -> Path:
    path = place / "b1.state"
    build_simulation(model="b1-14mc", state=path)
    return path


def spoiled(path: Path, page: int) -> None:
    """Change one byte of a PLC's program, as nobody who knows the checksum would."""
    top = json.loads(path.read_text())
    pages = top["plcs"][0]["pages"]
    pages[str(page)] = f"{int(pages[str(page)][:2], 16) ^ 1:02X}{pages[str(page)][2:]}"
    path.write_text(json.dumps(top))


def test_backup_inspect_verify(plc: Path, cli: Cli) -> None:
    done = cli("backup", "b1.json", "-p", f"sim:{plc}")
    assert (done.code, done.err) == (0, f"{ALL}\n")
    assert "program  FBS40110 (code 1587 of 7936 words), 8192 words, 128 pages\n" in done.out
    shown = cli("inspect", "b1.json")
    assert "header       FBS40110 (code 1587 of 7936 words)\n" in shown.out
    assert "checksum     8CA7, correct\n" in shown.out
    document = cli("inspect", "b1.json", "--json").document("inspect")
    assert document["warnings"] == [ALL]
    assert document["page_count"] == 128
    assert cli("verify", "b1.json", "-p", f"sim:{plc}").out.startswith("same: ")
    assert cli("backup", "b1.json", "-q", "-p", f"sim:{plc}", "--force").err == ""


def test_several_refused_pages(place: Path, cli: Cli) -> None:
    build_simulation(model="fbs-24mc", state=place / "fbs.state")
    done = cli("backup", "fbs.json", "-p", f"sim:{place / 'fbs.state'}", "--single-pass")
    assert done.err.startswith("the PLC refused pages 320-512 as past its end and gave 320 pages: all that")


def test_a_checksum_that_does_not_hold_is_a_warning_and_in_the_json(plc: Path, cli: Cli) -> None:
    spoiled(plc, 5)
    done = cli("backup", "b1.json", "-p", f"sim:{plc}", "--json")
    assert done.code == 0
    warning, refused = done.err.splitlines()
    assert warning == "warning: checksum of the code: expected 8CA7 as stored, got 8CA8"
    assert refused == ALL
    document = done.document("backup-result")
    assert document["header"]["valid"] is True
    assert document["header"]["checksum"] == {"stored": "8CA7", "computed": "8CA8", "valid": False}
    assert document["warnings"] == [warning.removeprefix("warning: "), ALL]
    shown = cli("inspect", "b1.json")
    assert "checksum     8CA7, WRONG: that of the code is 8CA8\n" in shown.out


def test_a_header_page_that_is_not_filled_with_ff_is_a_warning_and_in_the_json(place: Path, cli: Cli) -> None:
    program = list(build_simulation(ladder_words=400).plcs[1].pages)
    program[0] = program[0][:-1] + b"\0"
    build_simulation(ladder_words=400, program=program, state="odd")
    odd = "bytes 6 to 127 of page 0: expected FF throughout, as in the FACON paper"
    done = cli("backup", "odd.json", "-p", "sim:odd", "--json")
    assert (done.code, done.err) == (0, f"warning: {odd}\n")
    assert done.document("backup-result")["warnings"] == [odd]
    assert cli("inspect", "odd.json", "--json").document("inspect")["warnings"] == [odd]
    assert cli("inspect", "odd.json").err == f"warning: {odd}\n"
    assert (place / "odd.json").exists()


def test_a_restore_and_one_into_another_family(plc: Path, cli: Cli) -> None:
    assert cli("backup", "b1.json", "-p", f"sim:{plc}").code == 0
    build_simulation(model="b1-14mc", program_seed=2, state="two")
    done = cli("restore", "b1.json", "-p", "sim:two", "--yes", "--json")
    assert done.code == 0
    assert done.document("restore")["pages_written"] == 128
    assert cli("verify", "b1.json", "-p", "sim:two").code == 0
    build_simulation(ladder_words=8192, state="facon")
    for option in ([], ["--any-header"]):
        refused = cli("restore", "b1.json", "-p", "sim:facon", "--yes", *option)
        assert refused.code == 5
        assert "of another family of PLC: expected FB as in the PLC, got FBS4 in the file" in refused.err


def test_verify_says_that_the_plc_has_more(place: Path, cli: Cli) -> None:
    build_simulation(model="b1-14mc", state="small")
    assert cli("backup", "small.json", "-p", "sim:small").code == 0
    pages = [*load_backup(place / "small.json").program.pages, b"\xff" * 128]
    build_simulation(model="b1-14mc", program=pages, state="large")
    done = cli("verify", "small.json", "-p", "sim:large", "--json")
    said = "the PLC has more than the 128 pages of small.json: the rest is not compared"
    assert (done.code, done.err) == (0, f"warning: {said}\n")
    assert done.document("verify")["b_has_more_pages"] is True


@pytest.mark.parametrize("state", ["password", None])
def test_a_plc_that_keeps_its_program_to_itself(place: Path, cli: Cli, state: str | None) -> None:
    simulation = build_simulation(model="b1-14mc", state="b1")
    simulation.plcs[1].password = state == "password"
    simulation.save_if_changed()
    done = cli("backup", "b1.json", "-p", "sim:b1")
    if state is None:
        assert done.code == 0
        return
    assert done.code == 4
    assert "the FBs papers have neither 4F nor 50, and a password may be set" in done.err
    assert "the engineer's project file" in done.err
    assert not (place / "b1.json").exists()


def test_the_history_of_an_fbs(plc: Path, cli: Cli) -> None:
    assert cli("backup", "b1.json", "-p", f"sim:{plc}").code == 0
    assert cli("history", "record", "press", "b1.json", "--history", "h").code == 0
    shown = cli("history", "show", "press", "--history", "h", "--json")
    assert shown.document("history-show")["header"]["family"] == "fbs"
