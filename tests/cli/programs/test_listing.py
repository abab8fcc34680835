"""``listing``: a backup's and a project's program in words."""

from __future__ import annotations

from pathlib import Path
from typing import TYPE_CHECKING

import pytest

import fatektool
from fatektool.errors import DataError
from fatektool.program.archive import save_backup
from fatektool.program.headers.header import FACON
from tests.program.samples import backup, program
from tests.project.files import ELEMENTS, IMAGE, MAIN, SUB, backup_file, project_file
from tests.project.images import B1, CODE, image_of
from tests.project.test_file import FBE

if TYPE_CHECKING:
    from tests.cli.running import Cli

LISTED = """\
unit MAIN
N0000  Motor
  0000  ORG X0                        START
  0001  OR M0
  0002  AND NOT X0                    START
  0003  OUT Y0                        MOTOR
N0001
  0004  ORG M0
  0005  FUN 08 MOV S:5 D:R8           TIME
N0002
  0006  ORG X1
  0007  T30 .01 R8                    R8: TIME
  0008  FO 0
  0009  OUT M0
N0003
  0010  ORG T30
  0012  OUT Y0                        MOTOR
N0004
  0013  ORG X2
  0014  ?? 3FF4 9041
N0005
  0015  ~FUN 65 LBL SETID0
  0016  ~FUN 68 RTS
"""


def test_a_project(cli: Cli) -> None:
    project_file("press.pdw", IMAGE, elements=ELEMENTS, networks={0x0200: b"Motor"})
    done = cli("listing", "press.pdw")
    assert (done.code, done.out) == (0, LISTED)
    assert "2 of 25 words of code are not known" in done.err


@pytest.mark.parametrize("swapped", [False, True])
def test_a_backup_with_comments(cli: Cli, swapped: bool) -> None:
    backup_file("press.json", IMAGE, swapped=swapped)
    project_file("press.pdw", IMAGE, elements=ELEMENTS, networks={0x0200: b"Motor"})
    assert cli("listing", "press.json", "--comments", "press.pdw").out == LISTED
    document = cli("listing", "press.json", "--json").document("listing")
    words = [
        word
        for network in document["networks"]
        for found in network["instructions"]
        for word in found["words"]
    ]
    assert [int(word, 16) for word in words] == MAIN + SUB
    assert document["header"]["byte_order"] == ("swapped" if swapped else "as paper")
    assert document["unknown_words"] == 2
    assert document["comments"] == {}
    place = 0
    for network in document["networks"]:
        for found in network["instructions"]:
            assert found["word"] == place
            place += len(found["words"])
    assert place == document["header"]["code_words"]
    mov = document["networks"][1]["instructions"][1]
    assert mov == {
        "number": 5,
        "word": 5,
        "words": ["ACF5", "0500", "100A"],
        "text": "FUN 08 MOV S:5 D:R8",
        "elements": ["R8"],
        "known": True,
        "grade": "A",
    }


def test_words_alone_tell_no_comment(cli: Cli) -> None:
    project_file("press.pdw", IMAGE, elements=ELEMENTS, networks={0x0200: b"Motor"})
    secrets = ("START", "MOTOR", "TIME", "Motor", "MAIN", "PRESS")
    done = cli("listing", "press.pdw", "--words")
    assert not [secret for secret in secrets if secret in done.out + done.err]
    assert "START" in cli("listing", "press.pdw", "--words", "--comments", "press.pdw").out


def test_some_networks_with_their_words(cli: Cli) -> None:
    backup_file("press.json", IMAGE)
    done = cli("listing", "press.json", "--network", "N0003", "--network", "1", "--words", "-q")
    assert done.out.splitlines() == [
        "N0001",
        "  0004  1048                 ORG M0",
        "  0005  ACF5 0500 100A       FUN 08 MOV S:5 D:R8",
        "N0003",
        "  0010  1E42                 ORG T30",
        "  0011  81EE",
        "  0012  00C1                 OUT Y0",
    ]
    document = cli("listing", "press.json", "--network", "1-2", "--json").document("listing")
    assert [network["number"] for network in document["networks"]] == [1, 2]


@pytest.mark.parametrize(
    ("words", "code", "said"),
    [
        (["--network", "6"], 2, "no network 6 in the program: it has N0000 to N0005"),
        (["--network", "3-1"], 2, "expected a number or a range"),
        (["--network", "x"], 2, "expected a number or a range"),
        (["--network", "9" * 5000], 2, "expected a number or a range"),
        (["--encoding", "utf-8"], 2, "unknown code page 'utf-8'"),
        (["--comments", "press.json"], 5, "a backup has no comments"),
        (["--comments", "no.pdw"], 2, "cannot read no.pdw"),
    ],
)
def test_what_is_refused(cli: Cli, words: list[str], code: int, said: str) -> None:
    backup_file("press.json", IMAGE)
    done = cli("listing", "press.json", *words)
    assert (done.code, done.out) == (code, "")
    assert said in done.err


def test_a_program_without_mnemonics(cli: Cli) -> None:
    save_backup(backup(program(400)), Path("old.json"))
    done = cli("listing", "old.json")
    assert (done.code, done.out) == (5, "")
    assert "no mnemonics: the code of the family 'facon' (FB30) is not known" in done.err
    assert cli("xref", "old.json").code == 5
    found = fatektool.load_program("old.json")
    assert (found.kind, found.header.family, found.code) == ("backup", FACON, None)
    with pytest.raises(DataError, match="no mnemonics"):
        _ = found.networks


def test_neither_a_backup_nor_a_project(cli: Cli) -> None:
    Path("x.bin").write_bytes(bytes(1000))
    for command in ("listing", "xref"):
        done = cli(command, "x.bin", "--json")
        assert done.code == 5
        assert done.document("error")["error"]["exit_code"] == 5


def test_the_library(place: Path) -> None:
    project_file("press.pdw", IMAGE, elements=ELEMENTS)
    found = fatektool.load_program(place / "press.pdw", encoding="cp1252")
    assert found.kind == "project"
    assert found.header.signature == "FBS40003"
    assert found.header.checksum is not None
    assert found.header.checksum.valid
    assert found.networks[0].instructions[0].text == "ORG X0"
    assert found.comments.elements["X0"] == "START"
    assert found.comments.code_page == "cp1252"
    assert fatektool.load_program(str(place / "press.pdw")).sha256 == found.sha256


def test_a_small_model(cli: Cli) -> None:
    image = image_of(CODE, model=B1)
    project_file("press.pdw", image, B1)
    done = cli("listing", "press.pdw", "--json").document("listing")
    assert done["header"]["signature"] == "FBS40110"
    assert {done["header"]["sums"][name]["valid"] for name in ("settings", "labels", "ror")} == {True}


def test_an_fbe(cli: Cli) -> None:
    Path("fbe.pdw").write_bytes(FBE)
    done = cli("listing", "fbe.pdw")
    assert done.out.splitlines()[5:] == [
        "  0004  ~FUN 08 MOV S:FFFFH D:R0",
        "N0001",
        "  0005  ORG X0",
        "  0006  OUT Y1",
    ]
    document = cli("listing", "fbe.pdw", "--json").document("listing")
    assert (document["header"]["family"], document["header"]["ladder_words"]) == (None, None)
    assert "header    not known (FBE)" in cli("inspect", "fbe.pdw").out
    assert cli("inspect", "fbe.pdw", "--json").document("inspect")["networks"] == 2
    assert cli("diff", "fbe.pdw", "fbe.pdw").out == "same: 256 pages, same code\n"
    assert cli("xref", "fbe.pdw", "X0").code == 0


def test_a_comment_within_a_network_is_its_own(cli: Cli) -> None:
    project_file("press.pdw", IMAGE, networks={0x0200: b"First", 0x0204: b"also first", 0x020A: b"Second"})
    lines = cli("listing", "press.pdw").out.splitlines()
    assert [line for line in lines if line.startswith("N000")][:2] == ["N0000  First", "N0001  Second"]


def test_a_page_to_look_at(cli: Cli) -> None:
    project_file("press.pdw", IMAGE, elements={"X0": b"<b>&"})
    assert cli("listing", "press.pdw", "--report", "press.html").code == 0
    page = Path("press.html").read_text("utf-8")
    assert "X0: &lt;b&gt;&amp;" in page
    assert "?? 3FF4 9041" in page


def test_latin_1_is_said(cli: Cli) -> None:
    project_file("press.pdw", IMAGE, elements={"X0": b"\x81\x20\xff\x98"})
    assert "no code page decodes all comments" in cli("listing", "press.pdw").err
    assert "no code page" not in cli("listing", "press.pdw", "--encoding", "cp1252").err


@pytest.mark.parametrize("command", ["listing", "xref", "inspect"])
def test_a_sum_that_does_not_hold_is_a_warning(cli: Cli, command: str) -> None:
    image = image_of(MAIN, SUB, labels=[0x4927, 0x002A])
    other = bytearray(image.other)
    other[0x7FE] ^= 1  # the last label
    project_file("press.pdw", image._replace(other=bytes(other)))
    done = cli(command, "press.pdw")
    assert done.code == 0
    assert "warning: checksum of the labels: expected 4951 as stored, got 4952" in done.err


def test_a_program_without_code_says_so(cli: Cli) -> None:
    project_file("press.pdw", image_of([]))
    done = cli("listing", "press.pdw")
    assert (done.code, done.out, done.err) == (0, "", "press.pdw: the program has no code\n")
